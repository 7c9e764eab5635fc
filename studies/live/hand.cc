#include "studies/live/hand.h"

#include <cmath>

namespace fingertip::studies::inline live {

Hand::Hand(const Eigen::Matrix<double, 6, 6>& inertia, const HandSettings& settings)
    : inertia_(inertia),
      settings_(settings),
      frequency_(std::sqrt(settings.stiffness / inertia(0, 0))) {}

void Hand::release() {
  place_.reset();
  orientation_.reset();
  last_ = {};
}

lattice::Wrench Hand::wrench(const lattice::Measurement& m) {
  last_ = {};
  if (!place_) return last_;
  if (!orientation_) orientation_ = m.pose.orientation;
  meshes::Vector3 way = *place_ - m.pose.position;
  const double longest = settings_.force_limit / settings_.stiffness;
  if (way.norm() > longest) way *= longest / way.norm();
  Eigen::Matrix<double, 6, 1> error, rate;
  error << way, lattice::rotation_vector(*orientation_ * m.pose.orientation.conjugate());
  rate << m.twist.velocity, m.twist.angular_velocity;
  const Eigen::Matrix<double, 6, 1> wrench =
      inertia_ * (frequency_ * frequency_ * error - 2.0 * frequency_ * rate);
  last_ = {wrench.head<3>(), wrench.tail<3>()};
  return last_;
}

}  // namespace fingertip::studies::inline live
