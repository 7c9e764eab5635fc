/// The moving lattice of the tip with its true surfaces.
#pragma once

#include "lattice/model/model.h"

namespace fingertip::lattice::inline model {

/// central, hookean or network on cells cut by the tip's true surfaces (cut_tip.h), laid out
/// for the kernels. Masses are moments of the shape functions over the rubber, but no particle is
/// lighter than what keeps it, its neighbours held, from vibrating at more than 1.7 times the
/// squared frequency of a particle among whole cells: the far corners of slivers would otherwise
/// dictate the time step (R/12: 0.5 instead of 0.9 of the infinite lattice's). That adds, at R/8
/// and R/12, 0.2 to 0.4 % of the rubber's mass, 0.6 to 1.2 % with central springs (`added_mass`);
/// forces in equilibrium do not see it. `sectors` as of cut_tip. Throws InvalidInput as that does.
LatticeModel build_cut_model(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                             const LatticeSettings& settings, int sectors = 1);

/// The published tip or a cut one.
LatticeModel build_tip(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                       const LatticeSettings& settings, int sectors = 1);

}  // namespace fingertip::lattice::inline model
