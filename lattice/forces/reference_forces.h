/// The force law written once more for reading: an edge list and a loop, as in the paper's Fig. 4.
/// The vectorised kernel is tested against it.
#pragma once

#include "lattice/model/model.h"
#include "lattice/model/state.h"

namespace fingertip::lattice {

/// AccumulateForces (paper, Fig. 4) in double precision, with the cells' volume term: the force
/// on every particle [N], zero elsewhere. Slow; for tests.
VectorField reference_forces(const LatticeModel& model, const State& state);

}  // namespace fingertip::lattice
