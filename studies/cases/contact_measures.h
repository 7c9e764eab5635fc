/// The contact of a press beside that of what it is measured against.
#pragma once

#include <filesystem>

#include "lattice/press/press_setup.h"
#include "meshes/press/contact_map.h"

namespace fingertip::studies::inline cases {

/// Relative, of the two run folders; NaN where a file or a quantity is missing.
struct ContactErrors {
  meshes::ContactDifference field;  ///< at the deepest sample of the press that both have
  /// Largest difference of a force aside and of a torque about the normal, over the reference's
  /// largest.
  double lateral = meshes::unknown, torque = meshes::unknown;
  /// Under Coulomb friction: of the radius of a disc as large as the part that sticks, over that of
  /// the reference's contact; of all samples the largest magnitude.
  double stick_radius = meshes::unknown;
  /// Root mean square over taxels and stresses of the difference of the readings, over the
  /// reference's largest; of all samples the largest.
  double taxels = meshes::unknown;
  /// Of the force that the press's own skin feels at that sample from its normal force.
  double skin_force = meshes::unknown;
  /// Of the reference's pressure there from Hertz's for its force, over his p0, in L2 over the
  /// contact; a round finger without friction on a plane or a ball at small strain.
  double hertz = meshes::unknown;
};

ContactErrors contact_errors(const lattice::PressSetup& setup, const std::filesystem::path& press,
                             const std::filesystem::path& reference);

}  // namespace fingertip::studies::inline cases
