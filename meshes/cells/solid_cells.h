/// Cells of any grid cut by a triangulated solid.
#pragma once

#include <vector>

#include "meshes/cells/cubic_grid.h"
#include "meshes/shape/solid.h"

namespace fingertip::meshes::inline cells {

/// cut_cells() of a solid, exact but for round-off, on aligned and turned grids alike.
///
/// Along the grid's third direction a facet that faces up adds what lies below it, one that faces
/// down takes it away (divergence theorem). So a facet is cut by the cells' walls; a piece over
/// the area S adds the integral over S of xi^i eta^j zeta^(k+1)/(k+1) to its own cell, where zeta
/// is its height there, and that of xi^i eta^j/(k+1) to every cell below. Polynomials of degree
/// four over triangles: six points are exact. Effort: facets' pieces + cells; memory: the cells,
/// and one layer of the grid.
std::vector<CutCell> solid_cells(const Solid& solid, const CubicGrid& grid,
                                 double smallest_fraction);

}  // namespace fingertip::meshes::inline cells
