#include "lattice/control/pid.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <utility>

namespace fingertip::lattice {

using meshes::Vector3;

Pid::Pid(const PidSettings& settings, const Eigen::Matrix<double, 6, 6>& inertia,
         std::function<Target(double)> target)
    : settings_(settings),
      inertia_(inertia),
      inverse_inertia_(inertia.inverse()),
      target_(std::move(target)),
      omega_(2.0 * std::numbers::pi * settings.natural_frequency) {}

Pid::Vector6 Pid::limited(const Vector6& wrench) const {
  // Axis by axis: an actuator that can push no harder must still be able to steer.
  Vector6 limit;
  limit << Vector3::Constant(settings_.force_limit), Vector3::Constant(settings_.torque_limit);
  return wrench.cwiseMin(limit).cwiseMax(-limit);
}

Wrench Pid::command(const Measurement& m) {
  const Target target = target_(m.time);
  const Eigen::AngleAxisd turned(m.orientation);
  Vector6 error, rate, feed_forward = Vector6::Zero();
  error << target.position - m.position, -turned.angle() * turned.axis();
  rate << target.velocity - m.velocity, -m.angular_velocity;
  feed_forward.head<3>() = target.acceleration;

  const double filter = 1.0 - std::exp(-settings_.derivative_filter * omega_ * settings_.period);
  derivative_ += (first_ ? 1.0 : filter) * (rate - derivative_);
  first_ = false;

  const Vector6 acceleration =
      feed_forward + 3.0 * omega_ * omega_ * error + integral_ + 3.0 * omega_ * derivative_;
  Vector6 bond;
  bond << m.bond.force, m.bond.torque;
  const Vector6 wanted = inertia_ * acceleration - settings_.bond_compensation * bond;
  const Vector6 wrench = limited(wanted);
  saturated_ = wrench != wanted;
  const Vector6 excess = inverse_inertia_ * (wrench - wanted);
  integral_ += settings_.period * (std::pow(omega_, 3) * error + omega_ * excess);
  return {wrench.head<3>(), wrench.tail<3>()};
}

}  // namespace fingertip::lattice
