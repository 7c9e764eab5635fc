/// What the specimen's surfaces answer, whatever the finger is: a body of revolution (meridian.h)
/// or a triangulated solid (solid.h).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>

#include "meshes/base/names.h"

namespace fingertip::meshes::inline shape {

using Vector3 = Eigen::Vector3d;

/// What a piece of a profile or a facet of a solid is; a solid knows contact and bond. Of the dome
/// |w| = R (z >= 0) and rho = R (z < 0) may touch, |w| = r and rho = r are bonded to the rigid rod,
/// the annulus at z = -L is free.
enum class ProfileSurface {
  contact,  ///< may touch
  bond,     ///< held rigidly by the hand
  free,
  axis,  ///< r = 0, no surface
};
constexpr auto names_of(ProfileSurface) {
  using enum ProfileSurface;
  return names<ProfileSurface>(
      {{contact, "contact"}, {bond, "bond"}, {free, "free"}, {axis, "axis"}});
}

/// A point that stands for a patch of a surface.
struct SurfacePoint {
  Vector3 position;  ///< on the surface [m]
  Vector3 normal;    ///< unit vector out of the rubber
  double area;       ///< of the patch [m²]
};

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

}  // namespace fingertip::meshes::inline shape
