/// How many floating-point operations the internal forces of a lattice take.
#pragma once

#include "lattice/model/model.h"

namespace kernel_probes {

/// Operations of one evaluation of all internal forces (springs, cells, dampers) over the number of
/// springs and fibres. Counted by running the kernels' own source on numbers that count
/// (counted.h), near rest; lanes of a block that hold no particle do the same work and are
/// included.
double operations_per_spring(const fingertip::lattice::LatticeModel& model);

}  // namespace kernel_probes
