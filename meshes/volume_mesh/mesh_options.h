/// What to mesh of the tip, and how finely.
#pragma once

#include <optional>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline volume_mesh {

/// How much of the tip is meshed. A press along the axis has two symmetry planes, so its quarter
/// x >= 0, y >= 0 tells everything; a tilt about y or a motion along x leaves one, y >= 0. Without
/// them the meridian y = 0, x >= 0 does, for an axisymmetric model.
enum class Sector { quarter, half, full, meridian };

/// Numbers of the physical groups in the mesh file, for readers that do not keep the names.
enum class PhysicalTag { tip = 1, outer = 2, bond = 3, end = 4, symmetry_x = 5, symmetry_y = 6 };

/// Element counts of the blocks. The quarter is five blocks, each spanning the rubber layer: a cap
/// around the pole, two blocks from the cap to the equator, two blocks of the sleeve; the full tip
/// is four quarters. The meridian is two, from the pole to the equator (cap and ring elements) and
/// the sleeve, with x and y of the file for the distance from the axis and the place along it; its
/// axis is `symmetry_x`. Of another shape than the dome elements are as large as `radial_elements`
/// says, and smallest where it touches first.
struct TipMeshOptions {
  Sector sector = Sector::quarter;
  double cap_angle = 0.72;   ///< polar angle of the cap's edge on the meridians x = 0, y = 0 [rad]
  int cap_elements = 12;     ///< along each side of the cap (and along each 45° of the equator)
  double cap_grading = 2.0;  ///< largest over smallest element on the cap's sides; fine at the pole
  int ring_elements = 7;     ///< from the cap to the equator
  int sleeve_elements = 6;   ///< from the equator to the end of the sleeve
  int radial_elements = 6;   ///< through the rubber
  double radial_grading = 3.0;  ///< thickest over thinnest of many layers; fine at both surfaces
  std::optional<Vector3> touch = std::nullopt;  ///< touches first [m]; by default the pole

  /// The same mesh with every count multiplied by `factor` (rounded, at least 2).
  TipMeshOptions refined(double factor) const;

  /// Every broken rule: counts 2 ... 500, gradings 1 ... 20, cap angle 0.2 ... 1.2 rad.
  std::vector<Violation> violations() const;
};

}  // namespace fingertip::meshes::inline volume_mesh
