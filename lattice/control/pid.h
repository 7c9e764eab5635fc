/// The paper's PID controller in six degrees of freedom.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "lattice/control/control_settings.h"
#include "lattice/control/controller.h"

namespace fingertip::lattice::inline control {

/// W = I (a_ref + Kp e + Ki ∫e + Kd de/dt) - share * wrench of the tip, with I the 6 x 6 inertia at
/// the endpoint, gains that put all three closed-loop poles of the free rod at -omega
/// (Kp = 3 omega², Ki = omega³, Kd = 3 omega), and the measured wrench fed forward. The error of
/// orientation is the rotation vector from the measured to the wanted one. In the proportional part
/// the set point, counted from the first one, has the weight b. The derivative acts on
/// the error of velocity, low-passed at N omega. Every axis of force and torque is limited;
/// back-calculation then bleeds the integrator with time constant 1/omega (README).
class Pid {
 public:
  /// `inertia`: 6 x 6 at the endpoint [kg, kg m, kg m²].
  Pid(const PidSettings& settings, const Matrix6& inertia);

  /// The wrench that leads the endpoint to the target; to be called once per settings().period.
  /// `feed_forward` is added before the limits.
  Wrench follow(const Measurement& measurement, const Target& target,
                const Wrench& feed_forward = {});
  void reset();
  /// Other gains and limits from now on, the command unchanged at the switch: what the new gains
  /// make of the last errors differently is taken over by the integral. The period stays.
  void set_settings(const PidSettings& settings);
  /// The next command will be `wrench`, whatever the errors (bumpless start): the integral takes
  /// the difference.
  void start_from(const Wrench& wrench) { start_ = wrench; }
  /// Adds a wrench to what the integral holds against.
  void carry(const Wrench& wrench);

  const PidSettings& settings() const { return settings_; }
  /// Whether the last wrench hit a limit.
  bool saturated() const { return saturated_; }

 private:
  Vector6 weighted(const Vector6& error) const;
  Vector6 share_without_integral() const;

  PidSettings settings_;
  Matrix6 inertia_;
  Matrix6 inverse_inertia_;
  double omega_;
  Vector6 integral_ = Vector6::Zero();    ///< of Ki e, as an acceleration
  Vector6 derivative_ = Vector6::Zero();  ///< filtered de/dt
  Vector6 error_ = Vector6::Zero();       ///< at the last command
  Vector6 way_ = Vector6::Zero();         ///< of the set point since the first one
  Vector6 bond_ = Vector6::Zero();        ///< measured at the last command [N, N m]
  Pose origin_;                           ///< first set point
  std::optional<Wrench> start_;
  bool first_ = true;
  bool saturated_ = false;
};

/// The PID on a prescribed way of the endpoint.
class PidController final : public Controller {
 public:
  /// `target` as a function of time [s].
  PidController(const PidSettings& settings, const Matrix6& inertia,
                std::function<Target(double)> target)
      : pid_(settings, inertia), target_(std::move(target)) {}

  Command command(const Measurement& measurement) override {
    return pid_.follow(measurement, target_(measurement.time));
  }
  void reset() override { pid_.reset(); }
  Pid& pid() { return pid_; }

 private:
  Pid pid_;
  std::function<Target(double)> target_;
};

}  // namespace fingertip::lattice::inline control
