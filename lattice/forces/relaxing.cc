#include "lattice/forces/relaxing.h"

#include <algorithm>

#include "lattice/forces/cell_energy.h"
#include "lattice/forces/energy.h"

namespace fingertip::lattice {

namespace {

constexpr std::size_t lagging_at_once = 16;  // blocks of eight points

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

void find_fading(const LatticeModel& model, const RelaxingMemory& memory, double time,
                 std::vector<kernel::CellFading>& fading) {
  const meshes::Relaxation& relaxation = model.relaxation;
  fading.clear();
  for (std::size_t n = 0; n < relaxation.branches.size(); ++n) {
    const meshes::Fading own(time - memory.time, relaxation.branches[n].time);
    fading.push_back({own.keep, own.gain * relaxation.excess(n)});
  }
}

void add_lags(const LatticeModel& model, const RelaxingMemory& memory,
              const std::vector<kernel::CellFading>& fading, const State& state, Team& team,
              VectorField& sum, RelaxingMemory* noted) {
  const std::vector<std::uint32_t>& blocks = model.blocks;
  team.split(blocks.size(), lagging_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double *u = state.displacement.component[c].data(),
                   *before = memory.displacement.component[c].data();
      double* s = sum.component[c].data();
      for (std::size_t b = begin; b < end; ++b) {
        const std::size_t first = blocks[b];
        double change[lanes], total[lanes] = {};
        for (std::size_t i = 0; i < lanes; ++i) change[i] = u[first + i] - before[first + i];
        for (std::size_t n = 0; n < fading.size(); ++n) {
          const auto [keep, gain] = fading[n];
          const double* h = memory.lag[n].component[c].data() + first;
          double now[lanes];
          for (std::size_t i = 0; i < lanes; ++i) now[i] = keep * h[i] + gain * change[i];
          for (std::size_t i = 0; i < lanes; ++i) total[i] += now[i];
          if (noted != nullptr) std::copy_n(now, lanes, noted->lag[n].component[c].data() + first);
        }
        for (std::size_t i = 0; i < lanes; ++i) s[first + i] += total[i];
        if (noted != nullptr)
          std::copy_n(u + first, lanes, noted->displacement.component[c].data() + first);
      }
    }
  });
}

BranchEnergy branch_energy(const LatticeModel& model, const RelaxingMemory& memory,
                           const State& state, double time, Team& team) {
  BranchEnergy energy;
  if (memory.lag.empty()) return energy;
  RelaxingMemory now = memory;
  std::vector<kernel::CellFading> fading;
  find_fading(model, memory, time, fading);
  State lagging(model);
  add_lags(model, memory, fading, state, team, lagging.displacement, &now);
  for (std::size_t n = 0; n < now.lag.size(); ++n) {
    lagging.displacement = now.lag[n];
    const CellLattice& cells = model.cell_lattice;
    const double held = model.relaxation.bulk ? elastic_energy(model, lagging, team)
                                              : cell_energy(cells, cells.material.shear_alone(),
                                                            lagging.displacement, team),
                 stored = held / model.relaxation.excess(n);
    energy.stored += stored;
    energy.dissipation += 2.0 * stored / model.relaxation.branches[n].time;
  }
  return energy;
}

}  // namespace fingertip::lattice
