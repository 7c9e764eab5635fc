/// Cells of a grid along the axis of a body of revolution.
#pragma once

#include <array>

#include "meshes/cells/cubic_grid.h"
#include "meshes/shape/meridian.h"

namespace fingertip::meshes::inline cells {

/// Whether every direction of the grid is along x, y or z of the tip, either way, so that
/// `revolved_moments` holds.
bool along_axes(const CubicGrid& grid);

/// CutCell::moments of the cell with the lowest corner (i, j, k), good to 1e-9. A slice across the
/// axis is a rectangle less or plus discs, whose integrals are known; along the axis Gauss points
/// are laid between the heights at which a disc reaches an edge or a corner of the rectangle, or
/// the meridian a corner or turning point.
std::array<double, 8> revolved_moments(const Meridian& meridian, const CubicGrid& grid, int i,
                                       int j, int k);

}  // namespace fingertip::meshes::inline cells
