/// Poisson's ratio from displacements, which tell nothing of E: a body's places under a given
/// motion of what presses it depend on its moduli by their ratio alone.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "calibration/files/displacement_fit_file.h"
#include "calibration/press_fit/displacement_moments.h"
#include "calibration/press_fit/scaled_model.h"

namespace fingertip::calibration::inline press_fit {

/// What of the press is not known and fitted, load by load: a factor of the field, where the
/// indentations told are not trusted, so that shape alone tells the ratio; and how far from stick
/// to frictionless the contact lies, by the fields of both (a share, linear between them).
struct FreedPress {
  bool compression = false, slip = false;
};

/// psi(nu): the values of DisplacementMoments::of at a Poisson's ratio, pressed at few
/// (ScaledModel, by plain polynomials: values have both signs).
class DisplacementModel {
 public:
  /// `solver`: the values at each of these Poisson's ratios [m].
  DisplacementModel(ScaledModel::Solver solver, double lowest_ratio);
  DisplacementModel(const DisplacementModel&) = delete;
  DisplacementModel& operator=(const DisplacementModel&) = delete;

  /// Throws as ScaledModel::evaluate does.
  Eigen::VectorXd at(double poissons_ratio);
  /// Asks for one more ratio where values there are not known to ScaledModel::tolerance.
  bool refine(double poissons_ratio);
  double lowest() const { return lowest_; }
  const std::vector<double>& asked() const { return asked_; }

 private:
  double lowest_;
  std::vector<double> asked_;
  ScaledModel model_;
};

/// The posterior of the ratio, flat between the model's lowest and ScaledModel::highest_ratio, by
/// summing over it: at each ratio the values leave noise, alike for all, and a smooth part that the
/// model misses (misfit_covariance), both of unknown size, which are summed over with the priors of
/// any fit (value_errors); their evidence is the density. What is freed is linear and summed over,
/// too. Median and 95 % interval; near 1/2 the interval is one-sided in effect, and `at_bound` says
/// so. Fails (`failed`) as a fit to presses does where more than a tenth is missed beyond noise,
/// and where the interval leaves the ratio open by more than an eighth to either side. `slipping`
/// answers for the frictionless press, null unless slip is freed. Of the file data, model and
/// strain are left to others.
DisplacementFitFile fit_poissons_ratio(const DisplacementMoments& moments,
                                       const std::vector<MeasuredDisplacements>& measured,
                                       DisplacementModel& model, DisplacementModel* slipping,
                                       FrameMotion frame, const FreedPress& freed);

}  // namespace fingertip::calibration::inline press_fit
