/// Internal forces of the lattice: the paper's AccumulateForces, equation (1), and the cells.
#pragma once

#include <array>
#include <vector>

#include "lattice/kernel.h"
#include "lattice/model.h"
#include "lattice/parallel.h"
#include "lattice/state.h"

namespace fingertip::lattice {

/// Evaluates springs and cells with the vectorised kernel. Holds the scratch arrays, so that
/// accumulate() allocates nothing. Model and team must outlive it.
class InternalForces {
 public:
  /// `width`: doubles per register (2, 4, 8), 0 for the widest the processor has.
  InternalForces(const LatticeModel& model, Team& team, int width = 0);

  /// force = sum of spring and cell forces [N] at every particle for this state; at points that
  /// are no particles the force is zero or left as it was. `force` has model.points() entries.
  void accumulate(const State& state, VectorField& force);

 private:
  const LatticeModel* model_;
  Team* team_;
  kernel::Variant variant_;
  kernel::Kernel kernel_;
  kernel::Arrays arrays_{};
  VectorField damped_;  ///< u + tau v, where one pass can serve stiffness and damping
  std::array<std::vector<double>, 9> cell_force_;
};

}  // namespace fingertip::lattice
