/// The set point that a force loop moves along the plane's normal.
#pragma once

#include "lattice/control/task.h"

namespace fingertip::lattice::inline control {

/// Where the endpoint should be on its way from the task's start toward the plane, and how fast it
/// should go; along all other axes the pose stays that of the start. What is measured is told in
/// the same direction.
class WayToPlane {
 public:
  explicit WayToPlane(const ControlTask& task);
  void reset() { reference_ = speed_ = 0.0; }

  double position(const Measurement& m) const;  ///< of the endpoint, from the start [m]
  double velocity(const Measurement& m) const;  ///< of the endpoint [m/s]
  double force(const Measurement& m) const;     ///< of the tip on the rod, away from the plane [N]
  double speed() const { return speed_; }       ///< commanded last [m/s]

  /// The set point that goes on at `speed` [m/s].
  Target go_on(double speed);
  /// Of a servo that may be at its limit and cannot follow then: the set point stands still rather
  /// than run away further from the measured endpoint.
  Target go_on(double speed, const Measurement& m, bool saturated);
  /// Goes on from `target`, a set point on the same straight way.
  void take_over(const Target& target);

 private:
  Target start_;
  meshes::Vector3 toward_;
  double period_;           ///< [s]
  double reference_ = 0.0;  ///< commanded position at the next sample [m]
  double speed_ = 0.0;
};

}  // namespace fingertip::lattice::inline control
