#include "lattice/forces/relaxing.h"

#include <algorithm>

#include "lattice/forces/cell_energy.h"
#include "lattice/forces/energy.h"

namespace fingertip::lattice {

namespace {

constexpr std::size_t lagging_at_once = 16;  // blocks of eight points

using meshes::Fading;

/// Calls body(component, first point) for the model's blocks.
template <typename Body>
void over_blocks(const LatticeModel& model, Team& team, const Body& body) {
  const std::vector<std::uint32_t>& blocks = model.blocks;
  team.split(blocks.size(), lagging_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t b = begin; b < end; ++b) body(c, std::size_t(blocks[b]));
  });
}

}  // namespace

RelaxingMemory::RelaxingMemory(const LatticeModel& model) {
  if (model.relaxation.empty()) return;
  if (model.kinematics == Kinematics::finite) {
    cells.assign(model.cell_lattice.blocks.size() * std::size_t(kernel::remembered) *
                     (1 + model.relaxation.branches.size()),
                 kernel::Lanes{});
    return;
  }
  displacement = VectorField(model.points());
  lag.assign(model.relaxation.branches.size(), displacement);
}

void RelaxingMemory::note(const LatticeModel& model, const State& state, double at, Team& team) {
  if (lag.empty()) return;
  for (std::size_t n = 0; n < lag.size(); ++n) {
    const Fading fading(at - time, model.relaxation.branches[n].time);
    over_blocks(model, team, [&](std::size_t c, std::size_t first) {
      const double *u = state.displacement.component[c].data() + first,
                   *before = displacement.component[c].data() + first;
      double* d = lag[n].component[c].data() + first;
      for (std::size_t i = 0; i < lanes; ++i)
        d[i] = fading.keep * d[i] + fading.gain * (u[i] - before[i]);
    });
  }
  over_blocks(model, team, [&](std::size_t c, std::size_t first) {
    std::copy_n(state.displacement.component[c].data() + first, lanes,
                displacement.component[c].data() + first);
  });
  time = at;
}

void add_lags(const LatticeModel& model, const RelaxingMemory& memory, const State& state,
              double time, Team& team, VectorField& sum) {
  for (std::size_t n = 0; n < memory.lag.size(); ++n) {
    const Fading fading(time - memory.time, model.relaxation.branches[n].time);
    const double keep = model.relaxation.excess(n) * fading.keep,
                 gain = model.relaxation.excess(n) * fading.gain;
    over_blocks(model, team, [&](std::size_t c, std::size_t first) {
      const double *u = state.displacement.component[c].data() + first,
                   *before = memory.displacement.component[c].data() + first,
                   *d = memory.lag[n].component[c].data() + first;
      double* s = sum.component[c].data() + first;
      for (std::size_t i = 0; i < lanes; ++i) s[i] += keep * d[i] + gain * (u[i] - before[i]);
    });
  }
}

BranchEnergy branch_energy(const LatticeModel& model, const RelaxingMemory& memory,
                           const State& state, double time, Team& team) {
  BranchEnergy energy;
  if (memory.lag.empty()) return energy;
  RelaxingMemory now = memory;
  now.note(model, state, time, team);
  State lagging(model);
  for (std::size_t n = 0; n < now.lag.size(); ++n) {
    lagging.displacement = now.lag[n];
    const CellLattice& cells = model.cell_lattice;
    const double held = model.relaxation.bulk ? elastic_energy(model, lagging, team)
                                              : cell_energy(cells, cells.material.shear_alone(),
                                                            lagging.displacement, team),
                 stored = model.relaxation.excess(n) * held;
    energy.stored += stored;
    energy.dissipation += 2.0 * stored / model.relaxation.branches[n].time;
  }
  return energy;
}

}  // namespace fingertip::lattice
