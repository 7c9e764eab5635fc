/// What presses that are not made yet would tell beside those of a fit or a plan.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "calibration/statistics/design.h"
#include "studies/fits/models/fit_models.h"

namespace fingertip::studies::inline fits::inline models {

/// The standard deviation of a force [N] by its size.
class Noise {
 public:
  /// hypot(relative F, absolute); what would be zero is a millionth of the largest force.
  Noise(double relative, double absolute);
  /// As the sigma of measured curves goes with their force, straight between values and in
  /// proportion beyond; without sigma `deviation` for all.
  Noise(const std::vector<calibration::Curve>& curves, double deviation);

  Eigen::VectorXd of(const Eigen::VectorXd& forces) const;

 private:
  double relative_ = 0.0, absolute_ = 0.0;
  std::vector<double> force_, sigma_;  ///< of measured values, increasing; or empty
};

/// Forces and positions that a press of curve `i` gives at the curve's x taken as indentations, by
/// the parameters and behind its rig, with the deviations of `noise`: as if it were measured
/// without error.
calibration::Curve as_if_measured(const FitInput& input, const FitModels& models, std::size_t i,
                                  const Eigen::VectorXd& parameters, const Noise& noise);

/// Relative covariance of the models' errors at the values of all presses: of their lattices where
/// `lattice` is set, and of errors that all values share, a column each; empty where there is
/// neither.
Eigen::MatrixXd relative_model_error(const std::vector<lattice::PressSetup>& presses, bool lattice,
                                     const Eigen::MatrixXd& shared);

/// The presses of a fit with the indentations of all values as their samples.
std::vector<lattice::PressSetup> presses_of_values(const FitInput& input);

/// Relative changes of the forces at the values of all curves, a column for each known error.
Eigen::MatrixXd known_errors_at_values(const FitInput& input);

/// Changes that are known at a press's samples at other indentations, a column each.
Eigen::MatrixXd known_errors_at(const FitCurve& curve,
                                const std::vector<std::vector<double>>& at_samples,
                                const std::vector<double>& depths);

/// What the curves of `input`, with forces, tell of its parameters there: their covariance, and how
/// every one of its candidates would narrow it, best first.
struct MeasurementGains {
  Eigen::MatrixXd covariance;
  std::vector<calibration::MeasurementGain> gains;
};

/// `deviation` of every force where curves have no sigma; `misfit` and `scatter`: those of what the
/// models miss, common to presses alike, and of factors between presses. Presses of candidates are
/// computed in `folder`/next, jobs by `context`; one that fails says so in its entry. `go_on` hears
/// the share of candidates that are done and which one is at work; false ends it with Interrupted.
MeasurementGains measurement_gains(
    const FitInput& input, const FitModels& models, const Eigen::VectorXd& parameters,
    double deviation, double misfit, double scatter, const std::filesystem::path& folder,
    const JobContext& context,
    const std::function<bool(double share, const std::string& name)>& go_on);

}  // namespace fingertip::studies::inline fits::inline models
