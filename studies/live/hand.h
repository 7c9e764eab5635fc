/// The hand on the rod: a virtual coupling between the mouse and the rod's endpoint.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "lattice/control/controller.h"

namespace fingertip::studies::inline live {

/// A critically damped spring between a handle and the rod's endpoint: the virtual coupling of
/// haptic rendering (Colgate, Stanley & Brown 1995), with the rod's inertia I as its shape,
///   (F, M) = I (w² (x_h - x, theta) - 2 w (v, omega)),  w² = k/m,
/// theta the rotation vector from the rod to the orientation that it had at the first grip. The
/// spring's force is k (x_h - x) whatever way the rod is pulled, and M holds against the turning
/// that a force at the end of a free rod would cause; both poles of the free rod lie at -w. k is
/// 100 N/m, the spring's force at most 5 N.
class Hand {
 public:
  /// `inertia`: of the rod, 6 x 6 at its endpoint [kg, kg m, kg m²].
  explicit Hand(const Eigen::Matrix<double, 6, 6>& inertia);

  /// Pulls the endpoint toward `place` [m] from now on.
  void hold(const meshes::Vector3& place) { place_ = place; }
  void release();
  const std::optional<meshes::Vector3>& place() const { return place_; }

  /// On the rod at its endpoint; nothing when it is not held.
  lattice::Wrench wrench(const lattice::Measurement& measurement);
  const lattice::Wrench& last() const { return last_; }

 private:
  Eigen::Matrix<double, 6, 6> inertia_;
  double frequency_;  ///< w [rad/s]
  std::optional<meshes::Vector3> place_;
  std::optional<Eigen::Quaterniond> orientation_;
  lattice::Wrench last_;
};

}  // namespace fingertip::studies::inline live
