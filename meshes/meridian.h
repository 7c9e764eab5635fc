/// The closed curve in the half plane r >= 0 that sweeps a body of revolution: lines, circular arcs
/// and cubics.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

#include "meshes/geometry.h"
#include "meshes/meridian_piece.h"

namespace fingertip::meshes {

/// A point of a surface in space, and the unit normal out of the rubber there.
struct NearestPoint {
  double distance = 0.0;  ///< to the point asked for [m]
  Vector3 position = Vector3::Zero(), normal = Vector3::Zero();
};

struct HighestPlace {
  double height = -std::numeric_limits<double>::infinity();  ///< [m]
  Vector3 place = Vector3::Zero();
};

/// Immutable. Lengths in metres.
class Meridian {
 public:
  /// Of the dome or of the profile. Throws InvalidInput with the corner when the curve is open,
  /// crosses itself or leaves r >= 0, an arc has no centre, `contact` or `bond` is missing, the
  /// pole is not on the axis, or the finger is smaller than 0.5 mm or larger than 0.5 m.
  explicit Meridian(const Geometry& geometry);

  const std::vector<MeridianPiece>& pieces() const { return pieces_; }

  /// Distance to the body's boundary, the axis being none: negative inside the rubber.
  double signed_distance(const Vector2& point) const;
  double signed_distance(const Vector3& w) const;
  /// The point of a surface that is nearest to `w`.
  NearestPoint nearest(ProfileSurface surface, const Vector3& w) const;
  /// The largest component of a place on `contact` along the axis turned by `tilt` [rad] [m]: what
  /// a tilted plane touches first.
  double reach(double tilt) const;
  /// The largest value of `height` on a surface; it is symmetric under y -> -y, and does not change
  /// about the axis where it is `revolved`. Minus infinity where
  /// there is no such surface.
  HighestPlace highest(ProfileSurface surface, bool revolved,
                       const std::function<double(const Vector3&)>& height) const;
  bool contains(const Vector2& point) const;
  bool contains(const Vector3& w) const;
  /// Where the boundary meets the height z, from the largest r; the rubber lies between the first
  /// and the second, the third and the fourth ...; within the last one of an odd number. For
  /// heights that are no corner's.
  std::vector<double> radii(double z) const;
  const std::vector<MonotonePart>& parts() const { return parts_; }

  double volume() const;                      ///< [m³]
  double area(ProfileSurface surface) const;  ///< [m²]
  double pole() const { return pole_; }       ///< largest z of `contact`
  double lowest() const { return lowest_; }
  double largest_radius() const { return radius_; }
  /// Largest z of `bond`.
  double bond_top() const { return bond_top_; }
  /// Radius of curvature at the pole; of a flat or pointed one the largest radius.
  double pole_radius() const;
  /// The thinnest wall: from `contact` along the normal to a boundary that is far along the
  /// surface; at most the height of the pole over the bond.
  double wall() const;

 private:
  int chords_of(const MeridianPiece& piece) const;
  void check_crossings() const;
  void measure();

  std::vector<MeridianPiece> pieces_;
  std::vector<MonotonePart> parts_;
  double pole_ = 0.0, lowest_ = 0.0, radius_ = 0.0, bond_top_ = 0.0;
};

/// What the hand holds, for pictures: curves (r, z) from below upward that sweep the dome's rod, or
/// a block below a profile and its bond; `points` on each curved piece.
std::vector<std::vector<Vector2>> held_outlines(const Geometry& geometry, int points);

}  // namespace fingertip::meshes
