#include "meshes/press/markers.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

namespace fingertip::meshes::inline press {

namespace {

constexpr double rounded = 1e-3;  ///< of places that people give, over the largest radius
constexpr double on_boundary = 1e-9, touching = 1e-13;  ///< over the largest radius
constexpr double least_slope = 0.5;  ///< cosine of what the surface under a grid leans by
constexpr int most_looks = 1000;     ///< along a line of sight

/// As people read it, and near enough to be copied.
std::string in_mm(double length) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", 1e3 * length);
  return text.data();
}

std::string marker_text(const Vector3& place) {
  return "(" + in_mm(place.x()) + ", " + in_mm(place.y()) + ", " + in_mm(place.z()) + ") mm";
}

/// The nearest place on the rubber's boundary.
NearestPoint nearest_boundary(const Shape& shape, const Vector3& place, bool& in_rod) {
  NearestPoint nearest = shape.nearest(ProfileSurface::contact, place);
  const NearestPoint bond = shape.nearest(ProfileSurface::bond, place),
                     free = shape.nearest(ProfileSurface::free, place);
  if (free.distance < nearest.distance) nearest = free;
  in_rod = bond.distance < nearest.distance;
  return in_rod ? bond : nearest;
}

/// Where a line along the axis meets the boundary first, from above: steps of the distance to it
/// never pass it.
std::optional<Vector3> seen_from_above(const Shape& shape, double x, double y) {
  Vector3 at(x, y, shape.pole() + shape.largest_radius());
  for (int look = 0; look < most_looks && at.z() >= shape.lowest(); ++look) {
    const double away = shape.signed_distance(at);
    if (away <= touching * shape.largest_radius()) return at;
    at.z() -= away;
  }
  return {};
}

}  // namespace

std::vector<MarkerRow> marker_rows(const std::vector<Vector3>& places,
                                   const std::vector<Vector3>& displacements) {
  std::vector<MarkerRow> rows;
  for (std::size_t i = 0; i < places.size(); ++i)
    rows.push_back({.marker = int(i + 1), .place = places[i], .displacement = displacements[i]});
  return rows;
}

void add_sample(const std::vector<MarkerRow>& markers, int sample, double indentation,
                std::vector<MarkerRow>& rows) {
  for (MarkerRow row : markers) {
    row.sample = sample;
    row.indentation = indentation;
    rows.push_back(row);
  }
}

Vector3 marker_at(const Shape& shape, const Vector3& place) {
  const double outside = shape.signed_distance(place);
  if (outside <= 0.0) return place;
  bool in_rod = false;
  const NearestPoint nearest = nearest_boundary(shape, place, in_rod);
  if (outside > rounded * shape.largest_radius())
    throw InvalidInput({"sensor.markers", marker_text(place),
                        in_rod ? "lies in the rod, " + in_mm(outside) + " mm from the rubber"
                               : "lies " + in_mm(outside) + " mm outside the finger",
                        "the nearest place in the rubber is " + marker_text(nearest.position) +
                            "; move it there, or leave it out"});
  return nearest.position;
}

std::vector<Vector3> marker_grid(const Shape& shape, double pitch, double depth) {
  const double radius = shape.largest_radius(), count = std::floor(radius / pitch);
  const auto refuse = [&](const std::string& rule, const std::string& remedy) {
    throw InvalidInput({"sensor.marker_pitch", in_mm(pitch) + " mm", rule, remedy});
  };
  const auto refuse_many = [&] {
    refuse("a grid has at most " + std::to_string(most_markers) + " markers",
           "take a larger pitch");
  };
  // A square in a circle has two thirds of its area.
  if (4.0 * count * count > 2.0 * double(most_markers)) refuse_many();
  std::vector<Vector3> markers;
  for (int j = -int(count); j <= int(count); ++j) {
    for (int i = -int(count); i <= int(count); ++i) {
      const auto seen = seen_from_above(shape, i * pitch, j * pitch);
      if (!seen) continue;
      const NearestPoint at = shape.nearest(ProfileSurface::contact, *seen);
      if (at.distance > on_boundary * radius || at.normal.z() < least_slope) continue;
      const Vector3 place = at.position - depth * at.normal;
      if (depth > 0.0 && shape.signed_distance(place) > on_boundary * radius)
        throw InvalidInput({"sensor.marker_depth", in_mm(depth) + " mm",
                            "the rubber is not as thick under " + marker_text(at.position),
                            "take a smaller depth"});
      markers.push_back(place);
    }
  }
  if (markers.empty())
    refuse("the surface that may touch has no place on this grid", "take a smaller pitch");
  if (markers.size() > most_markers) refuse_many();
  return markers;
}

std::vector<Violation> marker_violations(const std::vector<Vector3>& places,
                                         const Geometry& geometry) {
  std::vector<Violation> found;
  if (places.empty()) return found;
  const auto shape = shape_of(geometry);
  for (const Vector3& place : places) {
    try {
      if (!place.allFinite())
        throw InvalidInput({"sensor.markers", marker_text(place), "a place is three finite numbers",
                            "give its x, y and z"});
      marker_at(*shape, place);
    } catch (const InvalidInput& error) {
      append(found, error.violations());
    }
  }
  return found;
}

}  // namespace fingertip::meshes::inline press
