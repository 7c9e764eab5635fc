#include "lattice/forces/forces.h"

#include <algorithm>

#include "lattice/forces/energy.h"

namespace fingertip::lattice::inline forces {

namespace {

constexpr std::size_t points_at_once = 16;  // blocks of eight points; about 20 microseconds of work

}  // namespace

InternalForces::InternalForces(const LatticeModel& model, Team& team, int width)
    : model_(&model),
      team_(&team),
      cells_(model.cell_lattice, team, width),
      shear_(model.cell_lattice, model.cell_lattice.material.shear_alone(), team, width),
      rates_(model.kinematics == Kinematics::finite || !model.proportional_damping) {
  if (model.has_springs()) {
    const kernel::Variant variant{model.kinematics == Kinematics::finite, rates_};
    springs_ = kernel::select(variant, width);
    const auto plane = neighbour_offset(model.grid.size, int(along_axis[2]));
    if (variant.finite)
      pulls_.assign(std::size_t(team.threads()), std::vector<double>(kernel::pulls_size(plane)));
  }
  for (std::size_t s = 0; s < directions; ++s) {
    arrays_.weight[s] = model.weight[s].data();
    arrays_.neighbour[s] = neighbour_offset(model.grid.size, int(s));
  }
  arrays_.spacing = model.spacing();
  std::copy(model.stiffness.begin(), model.stiffness.end(), arrays_.stiffness);
  std::copy(model.damping.begin(), model.damping.end(), arrays_.damping);
  if (!rates_) damped_ = VectorField(model.points());
  if (!model.relaxation.empty()) lagging_ = State(model);
  if (!model.relaxation.bulk) lag_ = VectorField(model.points());
}

CellExtremes InternalForces::accumulate(const State& state, double time,
                                        const RelaxingMemory& memory, VectorField& force) {
  return find(state, time, memory, nullptr, force, nullptr);
}

CellExtremes InternalForces::note(const State& state, double time, RelaxingMemory& memory,
                                  VectorField& force, double* energy) {
  return find(state, time, memory, &memory, force, energy);
}

CellExtremes InternalForces::find(const State& state, double time, const RelaxingMemory& memory,
                                  RelaxingMemory* noted, VectorField& force, double* energy) {
  kernel::History history;
  const bool lags = !memory.lag.empty(), apart = lags && !model_->relaxation.bulk;
  if (!memory.empty()) {
    history = find_history(*model_, memory, time, noted != nullptr, fading_);
    if (history.held) noted = nullptr;
    if (noted != nullptr && !noted->cells.empty()) history.noted = noted->cells.data();
  }
  const VectorField& displacement = rates_ ? state.displacement : damped(state);
  if (lags && !apart) add_lags(*model_, memory, history, state, *team_, damped_, noted);
  const CellExtremes extremes = respond(displacement, state, history, force, energy);
  if (apart) {
    for (auto& component : lag_.component) std::fill(component.begin(), component.end(), 0.0);
    add_lags(*model_, memory, history, state, *team_, lag_, noted);
    shear_.add(lag_, state.velocity, force);
  }
  if (noted != nullptr) noted->time = time;
  return extremes;
}

CellExtremes InternalForces::respond(const VectorField& displacement, const State& state,
                                     const kernel::History& history, VectorField& force,
                                     double* energy) {
  if (springs_ != nullptr) {
    add_springs(displacement, state, force);
  } else {
    clear(force);
  }
  // Damping of small strains and what relaxes there change the displacement that cells see.
  const bool on_the_way =
      springs_ == nullptr && &displacement == &state.displacement && history.values == nullptr;
  if (energy != nullptr && on_the_way) {
    const CellExtremes extremes = cells_.add(displacement, state.velocity, force, *energy);
    *energy *= model_->sector.count();
    return extremes;
  }
  if (energy != nullptr) *energy = elastic_energy(*model_, state, *team_);
  return cells_.add(displacement, state.velocity, force, history);
}

const VectorField& InternalForces::damped(const State& state) {
  const double tau = model_->retardation_time;
  const std::vector<std::uint32_t>& blocks = model_->blocks;
  team_->split(blocks.size(), points_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double* u = state.displacement.component[c].data();
      const double* v = state.velocity.component[c].data();
      double* w = damped_.component[c].data();
      for (std::size_t b = begin; b < end; ++b) {
        for (std::size_t i = blocks[b]; i < blocks[b] + lanes; ++i) w[i] = u[i] + tau * v[i];
      }
    }
  });
  return damped_;
}

void InternalForces::add_springs(const VectorField& displacement, const State& state,
                                 VectorField& force) {
  for (std::size_t c = 0; c < 3; ++c) {
    arrays_.displacement[c] = displacement.component[c].data();
    arrays_.velocity[c] = state.velocity.component[c].data();
    arrays_.force[c] = force.component[c].data();
  }
  const std::size_t blocks = model_->blocks.size();
  if (pulls_.empty()) {
    team_->split(blocks, points_at_once, [&](std::size_t begin, std::size_t end) {
      springs_(arrays_, model_->blocks.data(), begin, end, nullptr);
    });
    return;
  }
  // One portion per thread: at its begin a plane of springs is evaluated twice.
  const std::size_t portions = pulls_.size();
  team_->split(portions, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t portion = begin; portion < end; ++portion) {
      springs_(arrays_, model_->blocks.data(), portion * blocks / portions,
               (portion + 1) * blocks / portions, pulls_[portion].data());
    }
  });
}

void InternalForces::clear(VectorField& force) {
  const std::vector<std::uint32_t>& blocks = model_->blocks;
  team_->split(blocks.size(), points_at_once, [&](std::size_t begin, std::size_t end) {
    for (auto& component : force.component) {
      for (std::size_t b = begin; b < end; ++b)
        std::fill_n(component.data() + blocks[b], lanes, 0.0);
    }
  });
}

}  // namespace fingertip::lattice::inline forces
