/// What a rubber that relaxes remembers of its past (README: relaxation).
#pragma once

#include <vector>

#include "lattice/kernels/cell_kernel.h"
#include "lattice/kernels/parallel.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"

namespace fingertip::lattice {

/// At small strain the stress of a branch is b C:eps(d), d a displacement that obeys d' + d/tau =
/// u' (meshes/relaxation.h). At large strain cells hold a second Piola-Kirchhoff stress per branch
/// (Holzapfel & Simo 1996). Empty for a rubber that does not relax.
struct RelaxingMemory {
  double time = 0.0;                 ///< when it was noted [s]
  VectorField displacement;          ///< u then [m]
  std::vector<VectorField> lag;      ///< d of every branch then [m]
  std::vector<kernel::Lanes> cells;  ///< at large strain (cell_kernel.h)

  RelaxingMemory() = default;
  /// At rest since ever, at time 0.
  explicit RelaxingMemory(const LatticeModel& model);

  bool empty() const { return lag.empty() && cells.empty(); }
  /// Small strain: brings it to a state at a time not before its own, u having changed at a
  /// constant rate.
  void note(const LatticeModel& model, const State& state, double at, Team& team);
};

/// sum += b d of every branch at a state that follows `memory`; nothing if that is empty. Allocates
/// nothing.
void add_lags(const LatticeModel& model, const RelaxingMemory& memory, const State& state,
              double time, Team& team, VectorField& sum);

/// What the branches hold and lose; 0 at large strain, where the stress of a branch is not known by
/// an energy.
struct BranchEnergy {
  double stored = 0.0;       ///< sum of b/2 d·K d [J]
  double dissipation = 0.0;  ///< sum of b/tau d·K d [W]
};
BranchEnergy branch_energy(const LatticeModel& model, const RelaxingMemory& memory,
                           const State& state, double time, Team& team);

}  // namespace fingertip::lattice
