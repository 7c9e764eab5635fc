/// Explicit force control along the plane's normal.
#pragma once

#include <optional>

#include "lattice/control/control_settings.h"
#include "lattice/control/pid.h"
#include "lattice/control/stiffness_estimator.h"
#include "lattice/control/way_to_plane.h"

namespace fingertip::lattice::inline control {

/// The outer loop: from the measured contact force f to the velocity v toward the plane,
///   v = g (f_d - f') / k,   df'/dt = a (f - f') with a = 8 w_f,   g = w_f (1 - w_f/a),
/// which on a contact df/dt = k v has the poles -w_f and -(a - w_f): first order at the bandwidth
/// w_f but for a pole seven times faster, no overshoot. The low-pass keeps the tip's own inertia,
/// which the sensor feels too, out of the loop. k is the schedule's, else the greater of what
/// recursive least squares find from the measured force and of f over the way since the force
/// left zero (its chord; a convex f has no smaller tangent), so that the loop is rather slower
/// than w_f than faster. |v| is limited to the approach speed, rising no faster than the servo
/// follows; a limited v is not integrated beyond what it moves (the integrator is the position).
class ForceLoop {
 public:
  ForceLoop(const ForceSettings& settings, const ControlTask& task, double servo_frequency);

  /// The velocity for the next period [m/s]. `position` [m] and `velocity` [m/s] toward the plane,
  /// `speed` the present commanded one [m/s].
  double speed(double force, double position, double velocity, double speed_so_far);
  void reset();
  double stiffness() const { return stiffness_; }  ///< k that was used last [N/m]
  const ForceSettings& settings() const { return settings_; }
  void set_force(double force) { settings_.force = force; }  ///< f_d [N] from now on

 private:
  double stiffness_at(double force, double position, double velocity);

  ForceSettings settings_;
  ControlTask task_;
  double omega_;         ///< w_f [1/s]
  double acceleration_;  ///< largest gain of speed [m/s²]
  StiffnessEstimator estimator_;
  std::optional<double> filtered_;  ///< f' [N]
  struct Reading {
    double force = 0.0, position = 0.0, velocity = 0.0;
  };
  std::optional<Reading> before_;
  std::optional<double> touch_;  ///< position at which the force left zero [m]
  double stiffness_ = 0.0;
};

/// What a controller offers that holds a contact force.
class HoldsForce {
 public:
  virtual ~HoldsForce() = default;
  virtual const ForceSettings& force_settings() const = 0;
  /// Another contact force from now on [N], above force_settings().touch_force.
  virtual void set_force(double force) = 0;
};

/// Holds a contact force along the plane's normal and the pose along all other axes: ForceLoop on
/// a Pid that follows the position it integrates. In free space it approaches at the task's speed.
class ForceController final : public Controller, public HoldsForce {
 public:
  /// Throws InvalidInput for settings that break a rule.
  ForceController(const PidSettings& pid, const ForceSettings& settings, const ControlTask& task);

  Command command(const Measurement& measurement) override;
  void reset() override;
  ControllerReport report() const override;
  const ForceSettings& force_settings() const override { return loop_.settings(); }
  void set_force(double force) override { loop_.set_force(force); }
  Pid& pid() { return pid_; }

 private:
  Pid pid_;
  ForceLoop loop_;
  WayToPlane way_;
};

/// Throws InvalidInput for settings that break a rule alone or with the servo.
void check(const ForceSettings& settings, const PidSettings& servo);

}  // namespace fingertip::lattice::inline control
