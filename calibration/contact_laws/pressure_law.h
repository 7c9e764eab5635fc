/// A pressure over penetration that stands for a finger in simulators whose bodies overlap: Drake's
/// hydroelastic contact, foundations of springs.
///
/// Finger and obstacle keep their shapes and overlap by the indentation delta. Over the projection
/// of what may touch onto the plane the obstacle's top touches, g is the gap at first touch, so the
/// penetration is delta - g, and F(delta) = ∫ p(delta - g) dA where that is positive. For a ball of
/// radius R on a plane dA = 2π(R - g) dg, so p = F'/(2πR) for shallow ones: Hertz' F ~ delta^(3/2)
/// is p ~ d^(1/2).
#pragma once

#include <functional>
#include <vector>

#include "meshes/press/obstacle.h"
#include "meshes/shape/geometry.h"

namespace fingertip::calibration::inline contact_laws {

/// How deep parts of an overlap are, and their areas, projected along the press.
struct Overlap {
  std::vector<double> depth, area;  ///< [m], [m²]
};
/// At an indentation [m].
using Overlaps = std::function<Overlap(double)>;

/// Gaps between a finger and an obstacle at first touch, over the projected area of what may touch.
struct GapField {
  std::vector<double> gap;   ///< increasing [m]
  std::vector<double> area;  ///< projected, of the patch that the gap stands for [m²]

  /// Projected area of the overlap at an indentation [m²].
  double overlap(double indentation) const;
  /// Deep as the press goes.
  Overlap operator()(double indentation) const;
};

/// Patches of a few hundredths of the depth's contact, whose gaps are below `depth` [m]. Throws
/// InvalidInput for an invalid geometry.
GapField gap_field(const meshes::Geometry& geometry, const meshes::Obstacle& obstacle,
                   double depth);

/// The obstacle's surface in the finger, deep as the finger's surface is away: simulators that know
/// shapes by their signed distance. Patches some times as large as a gap_field's. Throws likewise.
Overlaps surface_distances(const meshes::Geometry& geometry, const meshes::Obstacle& obstacle,
                           double depth);

/// p(d) [Pa] by straight lines between knots from (0, 0) on; steeper as the last piece beyond.
struct PressureTable {
  std::vector<double> penetration, pressure;  ///< [m], [Pa], both increasing from 0
  double at(double d) const;
};

/// p = stiffness d^exponent, [Pa/m^exponent]
struct PowerLaw {
  double stiffness = 0.0, exponent = 0.5;
  double at(double d) const;
};

/// p = first d + second d² + third d³. [Pa/m], [Pa/m²] ...
struct PressurePolynomial {
  double first = 0.0, second = 0.0, third = 0.0;
  double at(double d) const;
  /// Whether p nowhere falls between 0 and a penetration [m].
  bool grows_to(double d) const;
};

/// Force of a law [N].
template <typename Law>
double force_of(const Law& law, const Overlap& overlap) {
  double force = 0.0;
  for (std::size_t i = 0; i < overlap.depth.size(); ++i)
    force += overlap.area[i] * law.at(overlap.depth[i]);
  return force;
}

/// Forces of a press at increasing indentations, from first touch on.
struct ForceCurve {
  std::vector<double> indentation, force;  ///< [m], [N], positive and increasing
};

/// The factor on `forces`, at the first samples of the curve, whose relative errors have the least
/// sum of squares; NaN where all forces are zero.
double fitted_factor(const std::vector<double>& forces, const ForceCurve& curve);

/// Throws InvalidInput unless the curve has two samples or more, increasing and positive.
void check_growth(const ForceCurve& curve);

/// The laws whose relative errors of force have the least sum of squares on the curve. The table
/// has a knot at every indentation of it, and two before, and never falls: where a curve asks for
/// that, forces are not met. Throws InvalidInput unless the curve has two samples or more,
/// increasing and positive.
PressureTable fitted_table(const ForceCurve& curve, const Overlaps& overlaps);
PowerLaw fitted_power(const ForceCurve& curve, const Overlaps& overlaps);
/// Where the best one falls within the curve: the best one without a negative coefficient.
PressurePolynomial fitted_polynomial(const ForceCurve& curve, const Overlaps& overlaps);
/// Only the first coefficient: p = k d. Drake's hydroelastic modulus of a body with extent H is k
/// H.
PressurePolynomial fitted_line(const ForceCurve& curve, const Overlaps& overlaps);

/// A ball of Drake's hydroelastic contact (R. Elandt et al., IROS 2019): within it is a pressure
/// that grows to its centre; a rigid body takes the pressure on its surface.
/// p = modulus (1 - r/radius), r from the centre.
struct HydroelasticBall {
  double modulus = 0.0;  ///< Drake's `hydroelastic_modulus` [Pa]
  double radius = 0.0;   ///< [m]

  /// Of a rigid obstacle whose top is behind the pole by `indentation` [m], along the axis [N]: the
  /// integral of p over its surface in the ball, projected. On a plane 2π modulus (a²/2 - (R³ -
  /// h³)/ (3R)), h = R - delta, a² = R² - h².
  double force(const meshes::Obstacle& obstacle, double indentation) const;
};

/// Of the modulus whose relative errors of force have the least sum of squares. Throws InvalidInput
/// unless the curve has two samples or more, increasing and positive.
HydroelasticBall fitted_hydroelastic_ball(const ForceCurve& curve, const meshes::Obstacle& obstacle,
                                          double radius);

}  // namespace fingertip::calibration::inline contact_laws
