#include "meshes/cells/surface_points.h"

#include <algorithm>
#include <boost/math/quadrature/gauss.hpp>
#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <numbers>

#include "meshes/base/files.h"
#include "meshes/shape/meridian.h"
#include "meshes/shape/solid.h"

namespace fingertip::meshes::inline cells {

namespace {

using std::numbers::pi;

/// Pieces no longer than `longest` that make up `length` [m]; none for a length of zero.
int pieces(double length, double longest) {
  return int(std::ceil(length / longest));
}

/// A band of the surface between two circles about the axis, and the circle of its points.
struct Ring {
  double radius;         ///< of the points' circle [m]
  double z;              ///< its height [m]
  double area;           ///< of the whole band [m²]
  double normal_across;  ///< the unit normal's component away from the axis
  double normal_up;      ///< and along z
};

/// Appends the ring's points. Their number is a multiple of eight and the first is half a step from
/// the plane y = 0, so that mirror planes, the diagonal ones included, pass between points.
void add_ring(const Ring& ring, double spacing, std::vector<SurfacePoint>& points) {
  const int count = 8 * std::max(1, pieces(2.0 * pi * ring.radius, 8.0 * spacing));
  for (int i = 0; i < count; ++i) {
    const double angle = 2.0 * pi * (i + 0.5) / count;
    const double x = std::cos(angle), y = std::sin(angle);
    points.push_back({{ring.radius * x, ring.radius * y, ring.z},
                      {ring.normal_across * x, ring.normal_across * y, ring.normal_up},
                      ring.area / count});
  }
}

/// Of a band's points: where a piece has the band's mean height (arcs: area is uniform in z where
/// the centre lies on the axis, and the normal follows z) or its mean r² (lines), a spline its
/// middle by area. Between the parameters a and b.
double mean_place(const MeridianPiece& piece, double a, double b) {
  const double whole = piece.area(a, b);
  const auto mean = [&](auto&& value) {
    return 2.0 * pi *
           boost::math::quadrature::gauss<double, 15>::integrate(
               [&](double t) { return value(t) * piece.at(t).x() * piece.slope(t).norm(); }, a, b) /
           whole;
  };
  switch (piece.curve()) {
    case ProfileCurve::straight: {
      const double from = piece.from().x(), change = piece.to().x() - from;
      if (std::abs(change) < 1e-9 * piece.length()) return 0.5 * (a + b);
      return (std::sqrt(mean([&](double t) { return std::pow(piece.at(t).x(), 2); })) - from) /
             change;
    }
    case ProfileCurve::arc: {
      const double z = mean([&](double t) { return piece.at(t).y(); });
      const double before = piece.at(a).y() - z, after = piece.at(b).y() - z;
      if (before * after >= 0.0) break;  // around its top or bottom
      std::uintmax_t rounds = 100;
      const auto [low, high] = boost::math::tools::toms748_solve(
          [&](double t) { return piece.at(t).y() - z; }, a, b, before, after,
          boost::math::tools::eps_tolerance<double>(52), rounds);
      return 0.5 * (low + high);
    }
    case ProfileCurve::spline: break;
  }
  return mean([](double t) { return t; });
}

/// Bands of equal length.
void add_piece(const MeridianPiece& piece, bool backward, double spacing,
               std::vector<SurfacePoint>& points) {
  const int bands = pieces(piece.length() * (1.0 - 1e-12), spacing);
  for (int i = 0; i < bands; ++i) {
    const int band = backward ? bands - 1 - i : i;
    const double a = double(band) / bands, b = double(band + 1) / bands;
    const double t = mean_place(piece, a, b);
    const Vector2 at = piece.at(t), normal = piece.normal(t);
    add_ring({at.x(), at.y(), piece.area(a, b), normal.x(), normal.y()}, spacing, points);
  }
}

void check(const Geometry& geometry) {
  const auto found = geometry.violations();
  if (!found.empty()) throw InvalidInput(found);
}

void check(const Geometry& geometry, double spacing) {
  check(geometry);
  const double radius = geometry.tip_radius;
  if (!(spacing >= 1e-3 * radius && spacing <= radius)) {
    throw InvalidInput({"surface_points.spacing", to_text(spacing) + " m",
                        "the distance of surface points must lie between R/1000 and R",
                        "choose about a third of the lattice spacing"});
  }
}

}  // namespace

std::vector<SurfacePoint> surface_points(const Geometry& geometry, ProfileSurface surface,
                                         double spacing) {
  check(geometry, spacing);
  if (geometry.solid) return geometry.solid->points(surface, spacing);
  std::vector<SurfacePoint> points;
  const std::vector<MeridianPiece> all = Meridian(geometry.corners()).pieces();
  // Counter-clockwise, `contact` ends at the pole.
  const bool backward = surface == ProfileSurface::contact;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const MeridianPiece& piece = all[backward ? all.size() - 1 - i : i];
    if (piece.surface() == surface) add_piece(piece, backward, spacing, points);
  }
  return points;
}

double surface_area(const Geometry& geometry, ProfileSurface surface) {
  check(geometry);
  return shape_of(geometry)->area(surface);
}

}  // namespace fingertip::meshes::inline cells
