/// The paper's PID controller in six degrees of freedom.
#pragma once

#include <Eigen/Core>
#include <functional>

#include "lattice/control/controller.h"
#include "lattice/settings.h"

namespace fingertip::lattice {

/// Where the endpoint should be; the rod should keep its starting orientation.
struct Target {
  meshes::Vector3 position = meshes::Vector3::Zero();      ///< [m]
  meshes::Vector3 velocity = meshes::Vector3::Zero();      ///< [m/s]
  meshes::Vector3 acceleration = meshes::Vector3::Zero();  ///< [m/s²]
};

/// W = I (a_ref + Kp e + Ki ∫e + Kd de/dt) - share * bond, with I the 6 x 6 inertia at the
/// endpoint, gains that put all three closed-loop poles of the free rod at -omega (Kp = 3 omega²,
/// Ki = omega³, Kd = 3 omega), and the measured bond wrench fed forward. The derivative acts on the
/// measured velocity, low-passed at N omega. Every axis of force and torque is limited;
/// back-calculation then bleeds the integrator with time constant 1/omega (README).
class Pid final : public Controller {
 public:
  /// `inertia`: 6 x 6 at the endpoint [kg, kg m, kg m²]; `target` as a function of time [s].
  Pid(const PidSettings& settings, const Eigen::Matrix<double, 6, 6>& inertia,
      std::function<Target(double)> target);

  Wrench command(const Measurement& measurement) override;
  double period() const override { return settings_.period; }
  /// Whether the last command hit a limit.
  bool saturated() const { return saturated_; }

 private:
  using Vector6 = Eigen::Matrix<double, 6, 1>;
  Vector6 limited(const Vector6& wrench) const;

  PidSettings settings_;
  Eigen::Matrix<double, 6, 6> inertia_;
  Eigen::Matrix<double, 6, 6> inverse_inertia_;
  std::function<Target(double)> target_;
  double omega_;
  Vector6 integral_ = Vector6::Zero();    ///< of Ki e, as an acceleration
  Vector6 derivative_ = Vector6::Zero();  ///< filtered de/dt
  bool first_ = true;
  bool saturated_ = false;
};

}  // namespace fingertip::lattice
