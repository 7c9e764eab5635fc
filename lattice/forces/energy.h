/// Energies of the lattice, of the whole tip where a part is computed; the ligaments' is in bond.h.
#pragma once

#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline forces {

/// Energy of springs, ½ k (elongation)², and of cells (CellMaterial) [J]; the internal forces
/// without damping are minus its gradient.
double elastic_energy(const LatticeModel& model, const State& state, Team& team);
double elastic_energy(const LatticeModel& model, const State& state);

/// Sum of ½ m v² [J].
double kinetic_energy(const LatticeModel& model, const State& state, Team& team);
double kinetic_energy(const LatticeModel& model, const State& state);

/// Sum of m v [N s].
meshes::Vector3 linear_momentum(const LatticeModel& model, const State& state);

}  // namespace fingertip::lattice::inline forces
