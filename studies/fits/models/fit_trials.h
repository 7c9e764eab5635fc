/// A fit of measured presses again, with one thing more than it had: which thing explains a misfit?
#pragma once

#include <string>
#include <vector>

#include "calibration/statistics/score_tests.h"
#include "studies/fits/models/fit_models.h"

namespace fingertip::studies::inline fits::inline models {

/// The name of a cause that has none: many make a force stiffen.
inline constexpr const char* stiffening_name = "stiffening";
/// That of presses which ask for another modulus than others.
inline constexpr const char* other_rubber_name = "another rubber";

/// One of `rig_parameters` of a curve, or of the curves of a machine; behind them the modulus of
/// the curves of one press.
struct Freed {
  static constexpr std::size_t rubber = calibration::rig_members.size();
  std::size_t kind = 0;
  std::string of;
  std::vector<std::size_t> curves;
  /// A compliance below zero, which no machine has: what stiffens with the force is something else.
  bool stiffens = false;
};

/// What the fit holds: the rig's quantities, and that presses which differ are of one rubber, but
/// where each has a factor of its own, for they `scatter`.
std::vector<Freed> held_by(const FitInput& input, bool scatter);

/// Fits of the forces' scale, of what of the rigs was told to be fitted, and of one thing more.
/// What nobody told of a rig is held at none.
class Trials {
 public:
  /// At the estimates of `fit`; each press has a scale of its own where they `scatter`. Throws as
  /// fits do; `input` is kept as a reference.
  Trials(const FitInput& input, const calibration::CurveFit& fit,
         const calibration::CurveFitOptions& options, const FitModels& models, bool scatter);

  /// Throws as fits do. A stiffening is told by what c < 0 adds to the deepest force, -c dF/dx of
  /// it with 3/2 of the force over the travel as the slope; another rubber by its modulus over the
  /// others'.
  calibration::ScoreTest of(const Freed& freed);

  /// The fit without one thing more, and its options.
  const calibration::CurveFit& base() const { return before_; }
  const calibration::CurveFitOptions& options() const { return options_; }

 private:
  calibration::FreeParameter parameter_of(const Freed& freed) const;
  calibration::CurveFit fitted(const std::vector<Freed>& freed);

  const FitInput& input_;
  calibration::CurveFitOptions options_;
  Eigen::Index scales_ = 1;           ///< of the forces: one, or one of each curve
  std::vector<Eigen::Index> places_;  ///< of the fit's parameters behind the scales; -1: held
  std::vector<Eigen::VectorXd> forces_;
  calibration::CurveFit before_;
};

}  // namespace fingertip::studies::inline fits::inline models
