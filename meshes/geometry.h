/// The deformable finger of Reznik & Laugier (1996), Fig. 1: a rigid rod (cylinder and
/// hemisphere of radius r) inside a rubber tip (hemispherical shell and sleeve, outer radius R).
///
/// Frame: the common centre of both hemispheres is the origin, the axis is z, the pole of the tip
/// is (0, 0, R), the sleeve ends at z = -L and the rod's endpoint, held by the robot, is
/// (0, 0, -l).
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <vector>

#include "meshes/errors.h"

namespace fingertip::meshes {

using Vector3 = Eigen::Vector3d;

/// The three parts of the tip's boundary.
enum class Surface {
  outer,  ///< |w| = R (z >= 0) and rho = R (z < 0): free or in contact
  bond,   ///< |w| = r (z >= 0) and rho = r (z < 0): bonded to the rigid rod
  end,    ///< the annulus at z = -L: free
};

std::string_view name(Surface surface);

/// Lengths in metres.
struct Geometry {
  double tip_radius = 0.010;     ///< R, outer radius of the rubber [m]
  double rod_radius = 0.005;     ///< r, radius of the rod [m], 0 < r < R
  double sleeve_length = 0.015;  ///< L, length of the sleeve below the hemisphere [m], L >= 0
  double rod_length = 0.030;     ///< l, distance from the centre to the rod's endpoint [m], l >= L

  /// Every rule this geometry breaks; empty when it is valid.
  std::vector<Violation> violations() const;

  /// Distance from the axis of the tip's core: |w| above the equator, sqrt(x²+y²) below.
  static double radial_distance(const Vector3& w);

  /// Signed distance to the tip's boundary [m]: negative inside the rubber, exact everywhere.
  double signed_distance(const Vector3& w) const;

  /// Membership in the paper's set P (section II.C): r < |w| <= R for z >= 0,
  /// r < sqrt(x²+y²) <= R for -L <= z < 0. Points within `tolerance` [m] of a surface count as
  /// lying on it, so that grid points meant to be on the boundary are not lost to round-off.
  bool contains(const Vector3& w, double tolerance = 0.0) const;

  /// Volume of the rubber, (R³ - r³) 2π/3 + (R² - r²) π L [m³] (paper, section II.C).
  double tip_volume() const;

  /// Thickness of the rubber layer, R - r [m].
  double thickness() const { return tip_radius - rod_radius; }

  /// The rod's endpoint (0, 0, -l) [m], where the robot holds it and force and torque are felt.
  Vector3 rod_endpoint() const { return {0.0, 0.0, -rod_length}; }
};

}  // namespace fingertip::meshes
