#include "studies/live/hand.h"

#include <cmath>

namespace fingertip::studies::inline live {

namespace {
constexpr double stiffness = 100.0, longest = 5.0 / stiffness;  // [N/m], [m]
}  // namespace

Hand::Hand(const Eigen::Matrix<double, 6, 6>& inertia)
    : inertia_(inertia), frequency_(std::sqrt(stiffness / inertia(0, 0))) {}

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
