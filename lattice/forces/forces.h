/// Internal forces of the lattice: the paper's AccumulateForces, equation (1), and the cells.
#pragma once

#include "lattice/forces/cell_forces.h"
#include "lattice/forces/relaxing.h"
#include "lattice/kernels/kernel.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline forces {

/// Evaluates springs and cells with the vectorised kernels. Holds the scratch arrays, so that
/// accumulate() allocates nothing. Model and team must outlive it.
class InternalForces {
 public:
  /// `width`: doubles per register (2, 4, 8), 0 for the widest the processor has.
  InternalForces(const LatticeModel& model, Team& team, int width = 0);

  /// force = sum of spring and cell forces [N] at every particle for this state; at points that
  /// are no particles the force is zero or left as it was. `force` has model.points() entries.
  /// Returns how far the cells are from rest (rest itself for models without a cell law).
  CellExtremes accumulate(const State& state, VectorField& force) {
    return accumulate(state, 0.0, {}, force);
  }
  /// With what a rubber that relaxes remembers, at a time not before it noted that; without
  /// (empty) the forces are those after long times.
  CellExtremes accumulate(const State& state, double time, const RelaxingMemory& memory,
                          VectorField& force);
  /// The same, and the memory is brought to this state when it is time to. `energy`: receives what
  /// springs and cells store [J] (elastic_energy()) if it is asked for, found on the way where the
  /// cells' kernel can, else apart.
  CellExtremes note(const State& state, double time, RelaxingMemory& memory, VectorField& force,
                    double* energy = nullptr);
  /// What the branches hold and lose at a state that follows `memory`.
  BranchEnergy branch_energy(const State& state, double time, const RelaxingMemory& memory) const {
    return lattice::branch_energy(*model_, memory, state, time, *team_, lagging_);
  }

 private:
  const VectorField& damped(const State& state);
  CellExtremes find(const State& state, double time, const RelaxingMemory& memory,
                    RelaxingMemory* noted, VectorField& force, double* energy);
  CellExtremes respond(const VectorField& displacement, const State& state,
                       const kernel::History& history, VectorField& force, double* energy);
  void add_springs(const VectorField& displacement, const State& state, VectorField& force);
  void clear(VectorField& force);

  const LatticeModel* model_;
  Team* team_;
  kernel::SpringForces springs_ = nullptr;  ///< null without springs
  CellForces cells_, shear_;                ///< `shear_`: what relaxes where the bulk does not
  bool rates_ = true;  ///< else one pass at u + tau v serves stiffness and damping
  kernel::Arrays arrays_{};
  std::vector<std::vector<double>> pulls_;  ///< scratch of the springs, per portion of the blocks
  VectorField damped_;                      ///< u + tau v, and what relaxes
  VectorField lag_;                         ///< what relaxes where the bulk does not
  mutable State lagging_;                   ///< scratch
  std::vector<kernel::PronyBranch> fading_;
};

}  // namespace fingertip::lattice::inline forces
