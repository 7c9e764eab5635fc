#include "lattice/control/pid.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;

Vector6 together(const Wrench& wrench) {
  Vector6 both;
  both << wrench.force, wrench.torque;
  return both;
}

/// Displacement and rotation vector.
Vector6 way_from(const Pose& origin, const Pose& pose) {
  const Eigen::AngleAxisd turn(pose.orientation * origin.orientation.conjugate());
  Vector6 way;
  way << pose.position - origin.position, turn.angle() * turn.axis();
  return way;
}

}  // namespace

Pid::Pid(const PidSettings& settings, const Eigen::Matrix<double, 6, 6>& inertia)
    : settings_(settings),
      inertia_(inertia),
      inverse_inertia_(inertia.inverse()),
      omega_(2.0 * std::numbers::pi * settings.natural_frequency) {}

void Pid::reset() {
  integral_ = derivative_ = error_ = way_ = bond_ = Vector6::Zero();
  start_.reset();
  first_ = true;
  saturated_ = false;
}

Pid::Vector6 Pid::limited(const Vector6& wrench) const {
  // Axis by axis: an actuator that can push no harder must still be able to steer.
  Vector6 limit;
  limit << Vector3::Constant(settings_.force_limit), Vector3::Constant(settings_.torque_limit);
  return wrench.cwiseMin(limit).cwiseMax(-limit);
}

/// Of the proportional part: b r - y = (r - y) + (b - 1) r.
Pid::Vector6 Pid::weighted(const Vector6& error) const {
  if (settings_.setpoint_weight == 1.0) return error;
  return error + (settings_.setpoint_weight - 1.0) * way_;
}

/// What proportional and derivative part and the fed-forward bond made of the last errors, as an
/// acceleration.
Pid::Vector6 Pid::share_without_integral() const {
  return 3.0 * omega_ * omega_ * weighted(error_) + 3.0 * omega_ * derivative_ -
         settings_.bond_compensation * (inverse_inertia_ * bond_);
}

void Pid::set_settings(const PidSettings& settings) {
  const Vector6 before = share_without_integral();
  const double period = settings_.period;
  settings_ = settings;
  settings_.period = period;
  omega_ = 2.0 * std::numbers::pi * settings.natural_frequency;
  if (!first_) integral_ += before - share_without_integral();
}

void Pid::carry(const Wrench& wrench) {
  integral_ += inverse_inertia_ * together(wrench);
}

Wrench Pid::follow(const Measurement& m, const Target& target, const Wrench& extra) {
  const Eigen::AngleAxisd turn(target.pose.orientation * m.pose.orientation.conjugate());
  Vector6 error, rate, feed_forward;
  error << target.pose.position - m.pose.position, turn.angle() * turn.axis();
  rate << target.twist.velocity - m.twist.velocity,
      target.twist.angular_velocity - m.twist.angular_velocity;
  feed_forward << target.acceleration.velocity, target.acceleration.angular_velocity;

  const double filter = 1.0 - std::exp(-settings_.derivative_filter * omega_ * settings_.period);
  derivative_ += (first_ ? 1.0 : filter) * (rate - derivative_);
  if (first_) origin_ = target.pose;
  first_ = false;

  error_ = error;
  way_ = way_from(origin_, target.pose);
  bond_ = together(m.wrench);
  if (start_) {
    integral_ =
        inverse_inertia_ *
            (together(*start_) + settings_.bond_compensation * bond_ - together(extra)) -
        (feed_forward + 3.0 * omega_ * omega_ * weighted(error) + 3.0 * omega_ * derivative_);
    start_.reset();
  }
  const Vector6 acceleration = feed_forward + 3.0 * omega_ * omega_ * weighted(error) + integral_ +
                               3.0 * omega_ * derivative_;
  const Vector6 wanted =
      inertia_ * acceleration - settings_.bond_compensation * bond_ + together(extra);
  const Vector6 wrench = limited(wanted);
  saturated_ = wrench != wanted;
  const Vector6 excess = inverse_inertia_ * (wrench - wanted);
  integral_ += settings_.period * (std::pow(omega_, 3) * error + omega_ * excess);
  return {wrench.head<3>(), wrench.tail<3>()};
}

}  // namespace fingertip::lattice
