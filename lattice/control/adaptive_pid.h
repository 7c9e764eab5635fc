/// The paper's adaptive PID: tuned by a relay, its gains scheduled on the contact's stiffness.
#pragma once

#include <deque>
#include <optional>

#include "lattice/control/control_settings.h"
#include "lattice/control/pid.h"
#include "lattice/control/relay_tuner.h"
#include "lattice/control/stiffness_estimator.h"
#include "lattice/control/task.h"

namespace fingertip::lattice::inline control {

/// Pid on the way of the press, whose natural frequency is w = tuned_delay_angle / L and whose
/// inertia is the task's times M/m, with the delay L and the mass M that a relay found on the free
/// finger (m: the task's), and which knows the contact. Along the plane's normal,
/// with local stiffness k and damping c and the share s of the measured wrench that is fed forward:
///   Kp = 3 M w² - min((1 - s) k, M w²),  Kd = 3 M w - (1 - s) c,  Ki = M w³,
/// so that the poles stay at -w in contact; the expected rise of the force (1 - s) k v_ref T is
/// carried into the integrator each period T, and what is fed forward from a measurement leads by
/// s k v_ref l, for it acts that much later (l: the delay that a relay finds without feed-forward).
/// A change of k shifts the integral so that the command does not jump. k = schedule(indentation) +
/// what recursive least squares find from motion and own commands, without the measured wrench:
/// over a period the tip's mean force is u - M dv/T (u as it acted, the delay known), the mean
/// position (x0 + x1)/2 - T dv/12. Nothing is learnt before the touch and while an actuator is at
/// its limit.
class AdaptivePid final : public Controller {
 public:
  /// Carries out the relay experiment where the task allows one. Throws InvalidInput for settings
  /// that break a rule, NotConverged for a finger on which the relay does not oscillate.
  AdaptivePid(const PidSettings& pid, const AdaptiveSettings& settings, const ControlTask& task);

  Command command(const Measurement& measurement) override;
  void reset() override;
  ControllerReport report() const override;

  /// What the relay found; empty where there was no experiment.
  const std::optional<RelayResult>& relay() const { return tuning_.relay; }
  double natural_frequency() const { return pid_.settings().natural_frequency; }  ///< [Hz]
  double stiffness() const { return stiffness_; }                                 ///< k [N/m]
  double damping() const { return damping_; }                                     ///< c [N s/m]

 private:
  struct Tuning {
    std::optional<RelayResult> relay;
    double delay = 0.0;    ///< L [s]
    double latency = 0.0;  ///< the same without wrench feed-forward, l [s]
    double mass = 0.0;     ///< M [kg]
    PidSettings pid;
  };
  static Tuning tune(const PidSettings& pid, const AdaptiveSettings& settings,
                     const ControlTask& task);
  struct Motion {
    double position = 0.0;  ///< toward the plane, since the start [m]
    double velocity = 0.0;  ///< [m/s]
  };
  void learn(const Motion& now, double scheduled);
  double force_that_acted() const;

  Tuning tuning_;
  ControlTask task_;
  AdaptiveSettings settings_;
  Pid pid_;
  double omega_ = 0.0;  ///< w [1/s]
  StiffnessEstimator estimator_;
  meshes::Vector3 start_;
  std::deque<double> commanded_;  ///< force toward the plane, the latest first [N]
  std::optional<Motion> before_;
  struct Increment {
    double position = 0.0, velocity = 0.0, force = 0.0;
  };
  std::optional<Increment> mean_;  ///< over the last period: position [m], velocity, force
  int touched_ = 0;                ///< for how many samples it has touched
  double stiffness_ = 0.0, damping_ = 0.0;
  double softening_ = 0.0;  ///< taken off Kp [N/m]
  double error_ = 0.0;      ///< of position at the last command [m]
};

}  // namespace fingertip::lattice::inline control
