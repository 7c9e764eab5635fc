/// The cells of a cubic grid cut by the tip's true boundary, as integrals over their rubber.
#pragma once

#include <vector>

#include "meshes/cells/cubic_grid.h"
#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline cells {

/// The cells of `grid` whose rubber is more than `smallest_fraction` of the cell, by increasing
/// grid index of their lowest corner. Cells wholly in the rubber have exactly the moments of a
/// cube; those of the others are good to 1e-8 where the spacing is at most a quarter of the rod's
/// radius, and to 1e-5 for any other spacing, whatever the grid's position and rotation; of a solid
/// to round-off. Rubber
/// outside the grid's outermost cells is not seen (`covering_grid` leaves none). Throws
/// InvalidInput for an invalid geometry and unless 0 <= smallest_fraction < 1.
std::vector<CutCell> cut_cells(const Geometry& geometry, const CubicGrid& grid,
                               double smallest_fraction);

}  // namespace fingertip::meshes::inline cells
