/// Measured displacements of material points beside computed ones. The frame of the one that
/// measures may stand elsewhere at every load: its rigid motion, six numbers, is taken out.
#pragma once

#include <vector>

#include "meshes/shape/geometry.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::calibration::inline press_fit {

/// Of material points under one load, places and displacements [m]. What was not measured is NaN.
struct MeasuredDisplacements {
  double indentation = 0.0;  ///< [m]
  std::vector<meshes::Vector3> displacement;
};

/// A measured field beside a computed one of the same points.
struct DisplacementDistance {
  double rms = meshes::unknown, largest = meshes::unknown;  ///< of the points' distances [m]
  std::size_t farthest = 0;                                 ///< the point of the largest
  double size = meshes::unknown;  ///< rms of what was measured, without rigid motion [m]
  /// How many times the computed field, without rigid motion, is the measured one, by least
  /// squares: 1 where they agree but for what is orthogonal to it.
  double ratio = meshes::unknown;
  double turn = meshes::unknown;  ///< angle of the frame's motion [rad]
  /// Measured displacements with the frame's motion taken out [m]; NaN as measured.
  std::vector<meshes::Vector3> displacement;
};

/// The frame's motion is that rotation and shift of the measured places under load that brings
/// them nearest to the computed ones (least squares; Umeyama, IEEE Trans. Pattern Anal. Mach.
/// Intell. 13, 376, 1991). Lists are as long as `places`; fewer than four measured points, or
/// points on a line, leave all unknown.
DisplacementDistance distance_of(const std::vector<meshes::Vector3>& places,
                                 const std::vector<meshes::Vector3>& measured,
                                 const std::vector<meshes::Vector3>& computed);

/// How regularly points stand that were to stand on a cubic grid.
struct GridScatter {
  double rms = meshes::unknown, largest = meshes::unknown;  ///< from the grid's points [m]
  double pitch = meshes::unknown;                           ///< of the grid that fits best [m]
};

/// `grid`: the point's place on the grid, in pitches, right-handed as `places` [m] are. The grid's
/// rotation, shift and pitch are fitted.
GridScatter grid_scatter(const std::vector<meshes::Vector3>& grid,
                         const std::vector<meshes::Vector3>& places);

}  // namespace fingertip::calibration::inline press_fit
