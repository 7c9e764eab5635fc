/// The pieces of a meridian: lines, circular arcs and cubics.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <vector>

#include "meshes/shape/shape.h"

namespace fingertip::meshes::inline shape {

using Vector2 = Eigen::Vector2d;

/// a x b: positive where b lies to the left of a.
inline double cross(const Vector2& a, const Vector2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

enum class ProfileCurve {
  straight,
  arc,     ///< of a circle, less than half of it
  spline,  ///< consecutive pieces of one surface are one C2 cubic through their corners
};
constexpr auto names_of(ProfileCurve) {
  using enum ProfileCurve;
  return names<ProfileCurve>({{straight, "straight"}, {arc, "arc"}, {spline, "spline"}});
}

/// A piece of the curve, x(t) = (r, z) for t in [0, 1]; rubber lies to its left.
class MeridianPiece {
 public:
  static MeridianPiece line(const Vector2& from, const Vector2& to, ProfileSurface surface);
  /// The shorter arc; `from` and `to` are equally far from `centre`.
  static MeridianPiece arc(const Vector2& from, const Vector2& to, const Vector2& centre,
                           ProfileSurface surface);
  /// Bézier's cubic.
  static MeridianPiece cubic(const Vector2& from, const Vector2& control1, const Vector2& control2,
                             const Vector2& to, ProfileSurface surface);

  ProfileCurve curve() const { return curve_; }
  ProfileSurface surface() const { return surface_; }
  const Vector2& from() const { return from_; }
  const Vector2& to() const { return to_; }
  const Vector2& centre() const { return control1_; }  ///< of an arc
  const Vector2& control1() const { return control1_; }
  const Vector2& control2() const { return control2_; }

  Vector2 at(double t) const;
  /// dx/dt [m].
  Vector2 slope(double t) const;
  /// The unit normal out of the rubber.
  Vector2 normal(double t) const;
  /// The parameter of the nearest point of the piece.
  double nearest(const Vector2& point) const;
  /// A distance that no point of the piece is nearer than [m].
  double farther_than(const Vector2& point) const;
  double length() const;
  /// Area that the piece sweeps between two parameters [m²].
  double area(double from = 0.0, double to = 1.0) const;
  /// The parameters in (0, 1) at which r or z has an extremum, increasing.
  std::vector<double> turning_points() const;

 private:
  ProfileCurve curve_ = ProfileCurve::straight;
  ProfileSurface surface_ = ProfileSurface::free;
  Vector2 from_, to_;
  Vector2 low_, high_;           ///< a box around it
  Vector2 control1_, control2_;  ///< of a cubic; `control1_` of an arc is its centre
  double angle_ = 0.0, sweep_ = 0.0, radius_ = 0.0;
};

/// A part of a piece along which r and z are monotone.
class MonotonePart {
 public:
  MonotonePart(const MeridianPiece& piece, double from, double to);

  double lowest() const { return z_[0]; }
  double highest() const { return z_[1]; }
  /// r at a height within the part, and the height at an r within it; `crosses_radius` tells
  /// whether it is.
  double radius_at(double z) const { return std::max(0.0, other_at(1, z)); }
  double height_at(double r) const { return other_at(0, r); }
  bool crosses_radius(double r) const { return r > r_[0] && r < r_[1]; }

 private:
  /// The other coordinate of the point whose coordinate `axis` (0: r, 1: z) has this value.
  double other_at(int axis, double value) const;

  MeridianPiece piece_;
  double from_, to_;             ///< parameters
  std::array<double, 2> r_, z_;  ///< smallest, largest
};

}  // namespace fingertip::meshes::inline shape
