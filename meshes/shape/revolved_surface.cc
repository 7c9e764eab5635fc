#include "meshes/shape/revolved_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::meshes::inline shape {
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

}  // namespace

MeridianPolygon chords_of(const Meridian& meridian,
                          const std::function<int(const MeridianPiece&)>& chords) {
  MeridianPolygon polygon;
  for (std::size_t p = 0; p < meridian.pieces().size(); ++p) {
    const MeridianPiece& piece = meridian.pieces()[p];
    const int parts = piece.surface() == ProfileSurface::axis ? 1 : chords(piece);
    for (int i = 0; i < parts; ++i) {
      Vector2 corner = piece.at(double(i) / parts);
      if (corner.x() < rounded_off * meridian.largest_radius()) corner.x() = 0.0;
      polygon.corners.push_back(corner);
      polygon.pieces.push_back(int(p));
    }
  }
  return polygon;
}

SweptPolygon swept(const MeridianPolygon& polygon, int sectors, int turns) {
  SweptPolygon result;
  for (const Vector2& corner : polygon.corners) {
    std::vector<int>& ring = result.rings.emplace_back();
    for (int t = 0; t <= turns; ++t) {
      if (t > 0 && (corner.x() == 0.0 || t == sectors)) {
        ring.push_back(ring.front());
        continue;
      }
      const double angle = 2.0 * std::numbers::pi * t / sectors;
      const double c = 4 * t == sectors ? 0.0 : std::cos(angle);
      const double s = 2 * t == sectors ? 0.0 : std::sin(angle);
      ring.push_back(int(result.mesh.vertices.size()));
      result.mesh.vertices.emplace_back(corner.x() * c, corner.x() * s, corner.y());
    }
  }
  for (std::size_t i = 0; i < result.rings.size(); ++i) {
    const auto add = [&](int a, int b, int c) {
      if (a == b || b == c || c == a) return;
      result.mesh.triangles.push_back({a, b, c});
      result.pieces.push_back(polygon.pieces[i]);
    };
    const std::vector<int>&from = result.rings[i],
          &to = result.rings[(i + 1) % result.rings.size()];
    for (std::size_t t = 0; t + 1 < from.size(); ++t) {
      add(from[t], from[t + 1], to[t + 1]);
      add(from[t], to[t + 1], to[t]);
    }
  }
  return result;
}

TriangleMesh revolved_surface(const Meridian& meridian) {
  const double radius = meridian.largest_radius();
  const auto chords = [radius](const MeridianPiece& piece) {
    const bool touches = piece.surface() == ProfileSurface::contact;
    return divisions(piece, (touches ? touching_chord : hidden_chord) * radius,
                     longest_chord * radius);
  };
  return swept(chords_of(meridian, chords), sectors_around, sectors_around).mesh;
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

}  // namespace fingertip::meshes::inline shape
