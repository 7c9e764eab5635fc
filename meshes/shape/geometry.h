/// The deformable finger: the dome of Reznik & Laugier (1996), Fig. 1, a body of revolution, or a
/// solid.
///
/// The dome is a rigid rod (cylinder and hemisphere of radius r) inside a rubber tip (hemispherical
/// shell and sleeve, outer radius R). Frame: the common centre of both hemispheres is the origin,
/// the axis is z, the pole of the tip is (0, 0, R), the sleeve ends at z = -L and the rod's
/// endpoint, held by the robot, is (0, 0, -l). Profiles and solids have their own heights; their
/// axis is z, too, and the pole, the highest point, touches first.
#pragma once

#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/shape/profile_pieces.h"
#include "meshes/shape/shape.h"

namespace fingertip::meshes::inline shape {

class Solid;

/// Lengths in metres. Those of another shape than the dome follow from it: `of_profile`,
/// `of_solid`.
struct Geometry {
  double tip_radius = 0.010;  ///< R, outer radius of the rubber; of another shape its largest [m]
  double rod_radius =
      0.005;  ///< r, radius of the rod, 0 < r < R; of another shape that of the bond [m]
  /// L, length of the sleeve below the hemisphere, L >= 0; minus another shape's lowest height [m]
  double sleeve_length = 0.015;
  /// l, distance from the centre to the rod's endpoint, l >= L; minus another shape's endpoint [m]
  double rod_length = 0.030;
  std::vector<ProfileCorner> profile = {};       ///< of a body of revolution, else empty
  std::shared_ptr<const Solid> solid = nullptr;  ///< of a solid, else null

  /// The body of revolution with this meridian; force and torque are told at the height `endpoint`
  /// of the axis, by default the lowest. Throws InvalidInput (Meridian).
  static Geometry of_profile(std::vector<ProfileCorner> corners,
                             std::optional<double> endpoint = std::nullopt);
  /// The solid's finger, in the same way.
  static Geometry of_solid(std::shared_ptr<const Solid> solid,
                           std::optional<double> endpoint = std::nullopt);
  bool is_dome() const { return profile.empty() && !solid; }
  /// Whether it is its own image in the plane through the axis across x (`axis` 0) or y (1).
  bool mirrored(int axis) const;
  /// The word of geometry.shape: dome, profile or solid.
  std::string_view shape_name() const;

  /// Of its meridian: the profile's, or the dome's. Throws InvalidInput for an invalid dome.
  std::vector<ProfileCorner> corners() const;

  /// Every rule this geometry breaks; empty when it is valid.
  std::vector<Violation> violations() const;

  /// Distance from the axis of the tip's core: |w| above the equator, sqrt(x²+y²) below.
  static double radial_distance(const Vector3& w);

  /// Of the dome: signed distance to the tip's boundary [m], negative inside the rubber, exact
  /// everywhere. Of any shape: shape_of().
  double signed_distance(const Vector3& w) const;

  /// Of the dome. Membership in the paper's set P (section II.C): r < |w| <= R for z >= 0,
  /// r < sqrt(x²+y²) <= R for -L <= z < 0. Points within `tolerance` [m] of a surface count as
  /// lying on it, so that grid points meant to be on the boundary are not lost to round-off.
  bool contains(const Vector3& w, double tolerance = 0.0) const;

  /// Volume of the rubber, of the dome (R³ - r³) 2π/3 + (R² - r²) π L [m³] (paper, section II.C).
  double tip_volume() const;

  /// Height of the pole, which touches first [m].
  double pole() const;
  /// How far the surface that may touch reaches along the axis turned by `tilt` [rad], from the
  /// origin [m]: R of a dome, the pole of another shape at tilt 0.
  double reach(double tilt) const;
  /// Lowest height of the rubber [m].
  double lowest() const { return -sleeve_length; }
  /// Rubber between the pole and what is held: R - r, of another shape the height of the pole over
  /// the highest place of the bond [m].
  double thickness() const;
  /// Coarsest grid [m]: two cells through the dome's rubber, four through another shape's thinnest
  /// wall.
  double coarsest_spacing() const;

  /// The rod's endpoint (0, 0, -l) [m], where the robot holds it and force and torque are felt.
  Vector3 rod_endpoint() const { return {0.0, 0.0, -rod_length}; }
};

/// Its solid, else its meridian. Throws InvalidInput for an invalid geometry.
std::shared_ptr<const Shape> shape_of(const Geometry& geometry);

/// What the hand holds, for pictures: curves (r, z) from below upward that sweep the dome's rod, or
/// a block below a profile and its bond; `points` on each curved piece.
std::vector<std::vector<Vector2>> held_outlines(const Geometry& geometry, int points);

/// What to say of a grid coarser than coarsest_spacing().
Violation too_coarse(const Geometry& geometry, double spacing);

}  // namespace fingertip::meshes::inline shape
