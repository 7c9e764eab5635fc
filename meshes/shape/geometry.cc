#include "meshes/shape/geometry.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <utility>

#include "meshes/base/files.h"
#include "meshes/shape/meridian.h"
#include "meshes/shape/solid.h"

namespace fingertip::meshes::inline shape {

namespace {

/// The dome of the paper as a profile.
std::vector<ProfileCorner> dome_corners(const Geometry& g) {
  using enum ProfileSurface;
  using enum ProfileCurve;
  const double R = g.tip_radius, r = g.rod_radius, end = -g.sleeve_length;
  if (end < 0.0)
    return {{r, end, free, straight}, {R, end, contact, straight}, {R, 0.0, contact, arc},
            {0.0, R, axis, straight}, {0.0, r, bond, arc},         {r, 0.0, bond, straight}};
  return {{r, 0.0, free, straight},
          {R, 0.0, contact, arc},
          {0.0, R, axis, straight},
          {0.0, r, bond, arc}};
}

/// The lengths of another shape than the dome.
void take_lengths(const Shape& shape, std::optional<double> endpoint, Geometry& geometry) {
  geometry.tip_radius = shape.largest_radius();
  geometry.rod_radius = shape.bond_radius();
  geometry.sleeve_length = -shape.lowest();
  geometry.rod_length = -endpoint.value_or(shape.lowest());
}

}  // namespace

Geometry Geometry::of_profile(std::vector<ProfileCorner> corners, std::optional<double> endpoint) {
  Geometry geometry;
  geometry.profile = std::move(corners);
  take_lengths(Meridian(geometry.corners()), endpoint, geometry);
  return geometry;
}

Geometry Geometry::of_solid(std::shared_ptr<const Solid> solid, std::optional<double> endpoint) {
  Geometry geometry;
  geometry.solid = std::move(solid);
  take_lengths(*geometry.solid, endpoint, geometry);
  return geometry;
}

bool Geometry::mirrored(int axis) const {
  return !solid || solid->mirrored(axis);
}

std::string_view Geometry::shape_name() const {
  if (solid) return "solid";
  return profile.empty() ? "dome" : "profile";
}

std::vector<ProfileCorner> Geometry::corners() const {
  if (!profile.empty()) return profile;
  const auto found = violations();
  if (!found.empty()) throw InvalidInput(found);
  return dome_corners(*this);
}

std::shared_ptr<const Shape> shape_of(const Geometry& geometry) {
  if (geometry.solid) return geometry.solid;
  return std::make_shared<Meridian>(geometry.corners());
}

double Geometry::pole() const {
  if (is_dome()) return tip_radius;
  if (solid) return solid->pole();
  double top = lowest();
  for (const ProfileCorner& corner : profile)
    if (corner.r == 0.0) top = std::max(top, corner.z);
  return top;
}

double Geometry::reach(double tilt) const {
  return is_dome() ? tip_radius : shape_of(*this)->reach(tilt);
}

double Geometry::thickness() const {
  if (is_dome()) return tip_radius - rod_radius;
  if (solid) return solid->pole() - solid->bond_top();
  return pole() - Meridian(corners()).bond_top();
}

double Geometry::coarsest_spacing() const {
  if (is_dome()) return 0.5 * thickness();
  // A wall is known to round-off, or as well as facets stand for the surface.
  constexpr double round_off = 1e-9, facets = 0.02;
  return 0.25 * (1.0 + (solid ? facets : round_off)) * shape_of(*this)->wall();
}

std::vector<Violation> Geometry::violations() const {
  std::vector<Violation> found;
  if (!is_dome()) {
    try {
      shape_of(*this);
    } catch (const InvalidInput& error) {
      found = error.violations();
    }
    return found;
  }
  const auto require = [&](bool holds, const char* key, double value, const char* rule,
                           const char* remedy) {
    if (!holds) found.push_back({key, to_text(value) + " m", rule, remedy});
  };
  const auto finite = [](double value) { return std::isfinite(value); };
  require(finite(tip_radius) && tip_radius > 0.0, "geometry.tip_radius", tip_radius,
          "R must be finite and positive", "give the outer radius of the rubber");
  require(finite(rod_radius) && rod_radius > 0.0, "geometry.rod_radius", rod_radius,
          "r must be finite and positive", "give the radius of the rigid rod");
  require(!(rod_radius >= tip_radius), "geometry.rod_radius", rod_radius,
          "r must be smaller than tip_radius R, or there is no rubber",
          "reduce rod_radius or enlarge tip_radius");
  require(finite(sleeve_length) && sleeve_length >= 0.0, "geometry.sleeve_length", sleeve_length,
          "L must be finite and not negative", "give the length of the rubber sleeve, or 0");
  require(finite(rod_length) && rod_length > 0.0, "geometry.rod_length", rod_length,
          "l must be finite and positive", "give the length of the rod");
  require(!(rod_length < sleeve_length), "geometry.rod_length", rod_length,
          "l must be at least sleeve_length L, for the sleeve sits on the rod",
          "lengthen the rod or shorten the sleeve");
  return found;
}

std::vector<std::vector<Vector2>> held_outlines(const Geometry& geometry, int points) {
  const double r = geometry.rod_radius;
  if (geometry.is_dome()) {
    std::vector<Vector2> rod{{0.0, -geometry.rod_length}, {r, -geometry.rod_length}};
    for (int i = 0; i < points; ++i) {
      const double latitude = 0.5 * std::numbers::pi * i / points;
      rod.emplace_back(r * std::cos(latitude), r * std::sin(latitude));
    }
    rod.emplace_back(0.0, r);
    return {rod};
  }
  const double low = geometry.lowest();
  std::vector<std::vector<Vector2>> outlines{
      {{0.0, low - 2.0 * r}, {r, low - 2.0 * r}, {r, low}, {0.0, low}}};
  if (geometry.solid) return outlines;  // its bond is no curve
  const Meridian meridian(geometry.corners());
  for (const MeridianPiece& piece : meridian.pieces()) {
    if (piece.surface() != ProfileSurface::bond) continue;
    const int count = piece.curve() == ProfileCurve::straight ? 1 : points;
    std::vector<Vector2>& outline = outlines.emplace_back();
    for (int i = count; i >= 0; --i) outline.push_back(piece.at(double(i) / count));
  }
  return outlines;
}

Violation too_coarse(const Geometry& geometry, double spacing) {
  const bool dome = geometry.is_dome();
  const double coarsest = geometry.coarsest_spacing();
  char limit[32], divisor[32];
  std::snprintf(limit, sizeof limit, "%.4g m", coarsest);
  std::snprintf(divisor, sizeof divisor, "%.6g",
                std::ceil((dome ? 1.5 : 1.0) * geometry.tip_radius / coarsest));
  return {
      "lattice.spacing", to_text(spacing) + " m",
      std::string("the spacing must be positive and at most ") + limit +
          (dome ? ", (R - r)/2: two cells through the rubber" : ", a quarter of the thinnest wall"),
      std::string("choose a finer lattice, for instance tip_radius/") + divisor};
}

double Geometry::radial_distance(const Vector3& w) {
  return w.z() >= 0.0 ? w.norm() : std::hypot(w.x(), w.y());
}

double Geometry::signed_distance(const Vector3& w) const {
  const double radial = radial_distance(w);
  // Beyond either curved surface when positive; its foot point lies at the same height, so this
  // is the distance wherever w is not below the sleeve's end.
  const double layer = std::max(radial - tip_radius, rod_radius - radial);
  const double below = -sleeve_length - w.z();
  if (below <= 0.0) return std::max(layer, below);
  return std::hypot(std::max(layer, 0.0), below);
}

bool Geometry::contains(const Vector3& w, double tolerance) const {
  const double radial = radial_distance(w);
  return radial > rod_radius + tolerance && radial <= tip_radius + tolerance &&
         w.z() >= -sleeve_length - tolerance;
}

double Geometry::tip_volume() const {
  if (!is_dome()) return shape_of(*this)->volume();
  const auto cube = [](double x) { return x * x * x; };
  const auto square = [](double x) { return x * x; };
  return std::numbers::pi * (2.0 / 3.0 * (cube(tip_radius) - cube(rod_radius)) +
                             (square(tip_radius) - square(rod_radius)) * sleeve_length);
}

}  // namespace fingertip::meshes::inline shape
