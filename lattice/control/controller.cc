#include "lattice/control/controller.h"

namespace fingertip::lattice::inline control {

bool finite(const Wrench& wrench) {
  return wrench.force.allFinite() && wrench.torque.allFinite();
}

bool finite(const Target& target) {
  const auto moves = [](const Twist& twist) {
    return twist.velocity.allFinite() && twist.angular_velocity.allFinite();
  };
  return target.pose.position.allFinite() && target.pose.orientation.coeffs().allFinite() &&
         moves(target.twist) && moves(target.acceleration);
}

}  // namespace fingertip::lattice::inline control
