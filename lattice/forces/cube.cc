#include "lattice/forces/cube.h"

#include "lattice/forces/stiffness.h"
#include "lattice/model/model.h"

namespace fingertip::lattice::inline forces {

CubeLattice cube_lattice(ModelKind kind, const SpringConstants& constants, double spacing,
                         int cells) {
  constexpr double any_density = 1.0;  // statics does not see it
  const LatticeModel model = build_block(kind, Kinematics::small, constants, spacing,
                                         {cells, cells, cells}, any_density, 0.0);
  CubeLattice cube;
  cube.spacing = spacing;
  cube.cells = cells;
  cube.stiffness = small_strain_stiffness(model);
  cube.positions.reserve(model.particles.size());
  for (const std::size_t i : model.particles) cube.positions.push_back(model.rest_position(i));
  return cube;
}

}  // namespace fingertip::lattice::inline forces
