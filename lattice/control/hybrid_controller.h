/// Approach, then force control, without chatter.
#pragma once

#include "lattice/control/force_controller.h"

namespace fingertip::lattice::inline control {

/// Moves toward the plane on the task's way. Once the measured normal force has stayed above the
/// touch threshold for the time of confirmation (and the tactile sensor, where there is one, feels
/// the plane), ForceLoop takes over from the position and speed commanded at that moment (bumpless:
/// one Pid serves both modes, its integral goes on). Once the force has stayed below release_force
/// as long, but not before the dwell time has passed, the approach is resumed from where it is, at
/// a speed that grows again. Between the two thresholds nothing changes (hysteresis), so noise
/// narrower than their distance cannot make it chatter, and no cause whatever makes it change to
/// and fro faster than dwell and confirmations allow; the way into force control is never barred,
/// for there the plane may be (automata with hysteresis and dwell time: Liberzon, Switching in
/// Systems and Control, 2003, chapters 1 and 3).
///
/// The sensor also feels the tip's own inertia. It weighs less than the rod (a heavier one could
/// not be controlled), so while the way accelerates by a the threshold is touch_force + M |a|,
/// fading with 10 ms afterwards, as the tip swings.
class HybridController final : public Controller, public HoldsForce {
 public:
  /// Throws InvalidInput for settings that break a rule.
  HybridController(const PidSettings& pid, const ForceSettings& settings, const ControlTask& task);

  Command command(const Measurement& measurement) override;
  void reset() override;
  ControllerReport report() const override;
  const ForceSettings& force_settings() const override { return loop_.settings(); }
  void set_force(double force) override { loop_.set_force(force); }

  ControlMode mode() const { return mode_; }
  int switches() const { return switches_; }  ///< changes of mode so far
  Pid& pid() { return pid_; }

 private:
  void choose_mode(const Measurement& measurement, double force);
  double touch_threshold(double time);
  Target approach(double time);

  ControlTask task_;
  Pid pid_;
  ForceLoop loop_;
  WayToPlane way_;
  ControlMode mode_ = ControlMode::position;
  int switches_ = 0;
  double changed_ = 0.0;    ///< when the mode changed last [s]
  double otherwise_ = 0.0;  ///< for how long the force has spoken for the other mode [s]
  double inertial_ = 0.0;   ///< what the tip's inertia may still exert [N]
};

}  // namespace fingertip::lattice::inline control
