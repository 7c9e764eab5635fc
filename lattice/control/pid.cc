#include "lattice/control/pid.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "lattice/control/hardware.h"

namespace fingertip::lattice::inline control {

namespace {

Vector6 together(const Wrench& wrench) {
  Vector6 both;
  both << wrench.force, wrench.torque;
  return both;
}

/// Displacement and rotation vector.
Vector6 way_from(const Pose& origin, const Pose& pose) {
  Vector6 way;
  way << pose.position - origin.position,
      rotation_vector(pose.orientation * origin.orientation.conjugate());
  return way;
}

}  // namespace

Pid::Pid(const PidSettings& settings, const Matrix6& inertia)
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

/// Of the proportional part: b r - y = (r - y) + (b - 1) r.
Vector6 Pid::weighted(const Vector6& error) const {
  if (settings_.setpoint_weight == 1.0) return error;
  return error + (settings_.setpoint_weight - 1.0) * way_;
}

/// What proportional and derivative part and the fed-forward bond made of the last errors, as an
/// acceleration.
Vector6 Pid::share_without_integral() const {
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
  const Vector6 error = way_from(m.pose, target.pose);
  Vector6 rate, feed_forward;
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
  const Wrench wrench =
      limited({wanted.head<3>(), wanted.tail<3>()}, settings_.force_limit, settings_.torque_limit);
  saturated_ = together(wrench) != wanted;
  const Vector6 excess = inverse_inertia_ * (together(wrench) - wanted);
  integral_ += settings_.period * (std::pow(omega_, 3) * error + omega_ * excess);
  return wrench;
}

}  // namespace fingertip::lattice::inline control
