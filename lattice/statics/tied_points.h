/// Points of the tip's true surfaces, tied to the particles around them.
#pragma once

#include <vector>

#include "lattice/statics/grid_cells.h"
#include "lattice/statics/lattice_body.h"
#include "meshes/surface_points.h"

namespace fingertip::lattice {

/// The surface point tied to the eight corners of its cell by trilinear weights, its stiffness
/// `stiffness` [Pa/m] times its area. A point whose cell was left out is tied to the nearest of the
/// 26 cells around that: the weights then extrapolate, and none exceeds 8 in magnitude.
/// Throws InvalidInput when none of them exists either.
TiedPoint tie(const GridCells& cells, const meshes::SurfacePoint& point, double stiffness);

/// `particle` itself as a tied point.
TiedPoint tie_to_particle(std::uint32_t particle, const meshes::Vector3& rest, double area,
                          double stiffness);

}  // namespace fingertip::lattice
