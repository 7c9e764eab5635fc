/// Size and pressure of a contact that is known by the forces on scattered points.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "meshes/press/contact_field.h"

namespace fingertip::meshes::inline press {

/// A point of the outer surface as seen along the plane's normal.
struct LoadedPoint {
  Eigen::Vector2d place;  ///< along t1 and t2 [m]
  double force = 0.0;     ///< of the plane, along its normal [N]
  double area = 0.0;      ///< of the surface it stands for, projected on the plane [m²]
};

/// Sums over loaded points, from which the patch follows.
struct ForceMoments {
  /// Σ force x^i y^j up to the fourth order, at `place(i, j)` [N m^(i+j)].
  std::array<double, 15> power{};
  double area = 0.0;     ///< Σ force area [N m²]
  double touched = 0.0;  ///< Σ area of points with a force [m²]

  static constexpr std::size_t place(std::size_t i, std::size_t j) {
    return (i + j) * (i + j + 1) / 2 + j;
  }
  void add(const LoadedPoint& point);
};

/// What a part of the rubber bears, and with what the ellipse's pressure would load it [N].
struct PatchLoad {
  double borne = 0.0, expected = 0.0;
};

struct ContactPatch {
  double radius = 0.0;        ///< of the circle that has the contact's area [m]
  double max_pressure = 0.0;  ///< force over the area that it acts on, deformed or not [Pa]
  /// Of an ellipse: s = d·(ellipse d) at d from the centre [1/m²]; else zero.
  Eigen::Matrix2d ellipse = Eigen::Matrix2d::Zero();
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< of pressure [m]
  double peak = 0.0;                                 ///< b
  double touched = 0.0;  ///< area of the points that are pushed, of the whole contact [m²]
  bool is_fine = false;  ///< whether points are so many that their loads tell an ellipse

  bool is_ellipse() const { return ellipse(0, 0) > 0.0; }
  /// Pressure at a place over that in the middle, 0 outside; of an ellipse.
  double profile(const Eigen::Vector2d& place) const;
  /// The same where these are loads of an ellipse; else, where points are many, without one: the
  /// radius is that of the points' own area, the largest pressure unknown. `bare`: share of the
  /// surface in the ellipse that is not pushed, of whoever knows such points; a face has none.
  ContactPatch judged_by(std::span<const PatchLoad> loads, double bare = 1.0) const;
};

/// Both from moments of the forces, for neighbouring points share their load unevenly (their ties
/// outnumber the particles around them) while sums over many of them are right. How the surface has
/// stretched need not be known: the places are those where the forces act.
///
/// The pressure is taken to be that of Hertz with a peak on top,
///   p = P ((1 - s)^(1/2) + b (1 - s)^(7/2))/(1 + b),  s = x²/A² + y²/B²,  0 <= b <= 2,
/// about the centre of pressure, A and B half axes. Thin rubber that is pressed far carries most of
/// its load in the middle. With S the second moments of pressure and t = x S^-1 x: mean t² = 4 q,
/// q = <s²>/<s>² a function of b alone; then sqrt(A B) = (4 det S/<s>²)^(1/4) and P from the force.
/// Hertz has q = 10/7, <s> = 2/5; what lies below is the coarseness of the points and counts as
/// Hertz. The exponent 7/2 is chosen by continuum presses of the default tip: fed with their
/// pressures, law A to 0.7 of the rubber's thickness, sticking or not, this gives their radius
/// within 1 % (Hertz alone: up to 8 % too small) and P within 3 %.
/// A point's own patch counts as a disc.
///
/// Moments fit an ellipse to anything: to the face of a pad one that is wider than the face. So
/// whoever knows the loads of the particles, which are right where those of ties are not, judges
/// it (ContactPatch::judged_by): (Σ |F - G| + |Σ (F - G)|)/ΣF over particles, F what they bear, G
/// what the ellipse's pressure on the surface there is would load them with, is 0.02 to 0.064 on
/// domes of three and more spacings over the radius, 0.17 and more on flat pads. A nearly
/// incompressible pad's pressure may be as an ellipse's, but all of its points are pushed: on
/// domes up to 94 % of the area.
///
/// `sectors` (1, 2 or 4): the points are the whole contact, its half t2 >= 0 or its quarter
/// t1, t2 >= 0. Zeros without a loaded point.
ContactPatch contact_patch(const ForceMoments& moments, int sectors = 1);
/// Of a field, along whose axes the ellipse is told, judged by its own points.
ContactPatch contact_patch(std::span<const ContactPoint> field, int sectors = 1);

/// The largest pressure of a field, that of an ellipse in its middle, which the points may miss
/// [Pa]; 0 of no points.
double largest_pressure(std::span<const ContactPoint> field);

}  // namespace fingertip::meshes::inline press
