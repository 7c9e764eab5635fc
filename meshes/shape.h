/// What the specimen's surfaces answer, whatever the finger is: a body of revolution (meridian.h)
/// or a triangulated solid (solid.h).
#pragma once

#include <functional>
#include <limits>
#include <memory>

#include "meshes/geometry.h"
#include "meshes/obstacle.h"

namespace fingertip::meshes {

/// A point of a surface in space, and the unit normal out of the rubber there.
struct NearestPoint {
  double distance = 0.0;  ///< to the point asked for [m]; infinite where there is no such surface
  Vector3 position = Vector3::Zero(), normal = Vector3::Zero();
};

struct HighestPlace {
  double height = -std::numeric_limits<double>::infinity();  ///< [m]
  Vector3 place = Vector3::Zero();
};

/// A concave function of the place [m], symmetric under y -> -y. `revolved`: it does not change
/// about the axis.
struct HeightOf {
  std::function<double(const Vector3&)> at;
  bool revolved = false;
};

/// Immutable. Lengths in metres.
class Shape {
 public:
  virtual ~Shape() = default;

  /// Distance to the rubber's boundary, negative inside.
  virtual double signed_distance(const Vector3& w) const = 0;
  /// The point of a surface that is nearest to `w`.
  virtual NearestPoint nearest(ProfileSurface surface, const Vector3& w) const = 0;
  /// The largest component of a place on `contact` along the axis turned by `tilt` [rad] [m]: what
  /// a tilted plane touches first.
  virtual double reach(double tilt) const = 0;
  /// Where a surface is highest. Minus infinity where there is no such surface.
  virtual HighestPlace highest(ProfileSurface surface, const HeightOf& height) const = 0;

  virtual double volume() const = 0;                      ///< [m³]
  virtual double area(ProfileSurface surface) const = 0;  ///< [m²]
  virtual double pole() const = 0;                        ///< largest z of `contact`
  virtual double lowest() const = 0;
  virtual double largest_radius() const = 0;  ///< from the axis
  virtual double bond_top() const = 0;        ///< largest z of `bond` under rubber
  virtual double bond_radius() const = 0;     ///< largest distance of `bond` from the axis
  /// Radius of curvature at the pole; of a flat or pointed one the largest radius.
  virtual double pole_radius() const = 0;
  /// The thinnest wall: from `contact` along the normal to a boundary that is far along the
  /// surface; at most the height of the pole over the bond.
  virtual double wall() const = 0;
};

/// Radius of the ball on a plane that a body's pole and an obstacle are like, where they touch: 1/R
/// = 1/R1 + 1/R2 along each axis, and the geometric mean of both (K. L. Johnson, Contact Mechanics,
/// 1985, section 4.1) [m].
double relative_radius(const Shape& shape, const Obstacle& obstacle);

/// Of the geometry: its solid, else its meridian. Throws InvalidInput for an invalid geometry.
std::shared_ptr<const Shape> shape_of(const Geometry& geometry);

}  // namespace fingertip::meshes
