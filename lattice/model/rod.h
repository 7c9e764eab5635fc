/// The rigid rod: six degrees of freedom, inertia from its shape (paper, section III and Fig. 1).
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline model {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Inertia against (acceleration of a point, angular acceleration) of a rigid body whose centre of
/// mass lies at `arm` [m] from that point, with `inertia` about the centre [kg m²]: it yields
/// (force, torque about the point) for a body at rest.
Matrix6 rigid_inertia(double mass, const meshes::Vector3& arm,
                      const Eigen::Matrix3d& inertia = Eigen::Matrix3d::Zero());

/// Of two forms of a rigid body's motion about the same point, whichever it is, such as the kinetic
/// energies of rubber and hand: the largest ratio over all motions. That of masses is one motion's.
double largest_ratio(const Matrix6& form, const Matrix6& inertia);

/// Acceleration of a point at `arm` from another that accelerates so, with angular acceleration, of
/// a rigid body at rest: a + w x arm.
Eigen::Matrix<double, 3, 6> rigid_motion(const meshes::Vector3& arm);

/// The rigid rod: its shape comes from the geometry.
struct RodSettings {
  double density = 2700.0;  ///< [kg/m³], > 0
};

/// A force [N] and a torque [N m] about a stated point, in world axes.
struct Wrench {
  meshes::Vector3 force = meshes::Vector3::Zero();
  meshes::Vector3 torque = meshes::Vector3::Zero();
};

/// Velocity of a stated point of a rigid body and its angular velocity, in world axes.
struct Twist {
  meshes::Vector3 velocity = meshes::Vector3::Zero();          ///< [m/s]
  meshes::Vector3 angular_velocity = meshes::Vector3::Zero();  ///< [rad/s]
};

/// Where a rigid body is: x = position + orientation * X for a body-frame point X.
struct Pose {
  meshes::Vector3 position = meshes::Vector3::Zero();  ///< [m]
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();

  meshes::Vector3 operator*(const meshes::Vector3& body_point) const {
    return position + orientation * body_point;
  }
};

/// Mass properties of the cylinder (radius r, from z = 0 to -l) with the hemisphere on top, in the
/// finger's frame.
struct RodBody {
  double mass = 0.0;                                   ///< M [kg]
  meshes::Vector3 centre = meshes::Vector3::Zero();    ///< centre of mass [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();   ///< about the centre of mass [kg m²]
  meshes::Vector3 endpoint = meshes::Vector3::Zero();  ///< (0, 0, -l) [m]

  /// About the endpoint, in the starting orientation.
  Matrix6 inertia_at_endpoint() const { return rigid_inertia(mass, centre - endpoint, inertia); }
};

RodBody rod_body(const meshes::Geometry& geometry, const RodSettings& settings);

/// Motion of the rod. Momentum and angular momentum are the state, so that without forces both are
/// conserved to round-off and the gyroscopic term needs no formula of its own.
class RodState {
 public:
  /// At rest where the geometry puts it.
  explicit RodState(const RodBody& body = {});

  Pose pose() const;  ///< of the finger's frame
  meshes::Vector3 endpoint() const { return pose() * body_.endpoint; }
  const meshes::Vector3& centre() const { return centre_; }            ///< centre of mass [m]
  meshes::Vector3 velocity() const { return momentum_ / body_.mass; }  ///< of the centre [m/s]
  meshes::Vector3 angular_velocity() const;                            ///< [rad/s], world axes
  meshes::Vector3 velocity_at(const meshes::Vector3& point) const;  ///< of the rod at a world point
  const meshes::Vector3& momentum() const { return momentum_; }     ///< [N s]
  const meshes::Vector3& angular_momentum() const { return spin_; }  ///< about the centre [N m s]
  Eigen::Matrix3d world_inertia() const;  ///< about the centre, world axes [kg m²]
  double kinetic_energy() const;          ///< [J]
  const RodBody& body() const { return body_; }

  /// Changes the momenta by `wrench` about world point `at` acting for `duration` [s].
  void kick(const Wrench& wrench, const meshes::Vector3& at, double duration);
  /// Moves with the present momenta for `duration` [s]: the centre exactly, the orientation by the
  /// exponential map of SO(3) with the angular velocity halfway (explicit midpoint, second order).
  void drift(double duration);
  /// Puts the rod, in its starting orientation, at `travel` [m] with velocity [m/s], not turning.
  void prescribe(const meshes::Vector3& travel, const meshes::Vector3& velocity);
  /// Sets velocity of the centre and angular velocity (world axes).
  void set_velocity(const meshes::Vector3& velocity, const meshes::Vector3& angular_velocity);
  /// Puts the rod in any state: centre of mass [m], orientation (normalised here), momentum [N s]
  /// and angular momentum about the centre [N m s], world axes.
  void set_state(const meshes::Vector3& centre, const Eigen::Quaterniond& orientation,
                 const meshes::Vector3& momentum, const meshes::Vector3& angular_momentum);

 private:
  RodBody body_;
  meshes::Vector3 centre_;
  Eigen::Quaterniond orientation_ = Eigen::Quaterniond::Identity();
  meshes::Vector3 momentum_ = meshes::Vector3::Zero();
  meshes::Vector3 spin_ = meshes::Vector3::Zero();
};

/// Rotation by the vector `turn` (axis times angle [rad]).
Eigen::Quaterniond rotation_by(const meshes::Vector3& turn);
/// Its inverse: axis times angle [rad] of a unit quaternion, no longer than pi.
meshes::Vector3 rotation_vector(const Eigen::Quaterniond& rotation);

}  // namespace fingertip::lattice::inline model
