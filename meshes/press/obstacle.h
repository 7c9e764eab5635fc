/// What the finger is pressed against: a rigid plane, sphere, cylinder or rounded edge.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/base/names.h"
#include "meshes/press/obstacle_surface.h"
#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline press {

enum class ObstacleShape {
  plane,
  sphere,
  cylinder,  ///< endless
  edge,      ///< an endless wedge of 90 degrees, rounded, its faces at 45 degrees to the normal
};
constexpr auto names_of(ObstacleShape) {
  using enum ObstacleShape;
  return names<ObstacleShape>(
      {{plane, "plane"}, {sphere, "sphere"}, {cylinder, "cylinder"}, {edge, "edge"}});
}

/// Axis of a cylinder or an edge.
enum class ObstacleAxis {
  x,  ///< along t1
  y,  ///< along t2
};
constexpr auto names_of(ObstacleAxis) {
  return names<ObstacleAxis>({{ObstacleAxis::x, "x"}, {ObstacleAxis::y, "y"}});
}

/// Its axes are t1, t2 and the normal n of the plane that touches it at its top: where the plane of
/// a press would be.
struct Obstacle {
  ObstacleShape shape = ObstacleShape::plane;
  double radius = 0.010;  ///< of sphere or cylinder, or of an edge's rounding, > 0 [m]
  ObstacleAxis along = ObstacleAxis::y;  ///< of cylinder and edge
  double offset = 0.0;                   ///< of its top along t1 [m]

  bool is_plane() const { return shape == ObstacleShape::plane; }
  /// Whether it is a body of revolution about the finger's axis.
  bool on_axis() const { return is_plane() || (shape == ObstacleShape::sphere && offset == 0.0); }
  /// Whether it is its own mirror image under t1 -> -t1 (as under t2 -> -t2 it always is).
  bool mirrored() const { return is_plane() || along_x() || offset == 0.0; }
  /// Whether it extends along t1 without end, so that `offset` does not matter.
  bool along_x() const {
    return (shape == ObstacleShape::cylinder || shape == ObstacleShape::edge) &&
           along == ObstacleAxis::x;
  }
  /// Whether `along` and `offset` say something.
  bool has_axis() const { return shape != ObstacleShape::sphere; }
  bool has_offset() const { return !along_x(); }
  ObstacleForm form() const;

  /// Every rule it breaks under a press of `geometry` tilted by `tilt` [rad] to `depth` [m]: among
  /// them that it touches first where the finger may touch.
  std::vector<Violation> violations(const Geometry& geometry, double tilt) const;
};

/// Exact distance from the obstacle, and the normal, at a place in its axes, z from its top [m].
ObstacleHit<double> hit(const Obstacle& obstacle, const Vector3& place);
/// Derivative of the normal with respect to the place, symmetric [1/m].
Eigen::Matrix3d curvature(const Obstacle& obstacle, const Vector3& place);
/// Height at a place, 0 at the top; where there is no obstacle it falls steeply away from it [m].
double height(const Obstacle& obstacle, const Vector3& place);

/// Its surface near the top for pictures: quadrangles, in its axes. What lies within `half` [m] of
/// the top along t1 and t2; of a sphere its upper half at most.
struct ObstacleMesh {
  std::vector<Vector3> points;
  std::vector<std::array<std::size_t, 4>> quadrangles;
};
ObstacleMesh obstacle_mesh(const Obstacle& obstacle, double half);

/// The place of what may touch, in the finger's axes, that the obstacle touches first [m].
Vector3 touched_first(const Geometry& geometry, double tilt, const Obstacle& obstacle);

/// Radius of the ball on a plane that a body's pole and an obstacle are like, where they touch: 1/R
/// = 1/R1 + 1/R2 along each axis, and the geometric mean of both (K. L. Johnson, Contact Mechanics,
/// 1985, section 4.1) [m].
double relative_radius(const Shape& shape, const Obstacle& obstacle);

/// How far the top's plane is from the origin, along the normal, when the obstacle first touches
/// what may touch of a finger tilted by `tilt` [rad] against it [m].
double first_touch(const Geometry& geometry, double tilt, const Obstacle& obstacle);

}  // namespace fingertip::meshes::inline press
