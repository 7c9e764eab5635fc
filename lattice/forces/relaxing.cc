#include "lattice/forces/relaxing.h"

#include <algorithm>
#include <limits>

#include "lattice/forces/cell_energy.h"
#include "lattice/forces/energy.h"

namespace fingertip::lattice::inline forces {

namespace {

/// What branches hold together bends so little within this share of their shortest time that it is
/// taken for straight: (1/30)²/8 of it are 0.014 %.
constexpr double interval = 1.0 / 30.0;

constexpr std::size_t lagging_at_once = 16;  // blocks of eight points

}  // namespace

RelaxingMemory::RelaxingMemory(const LatticeModel& model) {
  if (model.relaxation.empty()) return;
  if (model.kinematics == Kinematics::finite) {
    cells.assign(model.cell_lattice.blocks.size() * std::size_t(kernel::remembered) *
                     (3 + model.relaxation.branches.size()),
                 kernel::Lanes{});
    return;
  }
  displacement = VectorField(model.points());
  lag.assign(2 + model.relaxation.branches.size(), displacement);
}

kernel::History find_history(const LatticeModel& model, const RelaxingMemory& memory, double time,
                             bool may_hold, std::vector<kernel::PronyBranch>& prony) {
  const meshes::Relaxation& relaxation = model.relaxation;
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& branch : relaxation.branches) shortest = std::min(shortest, branch.time);
  const double length = interval * shortest, passed = time - memory.time;
  kernel::History history;
  history.held = may_hold && passed < length;
  history.second = passed / length;
  history.first = 1.0 - history.second;
  history.branches = int(relaxation.branches.size());
  history.values = memory.cells.empty() ? nullptr : memory.cells.data();
  prony.clear();
  for (std::size_t n = 0; n < relaxation.branches.size(); ++n) {
    const double own = relaxation.branches[n].time, b = relaxation.relative_modulus(n);
    const meshes::PronyRecursion now(passed, own), later(length, own);
    prony.push_back({now.decay, b * now.gain, later.decay});
    history.share += b * now.gain;
    history.gain_now += b;
    history.gain_later += b * later.gain;
  }
  history.prony = prony.data();
  return history;
}

void add_lags(const LatticeModel& model, const RelaxingMemory& memory,
              const kernel::History& history, const State& state, Team& team, VectorField& sum,
              RelaxingMemory* noted) {
  const std::vector<std::uint32_t>& blocks = model.blocks;
  const std::size_t branches = std::size_t(history.branches);
  const double share = history.share, at_start = history.first, at_end = history.second;
  /// Of eight points from `first` on.
  const auto hold = [&, share, at_start, at_end](std::size_t c, std::size_t first) {
    const double *u = state.displacement.component[c].data() + first,
                 *start = memory.lag[branches].component[c].data() + first,
                 *end = memory.lag[branches + 1].component[c].data() + first;
    double* s = sum.component[c].data() + first;
    for (std::size_t i = 0; i < lanes; ++i)
      s[i] += share * u[i] + (at_start * start[i] + at_end * end[i]);
  };
  const auto fade = [&](std::size_t c, std::size_t first) {
    const double *u = state.displacement.component[c].data() + first,
                 *before = memory.displacement.component[c].data() + first;
    double* s = sum.component[c].data() + first;
    double change[lanes], total[lanes] = {}, later[lanes] = {};
    for (std::size_t i = 0; i < lanes; ++i) change[i] = u[i] - before[i];
    for (std::size_t n = 0; n < branches; ++n) {
      const kernel::PronyBranch f = history.prony[n];
      const double* h = memory.lag[n].component[c].data() + first;
      double now[lanes];
      for (std::size_t i = 0; i < lanes; ++i) {
        now[i] = f.decay * h[i] + f.gain * change[i];
        total[i] += now[i];
        later[i] += f.later * now[i];
      }
      if (noted != nullptr) std::copy_n(now, lanes, noted->lag[n].component[c].data() + first);
    }
    for (std::size_t i = 0; i < lanes; ++i) s[i] += total[i];
    if (noted == nullptr) return;
    double *start = noted->lag[branches].component[c].data() + first,
           *end = noted->lag[branches + 1].component[c].data() + first;
    for (std::size_t i = 0; i < lanes; ++i) {
      start[i] = total[i] - history.gain_now * u[i];
      end[i] = later[i] - history.gain_later * u[i];
    }
    std::copy_n(u, lanes, noted->displacement.component[c].data() + first);
  };
  team.split(blocks.size(), lagging_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t b = begin; b < end; ++b)
        history.held ? hold(c, blocks[b]) : fade(c, blocks[b]);
  });
}

BranchEnergy branch_energy(const LatticeModel& model, const RelaxingMemory& memory,
                           const State& state, double time, Team& team, State& lagging) {
  BranchEnergy energy;
  if (memory.lag.empty()) return energy;
  for (std::size_t n = 0; n < model.relaxation.branches.size(); ++n) {
    const double own = model.relaxation.branches[n].time, b = model.relaxation.relative_modulus(n);
    const meshes::PronyRecursion recursion(time - memory.time, own);
    const double decay = recursion.decay, gain = recursion.gain * b;
    team.split(model.blocks.size(), lagging_at_once, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double *u = state.displacement.component[c].data(),
                     *before = memory.displacement.component[c].data(),
                     *h = memory.lag[n].component[c].data();
        double* now = lagging.displacement.component[c].data();
        for (std::size_t block = begin; block < end; ++block)
          for (std::size_t i = model.blocks[block]; i < model.blocks[block] + lanes; ++i)
            now[i] = decay * h[i] + gain * (u[i] - before[i]);
      }
    });
    const CellLattice& cells = model.cell_lattice;
    const double held = model.relaxation.bulk ? elastic_energy(model, lagging, team)
                                              : model.sector.count() *
                                                    cell_energy(cells, cells.material.shear_alone(),
                                                                lagging.displacement, team);
    energy.stored += held / b;
    energy.dissipation += 2.0 * held / (b * own);
  }
  return energy;
}

}  // namespace fingertip::lattice::inline forces
