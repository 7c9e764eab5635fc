/// Errors of the values of a fit, and the repeats among its curves.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/press_fit/fit_record.h"
#include "calibration/press_fit/repeats.h"
#include "calibration/statistics/value_errors.h"
#include "studies/fits/models/fit_input.h"

namespace fingertip::studies::inline fits::inline models {

/// Repeats are computed as one press: all take the depths of the one that went deepest.
void share_depths(FitInput& input);

/// The curves, in groups of presses that differ by nothing but their rows: the same finger,
/// obstacle, contact and machine.
std::vector<std::vector<std::size_t>> alike(const FitInput& input);

/// Whether repeats scatter by more than their errors.
bool scatter(const std::vector<calibration::Repeats>& repeats);

/// Of presses alike, whose deepest indentation [m] is `deepest`: columns of what a model may miss
/// of `force` [N] at `depth` [m] smoothly, as a share of it and, less, of the largest force.
Eigen::MatrixXd misfit_columns(const Eigen::VectorXd& force, const Eigen::VectorXd& depth,
                               double deepest);

/// The press's own force [N] and depth [m], per value of all curves.
struct ForceAndDepth {
  Eigen::VectorXd force, depth;
};
/// `computed` by the models at `estimates`.
ForceAndDepth presses_at(const FitInput& input, const Eigen::VectorXd& estimates,
                         const Eigen::VectorXd& computed);

/// What files tell of the noise of the values of all curves, else `deviation` for each.
Eigen::VectorXd told_deviations(const FitInput& input, double deviation);

/// What the model may miss smoothly, shared by presses alike, and a factor of every repeat. Curves
/// from `fitted` on are held back: they have a factor where repeats among those before tell its
/// size.
std::vector<calibration::ErrorComponent> components_of(const FitInput& input,
                                                       const ForceAndDepth& at, std::size_t fitted);

/// Presses that share what their model misses, those that differ by nothing but their rows, and
/// every other curve by itself.
std::vector<std::vector<std::size_t>> sharing(const FitInput& input);

/// The fit once more from `first`, with the errors that its values show: noise, a smooth part that
/// the model misses and a factor of every repeat (calibration::value_errors).
calibration::Posterior posterior_of(const FitInput& input,
                                    const std::vector<calibration::ForwardModel*>& models,
                                    const calibration::CurveFit& first);

/// What follows the search for `record.fit`: repeats, and posterior_of; options and intervals of
/// the record.
void add_errors_and_intervals(const FitInput& input,
                              const std::vector<calibration::ForwardModel*>& models,
                              calibration::FitRecord& record);

}  // namespace fingertip::studies::inline fits::inline models
