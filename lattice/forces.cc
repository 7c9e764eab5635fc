#include "lattice/forces.h"

#include <algorithm>

namespace fingertip::lattice {

namespace {

constexpr std::size_t grain = 16;  // blocks of eight points; about 20 microseconds of work

kernel::Variant variant_of(const LatticeModel& model) {
  const bool finite = model.kinematics == Kinematics::finite;
  return {finite, finite || !model.proportional_damping, model.has_volume_term()};
}

}  // namespace

InternalForces::InternalForces(const LatticeModel& model, Team& team, int width)
    : model_(&model),
      team_(&team),
      variant_(variant_of(model)),
      kernel_(width == 0 ? kernel::select(variant_) : kernel::select(variant_, width)) {
  for (std::size_t s = 0; s < directions; ++s) {
    arrays_.weight[s] = model.weight[s].data();
    arrays_.neighbour[s] = neighbour_offset(model.grid.size, int(s));
  }
  arrays_.row = model.grid.size[0];
  arrays_.plane = arrays_.row * model.grid.size[1];
  arrays_.spacing = model.spacing();
  std::copy(model.stiffness.begin(), model.stiffness.end(), arrays_.stiffness);
  std::copy(model.damping.begin(), model.damping.end(), arrays_.damping);
  arrays_.volume_stiffness = model.volume_stiffness;
  arrays_.volume_damping = model.volume_damping;
  arrays_.cell_weight = model.cell_weight.data();
  if (variant_.cells) {
    for (std::size_t k = 0; k < (variant_.finite ? 9u : 1u); ++k) {
      cell_force_[k].assign(model.points(), 0.0);
      arrays_.cell_force[k] = cell_force_[k].data();
    }
  }
  if (!variant_.rates) damped_ = VectorField(model.points());
}

void InternalForces::accumulate(const State& state, VectorField& force) {
  for (std::size_t c = 0; c < 3; ++c) {
    arrays_.displacement[c] = state.displacement.component[c].data();
    arrays_.velocity[c] = state.velocity.component[c].data();
    arrays_.force[c] = force.component[c].data();
  }
  if (!variant_.rates) {
    const double tau = model_->retardation_time;
    team_->split(model_->points(), lanes * grain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = 0; c < 3; ++c) {
        const double* u = state.displacement.component[c].data();
        const double* v = state.velocity.component[c].data();
        double* w = damped_.component[c].data();
        for (std::size_t i = begin; i < end; ++i) w[i] = u[i] + tau * v[i];
      }
    });
    for (std::size_t c = 0; c < 3; ++c) arrays_.displacement[c] = damped_.component[c].data();
  }
  if (kernel_.cells != nullptr) {
    team_->split(model_->cell_blocks.size(), grain, [&](std::size_t begin, std::size_t end) {
      kernel_.cells(arrays_, model_->cell_blocks.data(), begin, end);
    });
  }
  team_->split(model_->blocks.size(), grain, [&](std::size_t begin, std::size_t end) {
    kernel_.gather(arrays_, model_->blocks.data(), begin, end);
  });
}

}  // namespace fingertip::lattice
