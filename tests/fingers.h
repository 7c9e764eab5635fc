/// Fingers as profiles, which several rooms press.
#pragma once

#include <vector>

#include "meshes/geometry.h"

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

}  // namespace fingers
