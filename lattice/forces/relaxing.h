/// What a rubber that relaxes remembers of its past (README: relaxation).
#pragma once

#include <vector>

#include "lattice/kernels/cell_kernel.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline forces {

/// At small strain the stress of a branch is b C:eps(d), d a displacement that obeys d' + d/tau =
/// u' (meshes/rubber/relaxation.h). At large strain cells hold a second Piola-Kirchhoff stress per
/// branch (Holzapfel & Simo 1996). Empty for a rubber that does not relax.
struct RelaxingMemory {
  double time = 0.0;         ///< when it was noted [s]
  VectorField displacement;  ///< u then [m]
  /// b d of every branch then [m], and of their sum less its share of u, which all of them make of
  /// the present, what it is at both ends of the interval (find_history).
  std::vector<VectorField> lag;
  std::vector<kernel::Lanes> cells;  ///< at large strain (cell_kernel.h)

  RelaxingMemory() = default;
  /// At rest since ever, at time 0.
  explicit RelaxingMemory(const LatticeModel& model);

  bool empty() const { return lag.empty() && cells.empty(); }
};

/// How the branches have faded from `memory` to a time not before its own, for a constant rate of
/// what drives them; exact, unless it `may_hold` and was noted so lately that what all of them hold
/// together can be told from one straight line. `prony` is where it keeps what it points to.
kernel::History find_history(const LatticeModel& model, const RelaxingMemory& memory, double time,
                             bool may_hold, std::vector<kernel::PronyBranch>& prony);

/// At small strain: sum += b d of every branch at a state. `noted`: the memory itself, which is
/// brought to that state but for its time, or null. Allocates nothing.
void add_lags(const LatticeModel& model, const RelaxingMemory& memory,
              const kernel::History& history, const State& state, Team& team, VectorField& sum,
              RelaxingMemory* noted = nullptr);

/// What the branches hold and lose; 0 at large strain, where the stress of a branch is not known by
/// an energy.
struct BranchEnergy {
  double stored = 0.0;       ///< sum of b/2 d·K d [J]
  double dissipation = 0.0;  ///< sum of b/tau d·K d [W]
};
BranchEnergy branch_energy(const LatticeModel& model, const RelaxingMemory& memory,
                           const State& state, double time, Team& team, State& scratch);

}  // namespace fingertip::lattice::inline forces
