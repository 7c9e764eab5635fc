/// The plane that the finger is pressed against.
#pragma once

#include <Eigen/Geometry>

#include "meshes/geometry.h"
#include "meshes/press_protocol.h"

namespace fingertip::lattice {

/// The plane in rod axes and how it moves when the rod is taken to stand still. The normal points
/// from the plane toward the rod: n = (-sin tilt, 0, -cos tilt); t1 is the rod's x axis projected
/// on the plane and t2 = t1 x n the rod's y axis.
struct PressPlane {
  meshes::Vector3 normal = -meshes::Vector3::UnitZ(), t1 = meshes::Vector3::UnitX(),
                  t2 = meshes::Vector3::UnitY();
  double radius = 0.0;         ///< R: distance from the tip's centre at indentation 0 [m]
  double lateral_ratio = 0.0;  ///< displacement along t1 per indentation

  /// The point of the plane that lies below the tip's centre at indentation 0 [m].
  meshes::Vector3 point(double indentation) const {
    return (indentation - radius) * normal + lateral_ratio * indentation * t1;
  }
};

PressPlane press_plane(const meshes::PressProtocol& protocol, const meshes::Geometry& geometry);

/// A rigid plane at rest; `normal` (unit) points from the plane toward the finger.
struct Plane {
  meshes::Vector3 point = meshes::Vector3::Zero();
  meshes::Vector3 normal = -meshes::Vector3::UnitZ();
};

/// t1: the rod's x axis projected on a plane with this unit normal; t2 = t1 x normal.
inline meshes::Vector3 first_tangent(const meshes::Vector3& normal) {
  return (meshes::Vector3::UnitX() - normal * normal.x()).normalized();
}

}  // namespace fingertip::lattice
