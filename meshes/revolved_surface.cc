#include "meshes/revolved_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::meshes {
namespace {

constexpr int sectors_around = 104;
/// Heights of chords and the longest edge along the meridian, over the largest radius; a radius
/// that is round-off.
constexpr double touching_chord = 1e-4, hidden_chord = 5e-4, longest_chord = 0.15,
                 rounded_off = 1e-12;
constexpr int chords_at_most = 1000;

/// Into how many equal steps of its parameter the piece is divided.
int divisions(const MeridianPiece& piece, double chord, double edge) {
  for (int parts = 1; parts < chords_at_most; ++parts) {
    double height = 0.0, length = 0.0;
    for (int i = 0; i < parts; ++i) {
      const Vector2 from = piece.at(double(i) / parts), to = piece.at((i + 1.0) / parts);
      length = std::max(length, (to - from).norm());
      height = std::max(height, (piece.at((i + 0.5) / parts) - 0.5 * (from + to)).norm());
    }
    if (height <= chord && length <= edge) return parts;
  }
  return chords_at_most;
}

/// The band that a chord sweeps; rubber lies to the chord's left.
void add_band(const Vector2& from, const Vector2& to, TriangleMesh& mesh) {
  const auto place = [](const Vector2& point, int sector) {
    const double angle = 2.0 * std::numbers::pi * (sector % sectors_around) / sectors_around;
    return Vector3(point.x() * std::cos(angle), point.x() * std::sin(angle), point.y());
  };
  const auto add = [&mesh](const Vector3& a, const Vector3& b, const Vector3& c) {
    const int first = int(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), {a, b, c});
    mesh.triangles.push_back({first, first + 1, first + 2});
  };
  for (int s = 0; s < sectors_around; ++s) {
    const Vector3 c = place(to, s), d = place(to, s + 1);
    if (from.x() > 0.0) add(place(from, s), place(from, s + 1), d);
    if (to.x() > 0.0) add(place(from, s), d, c);
  }
}

}  // namespace

TriangleMesh revolved_surface(const Meridian& meridian) {
  TriangleMesh mesh;
  const double radius = meridian.largest_radius();
  const auto point = [&](const MeridianPiece& piece, double t) {
    Vector2 at = piece.at(t);
    if (at.x() < rounded_off * radius) at.x() = 0.0;
    return at;
  };
  for (const MeridianPiece& piece : meridian.pieces()) {
    if (piece.surface() == ProfileSurface::axis) continue;
    const bool touches = piece.surface() == ProfileSurface::contact;
    const int parts = divisions(piece, (touches ? touching_chord : hidden_chord) * radius,
                                longest_chord * radius);
    for (int i = 0; i < parts; ++i)
      add_band(point(piece, double(i) / parts), point(piece, (i + 1.0) / parts), mesh);
  }
  return mesh;
}

SurfaceDeviation deviation(const TriangleMesh& mesh, const Shape& truth) {
  SurfaceDeviation found;
  double volume = 0.0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    volume += mesh.centroid(t).dot(mesh.area_vector(t)) / 3.0;
    const auto look_at = [&](const Vector3& w) {
      found.largest = std::max(found.largest, std::abs(truth.signed_distance(w)));
    };
    look_at(mesh.centroid(t));
    for (std::size_t c = 0; c < 3; ++c)
      look_at(0.5 * (mesh.corner(t, c) + mesh.corner(t, (c + 1) % 3)));
  }
  found.volume = volume / truth.volume() - 1.0;
  return found;
}

}  // namespace fingertip::meshes
