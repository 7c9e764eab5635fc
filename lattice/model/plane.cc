#include "lattice/model/plane.h"

#include <cmath>

#include "lattice/model/rod.h"

namespace fingertip::lattice::inline model {

using meshes::Vector3;

PressPlane press_plane(const meshes::PressProtocol& protocol, const meshes::Geometry& geometry) {
  const double s = std::sin(protocol.tilt), c = std::cos(protocol.tilt);
  PressPlane plane;
  plane.normal = Vector3(-s, 0.0, -c);
  plane.t1 = first_tangent(plane.normal);
  plane.t2 = plane.t1.cross(plane.normal);
  plane.obstacle = protocol.obstacle;
  plane.height = meshes::first_touch(geometry, protocol.tilt, protocol.obstacle);
  plane.path = meshes::PressPath(protocol);
  return plane;
}

Eigen::Matrix3d Plane::axes() const {
  const Vector3 start = turned.conjugate() * normal, t1 = first_tangent(start);
  return turned * (Eigen::Matrix3d() << t1, t1.cross(start), start).finished();
}

Vector3 Plane::normal_at(const Vector3& place) const {
  if (obstacle.is_plane()) return normal;
  const Eigen::Matrix3d own = axes();
  return own * Vector3(hit(obstacle, own.transpose() * (place - point)).normal);
}

Plane Plane::after(double duration) const {
  if (at_rest()) return *this;
  Plane moved = *this;
  const Eigen::Quaterniond turn = rotation_by(duration * angular_velocity);
  moved.point += duration * velocity;
  moved.normal = (turn * normal).normalized();
  moved.turned = (turn * turned).normalized();
  return moved;
}

}  // namespace fingertip::lattice::inline model
