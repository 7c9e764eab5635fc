/// What a testing machine tells of a press: force against the travel of its crosshead.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "calibration/press_fit/relaxing_force.h"
#include "calibration/statistics/forward_model.h"

namespace fingertip::calibration::inline press_fit {

/// A crosshead at x, at the time t, presses by delta and its load cell tells
///   f = F0 + F1 t + F(delta),   x = x0 + delta + c F(delta),   F = 0 for x < x0.
struct Rig {
  FitQuantity touch_offset;  ///< x0 [m]
  FitQuantity compliance;    ///< c of frame, load cell and grips in series with the press [m/N]
  FitQuantity force_offset;  ///< F0 [N]
  FitQuantity drift;         ///< F1 [N/s]
};

/// Its quantities in the order of rig_parameters.
inline constexpr std::array rig_members{&Rig::touch_offset, &Rig::compliance, &Rig::force_offset,
                                        &Rig::drift};

/// Indentations at which a press answers for a rig's curve, the last one `deepest` > 0 [m]: in
/// steps of a quarter of ln(delta), so that ln F as a cubic is within 1e-4 of a smooth press.
std::vector<double> depths_for_rig(double deepest);

/// A press behind a rig, from any other model of forces over indentation. ln F is a cubic of
/// ln delta (Hermite's, its slopes those of Lagrange's polynomial through up to five depths), which
/// is exact for powers of delta; beyond the depths at either end a power. Depths before the first
/// positive force are passed over: there a lattice has no tie yet. For every x
///   g(delta) = delta + c F(delta) - (x - x0) = 0
/// has one root while 1 + c F' > 0, and by the implicit-function theorem, with s = 1/(1 + c F'),
///   df/dp = s dF/dp,  df/dx0 = -s F',  df/dc = -s F F',  df/dF0 = 1,  df/dF1 = t.
/// Of a rubber that relaxes F is RelaxingForce's, step by step from position to position, delta
/// going evenly within a step. It begins at touch: within a step that the travel enters, or, of a
/// first position under load, at the speed of the first step.
class RigModel final : public ForwardModel {
 public:
  /// `press` answers at `depths` (positive, increasing, two or more; kept as a reference) and takes
  /// the first `press_parameters` of the fit's `parameters`. `position` x [m]; `time` t [s] of
  /// every position, or empty, which counts as 0; with `branches` they increase. Throws
  /// InvalidInput for depths and times that are not so, another number of times than positions, and
  /// places beyond the parameters.
  RigModel(ForwardModel& press, std::vector<double> depths, Eigen::Index press_parameters, Rig rig,
           std::vector<double> position, std::vector<double> time, Eigen::Index parameters,
           std::vector<FitBranch> branches = {});

  /// Throws NotConverged where the press has fewer than two positive forces, where a negative
  /// compliance takes back more than the press gives, where shares of branches sum to 1, and as the
  /// press does.
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override;
  bool refine(const Eigen::VectorXd& parameters) override {
    return press_->refine(parameters.head(press_parameters_));
  }

  /// The indentations of the last evaluation, one per position, 0 before touch [m].
  const Eigen::VectorXd& indentation() const { return indentation_; }

 private:
  ForwardModel* press_;
  std::vector<double> depths_;
  Eigen::Index press_parameters_;
  Rig rig_;
  /// How long the rubber has been loaded since the position before, and d/dx0 of that.
  struct Duration {
    double value = 0.0, by_offset = 0.0;
  };
  Duration loaded_since(std::size_t i, double offset) const;

  std::vector<double> position_, time_;
  Eigen::Index parameters_;
  std::vector<FitBranch> branches_;
  Eigen::VectorXd indentation_;
};

}  // namespace fingertip::calibration::inline press_fit
