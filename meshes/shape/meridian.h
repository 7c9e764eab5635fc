/// The closed curve in the half plane r >= 0 that sweeps a body of revolution: lines, circular arcs
/// and cubics.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string_view>
#include <vector>

#include "meshes/shape/profile_pieces.h"
#include "meshes/shape/shape.h"

namespace fingertip::meshes::inline shape {

/// Immutable. Lengths in metres.
class Meridian final : public Shape {
 public:
  /// Throws InvalidInput with the corner when the curve is open, crosses itself or leaves r >= 0,
  /// an arc has no centre, `contact` or `bond` is missing, the pole is not on the axis, or the
  /// finger is smaller than 0.5 mm or larger than 0.5 m.
  explicit Meridian(std::vector<ProfileCorner> corners);

  const std::vector<MeridianPiece>& pieces() const { return pieces_; }

  double signed_distance(const Vector3& w) const override;
  NearestPoint nearest(ProfileSurface surface, const Vector3& w) const override;
  double reach(double tilt) const override;
  HighestPlace highest(ProfileSurface surface, const HeightOf& height) const override;
  double volume() const override;
  double area(ProfileSurface surface) const override;
  double pole() const override { return pole_; }
  double lowest() const override { return lowest_; }
  double largest_radius() const override { return radius_; }
  double bond_top() const override { return bond_top_; }
  double bond_radius() const override;
  double pole_radius() const override;
  double wall() const override;

  /// In the meridian (r, z); the axis is no boundary.
  double signed_distance(const Vector2& point) const;
  bool contains(const Vector2& point) const;
  bool contains(const Vector3& w) const;
  /// Where the boundary meets the height z, from the largest r; the rubber lies between the first
  /// and the second, the third and the fourth ...; within the last one of an odd number. For
  /// heights that are no corner's.
  std::vector<double> radii(double z) const;
  const std::vector<MonotonePart>& parts() const { return parts_; }

 private:
  void measure();

  std::vector<MeridianPiece> pieces_;
  std::vector<MonotonePart> parts_;
  double pole_ = 0.0, lowest_ = 0.0, radius_ = 0.0, bond_top_ = 0.0;
};

}  // namespace fingertip::meshes::inline shape
