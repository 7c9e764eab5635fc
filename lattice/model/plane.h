/// The plane, or other obstacle, that the finger is pressed against.
#pragma once

#include <Eigen/Geometry>

#include "meshes/press/press_protocol.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline model {

/// The plane in rod axes and how it moves when the rod is taken to stand still. The normal points
/// from the plane toward the rod: n = (-sin tilt, 0, -cos tilt); t1 is the rod's x axis projected
/// on the plane and t2 = t1 x n the rod's y axis. The obstacle lies behind the plane and touches it
/// at its top.
struct PressPlane {
  meshes::Vector3 normal = -meshes::Vector3::UnitZ(), t1 = meshes::Vector3::UnitX(),
                  t2 = meshes::Vector3::UnitY();
  double height = 0.0;  ///< distance from the origin at indentation 0, R of the dome [m]
  meshes::Obstacle obstacle;
  meshes::PressPath path;

  /// The point of the plane that lies below the tip's centre at indentation 0, when the plane is at
  /// `s` [m] of its path.
  meshes::Vector3 point(double s) const {
    const meshes::PressPose pose = path.at(s);
    return (pose.indentation - height) * normal + pose.lateral * t1;
  }
  /// How far it has turned about its normal there [rad].
  double twist(double s) const { return path.at(s).twist; }
  /// Its axes t1, t2 and n as columns.
  Eigen::Matrix3d axes() const { return (Eigen::Matrix3d() << t1, t2, normal).finished(); }
};

PressPlane press_plane(const meshes::PressProtocol& protocol, const meshes::Geometry& geometry);

/// How a touching point interacts with the plane.
struct ContactLaw {
  meshes::ContactMode mode = meshes::ContactMode::stick;
  double friction = 0.0;  ///< Coulomb's coefficient, > 0 for coulomb [1]

  ContactLaw(meshes::ContactMode contact = meshes::ContactMode::stick, double coefficient = 0.0)
      : mode(contact), friction(coefficient) {}
};

/// A rigid plane as a body in motion, or the obstacle that it touches at `point`; `normal` (unit)
/// points from the plane toward the finger.
struct Plane {
  meshes::Vector3 point = meshes::Vector3::Zero();             ///< fixed to the plane [m]
  meshes::Vector3 normal = -meshes::Vector3::UnitZ();          ///< at this moment
  meshes::Vector3 velocity = meshes::Vector3::Zero();          ///< of `point` [m/s]
  meshes::Vector3 angular_velocity = meshes::Vector3::Zero();  ///< [rad/s]
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  ///< since the start
  meshes::Obstacle obstacle = {};

  /// Distance of a place from plane or obstacle, negative behind it [m].
  double gap(const meshes::Vector3& place) const {
    if (obstacle.is_plane()) return normal.dot(place - point);
    return hit(obstacle, axes().transpose() * (place - point)).gap;
  }
  /// The gradient of the gap.
  meshes::Vector3 normal_at(const meshes::Vector3& place) const;
  /// The obstacle's axes t1, t2 and n as columns.
  Eigen::Matrix3d axes() const;
  /// A place carried along by the plane: fixed(x) stays the same while the plane moves [m].
  meshes::Vector3 fixed(const meshes::Vector3& place) const {
    return turned.conjugate() * (place - point);
  }
  meshes::Vector3 place(const meshes::Vector3& fixed) const { return point + turned * fixed; }
  meshes::Vector3 velocity_at(const meshes::Vector3& place) const {
    return velocity + angular_velocity.cross(place - point);
  }
  bool at_rest() const { return velocity.isZero(0.0) && angular_velocity.isZero(0.0); }
  /// The plane after `duration` [s] at its present velocities.
  Plane after(double duration) const;
};

/// t1: the rod's x axis projected on a plane with this unit normal; t2 = t1 x normal.
inline meshes::Vector3 first_tangent(const meshes::Vector3& normal) {
  return (meshes::Vector3::UnitX() - normal * normal.x()).normalized();
}
/// t1, t2 and -n as columns: the right-handed axes of contact fields (meshes::ContactPoint).
inline Eigen::Matrix3d field_axes(const meshes::Vector3& normal) {
  const meshes::Vector3 t1 = first_tangent(normal);
  return (Eigen::Matrix3d() << t1, t1.cross(normal), -normal).finished();
}

}  // namespace fingertip::lattice::inline model
