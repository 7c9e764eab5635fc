/// Fingers as profiles and as triangles, which several rooms press.
#pragma once

#include <cmath>
#include <memory>
#include <numbers>
#include <vector>

#include "meshes/shape/geometry.h"
#include "meshes/shape/solid.h"

namespace fingers {

using fingertip::meshes::Geometry;
using fingertip::meshes::ProfileCorner;

/// The dome written as a profile, its centre at the height `up` [m].
inline std::vector<ProfileCorner> dome(const Geometry& g = {}, double up = 0.0) {
  using enum fingertip::meshes::ProfileSurface;
  using enum fingertip::meshes::ProfileCurve;
  const double R = g.tip_radius, r = g.rod_radius, end = up - g.sleeve_length;
  return {{0.0, up + R, axis, straight}, {0.0, up + r, bond, arc, 0.0, up},
          {r, up, bond, straight},       {r, end, free, straight},
          {R, end, contact, straight},   {R, up, contact, arc, 0.0, up}};
}

/// Cylinder with a hemisphere of radius R, as high as it is wide, glued at its base at `up` [m].
inline std::vector<ProfileCorner> solid(double R = 0.0125, double up = 0.0) {
  using enum fingertip::meshes::ProfileSurface;
  using enum fingertip::meshes::ProfileCurve;
  return {{R, up, contact, straight},
          {R, up + R, contact, arc, 0.0, up + R},
          {0.0, up + 2 * R, axis, straight},
          {0.0, up, bond, straight}};
}

/// The same with a wall, glued at its rim.
inline std::vector<ProfileCorner> hollow(double R = 0.0125, double wall = 0.0025) {
  using enum fingertip::meshes::ProfileSurface;
  using enum fingertip::meshes::ProfileCurve;
  const double r = R - wall;
  return {{R, 0.0, contact, straight},  {R, R, contact, arc, 0.0, R},
          {0.0, 2 * R, axis, straight}, {0.0, 2 * R - wall, free, arc, 0.0, R},
          {r, R, free, straight},       {r, 0.0, bond, straight}};
}

/// What a closed curve (r, z) from axis to axis sweeps, inscribed; counter-clockwise, seen with r
/// to the right.
inline fingertip::meshes::TriangleMesh revolved(const std::vector<std::array<double, 2>>& curve,
                                                int sectors) {
  fingertip::meshes::TriangleMesh mesh;
  std::vector<std::vector<int>> rings;
  for (const auto& [r, z] : curve) {
    std::vector<int>& ring = rings.emplace_back();
    for (int s = 0; s < (r > 0.0 ? sectors : 1); ++s) {
      const double angle = 2.0 * std::numbers::pi * s / sectors;
      ring.push_back(int(mesh.vertices.size()));
      mesh.vertices.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
  }
  for (std::size_t i = 1; i < rings.size(); ++i)
    for (int s = 0; s < sectors; ++s) {
      const auto at = [&](std::size_t ring, int sector) {
        return rings[ring].size() == 1 ? rings[ring][0]
                                       : rings[ring][std::size_t(sector % sectors)];
      };
      const int a = at(i - 1, s), b = at(i - 1, s + 1), c = at(i, s), d = at(i, s + 1);
      if (a != b) mesh.triangles.push_back({a, b, d});
      if (c != d) mesh.triangles.push_back({a, d, c});
    }
  return mesh;
}

/// The surface of the dome, by default of 20 000 facets, most of them on the outer hemisphere.
inline fingertip::meshes::TriangleMesh dome_surface(int sectors = 96, int layers = 64,
                                                    const Geometry& g = {}) {
  std::vector<std::array<double, 2>> curve;
  const double R = g.tip_radius, r = g.rod_radius, end = -g.sleeve_length;
  const int inner = layers / 3, along = layers / 6;
  const auto arc = [&](double radius, int i, int count) {
    const double angle = 0.5 * std::numbers::pi * i / count;
    curve.push_back({i == count ? 0.0 : radius * std::cos(angle), radius * std::sin(angle)});
  };
  for (int i = inner; i >= 0; --i) arc(r, i, inner);
  for (int i = 1; i <= along; ++i) curve.push_back({r, end * i / along});
  for (int i = 0; i < along; ++i) curve.push_back({R, end * (along - i) / along});
  for (int i = 0; i <= layers; ++i) arc(R, i, layers);
  return revolved(curve, sectors);
}

/// What of it the rod holds: all within a box around the rod, but not the end.
inline fingertip::meshes::Region dome_bond(const Geometry& g = {}) {
  const double r = g.rod_radius;
  return {{{0, true, r},
           {0, false, -r},
           {1, true, r},
           {1, false, -r},
           {2, true, r},
           {2, false, 1e-6 - g.sleeve_length}}};
}

/// The dome as a solid.
inline Geometry solid_dome(int sectors = 96, int layers = 64) {
  const Geometry g;
  return Geometry::of_solid(
      std::make_shared<fingertip::meshes::Solid>(dome_surface(sectors, layers), dome_bond()),
      -g.rod_length);
}

/// A box of twelve triangles.
inline fingertip::meshes::TriangleMesh box(const fingertip::meshes::Vector3& low,
                                           const fingertip::meshes::Vector3& high) {
  fingertip::meshes::TriangleMesh mesh;
  for (int v = 0; v < 8; ++v)
    mesh.vertices.emplace_back(v & 1 ? high.x() : low.x(), v & 2 ? high.y() : low.y(),
                               v & 4 ? high.z() : low.z());
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1},
                                   {4, 5, 7, 6},
                                   {0, 1, 5, 4},
                                   {2, 6, 7, 3},
                                   {0, 4, 6, 2},
                                   {1, 3, 7, 5}}) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  return mesh;
}

}  // namespace fingers
