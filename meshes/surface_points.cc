#include "meshes/surface_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/files.h"

namespace fingertip::meshes {

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

/// Bands of equal width from the pole to the equator. Area is uniform in z (Archimedes), so points
/// at the mean height of their band integrate z, and with it the normal, exactly.
void add_hemisphere(double radius, double outward, double spacing,
                    std::vector<SurfacePoint>& points) {
  const int bands = pieces(0.5 * pi * radius, spacing);
  const auto height = [&](int i) { return radius * std::cos(0.5 * pi * i / bands); };
  for (int i = 0; i < bands; ++i) {
    const double top = height(i), bottom = i + 1 < bands ? height(i + 1) : 0.0;
    const double z = 0.5 * (top + bottom);
    const double across = std::sqrt((radius - z) * (radius + z));
    add_ring({across, z, 2.0 * pi * radius * (top - bottom), outward * across / radius,
              outward * z / radius},
             spacing, points);
  }
}

void add_cylinder(double radius, double length, double outward, double spacing,
                  std::vector<SurfacePoint>& points) {
  const int bands = pieces(length, spacing);
  for (int i = 0; i < bands; ++i) {
    const double width = length / bands;
    add_ring({radius, -(i + 0.5) * width, 2.0 * pi * radius * width, outward, 0.0}, spacing,
             points);
  }
}

/// Points at the root mean square radius of their band integrate x² + y² exactly.
void add_annulus(const Geometry& geometry, double spacing, std::vector<SurfacePoint>& points) {
  const int bands = pieces(geometry.thickness(), spacing);
  const double width = geometry.thickness() / bands;
  for (int i = 0; i < bands; ++i) {
    const double inner = geometry.rod_radius + i * width, outer = inner + width;
    add_ring({std::sqrt(0.5 * (inner * inner + outer * outer)), -geometry.sleeve_length,
              pi * (outer - inner) * (outer + inner), 0.0, -1.0},
             spacing, points);
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

std::vector<SurfacePoint> surface_points(const Geometry& geometry, Surface surface,
                                         double spacing) {
  check(geometry, spacing);
  std::vector<SurfacePoint> points;
  if (surface == Surface::end) {
    add_annulus(geometry, spacing, points);
  } else {
    const bool outer = surface == Surface::outer;
    const double radius = outer ? geometry.tip_radius : geometry.rod_radius;
    const double outward = outer ? 1.0 : -1.0;
    add_hemisphere(radius, outward, spacing, points);
    add_cylinder(radius, geometry.sleeve_length, outward, spacing, points);
  }
  return points;
}

double surface_area(const Geometry& geometry, Surface surface) {
  check(geometry);
  const double outer = geometry.tip_radius, rod = geometry.rod_radius;
  switch (surface) {
    case Surface::outer: return 2.0 * pi * outer * (outer + geometry.sleeve_length);
    case Surface::bond: return 2.0 * pi * rod * (rod + geometry.sleeve_length);
    case Surface::end: return pi * (outer - rod) * (outer + rod);
  }
  return 0.0;
}

}  // namespace fingertip::meshes
