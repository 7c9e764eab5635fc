/// The surface of an obstacle, of one place or of a pack of places at once; plain numbers only.
#pragma once

#include <cmath>

namespace fingertip::meshes::inline press {

/// What the formulas need: a rigid plane, or a body that is round about a point (sphere) or a line
/// (cylinder, rounded edge). Places (x, y, z) have z along the obstacle's normal n, toward the
/// finger, and the origin in the plane that touches the obstacle at its top.
struct ObstacleForm {
  bool flat = true;
  bool edge = false;                      ///< faces at 45 degrees below the rounding
  double radius = 0.0;                    ///< [m]
  double offset_x = 0.0;                  ///< of its top [m]
  double across_x = 0.0, across_y = 0.0;  ///< 1 where the surface bends along x or y, else 0
};

/// Slope of the height beside an obstacle: none is there, but whoever looks for its top is led to
/// it.
inline constexpr double cliff = 1e3;

/// Distance of a place from the obstacle, negative inside, and its gradient: the unit normal out of
/// the obstacle.
template <class T>
struct ObstacleHit {
  T gap{};  ///< [m]
  T normal[3]{};
};

inline double choose(bool holds, double yes, double no) {
  return holds ? yes : no;
}
/// Of packs, lane by lane.
template <class Mask, class T>
[[gnu::always_inline]] inline T choose(const Mask& mask, const T& yes, const T& no) {
  T result = no;
  where(mask, result) = yes;
  return result;
}

/// Exact: |q - c| - radius about the centre or centre line c, and on the faces of an edge the
/// distance to their planes.
template <class T>
ObstacleHit<T> obstacle_hit(const ObstacleForm& form, const T& x, const T& y, const T& z) {
  using std::abs, std::sqrt;
  if (form.flat) return {z, {T(0.0), T(0.0), T(1.0)}};
  const T a = form.across_x * (x - form.offset_x), b = form.across_y * y, c = z + form.radius;
  // At the centre itself any direction is as good as another.
  const T far = sqrt(a * a + b * b + c * c) + T(1e-300);
  ObstacleHit<T> hit{far - form.radius, {a / far, b / far, c / far}};
  if (!form.edge) return hit;
  constexpr double diagonal = 0.70710678118654752;
  const T across = a + b, side = choose(across < T(0.0), T(-diagonal), T(diagonal));
  const auto on_face = abs(across) > c;
  hit.gap = choose(on_face, diagonal * (abs(across) + c) - form.radius, hit.gap);
  hit.normal[0] = choose(on_face, form.across_x * side, hit.normal[0]);
  hit.normal[1] = choose(on_face, form.across_y * side, hit.normal[1]);
  hit.normal[2] = choose(on_face, T(diagonal), hit.normal[2]);
  return hit;
}

/// Height of the obstacle at (x, y) [m], 0 at its top; beside it, below its middle.
template <class T>
T obstacle_height(const ObstacleForm& form, const T& x, const T& y) {
  using std::abs, std::sqrt;
  if (form.flat) return T(0.0);
  const T a = form.across_x * (x - form.offset_x), b = form.across_y * y, square = a * a + b * b;
  const T within = form.radius * form.radius - square;
  const T round = sqrt(choose(within > T(0.0), within, T(0.0))) - form.radius;
  if (!form.edge)
    return round - cliff * choose(within > T(0.0), T(0.0), sqrt(square) - form.radius);
  constexpr double root = 1.41421356237309505;
  const T across = abs(a + b);
  return choose(root * across < T(form.radius), round, (root - 1.0) * form.radius - across);
}

/// At small strain a gap is told at a point's foot: the place of the obstacle that is opposite to
/// the point at rest, for displacements are small. Where the obstacle moves along its plane they
/// are not: what sticks goes along with it, and must stay opposite to the same place, or the
/// obstacle would rise and sink below it. So a foot moves by the share, 0 to 1, of the way
/// (rx, ry) of the point at rest over the obstacle, that the point itself makes along it, which
/// goes by (x, y): none of it where it sticks, all where the tip stays where it was.
template <class T>
[[gnu::always_inline]] inline T share_passed(const T& x, const T& y, const T& rx, const T& ry) {
  const T square = rx * rx + ry * ry, along = x * rx + y * ry;
  const T part = choose(along < square, along, square);
  return choose(part > T(0.0), part, T(0.0)) / choose(square > T(0.0), square, T(1.0));
}

}  // namespace fingertip::meshes::inline press
