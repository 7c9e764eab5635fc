#include "lattice/forces/energy.h"

#include <cmath>
#include <iterator>
#include <numeric>

#include "lattice/forces/cell_energy.h"
#include "lattice/threads/sum_in_portions.h"

namespace fingertip::lattice::inline forces {

using meshes::Vector3;

namespace {

double spring_energy(const LatticeModel& model, const State& state, int s) {
  const Direction& direction = half_stencil[std::size_t(s)];
  const Vector3 rest = model.spacing() * Vector3(direction.dx, direction.dy, direction.dz);
  const double length = rest.norm();
  const std::size_t step = std::size_t(neighbour_offset(model.grid.size, s));
  const auto& weight = model.weight[std::size_t(s)];
  double sum = 0.0;
  for (const std::size_t i : model.particles) {
    if (weight[i] == 0.0) continue;
    const Vector3 relative = state.displacement.at(i + step) - state.displacement.at(i);
    const double elongation = model.kinematics == Kinematics::small
                                  ? relative.dot(rest) / length
                                  : (rest + relative).norm() - length;
    sum += weight[i] * elongation * elongation;
  }
  return 0.5 * model.stiffness[direction.family] * sum;
}

/// Of some blocks of points; those that are no particles have no mass.
double kinetic_energy(const LatticeModel& model, const State& state, std::size_t first,
                      std::size_t last) {
  double twice[lanes] = {};
  for (std::size_t b = first; b < last; ++b) {
    const std::size_t p = model.blocks[b];
    for (std::size_t c = 0; c < 3; ++c) {
      const double *mass = model.mass.data() + p, *v = state.velocity.component[c].data() + p;
      for (std::size_t i = 0; i < lanes; ++i) twice[i] += mass[i] * v[i] * v[i];
    }
  }
  return 0.5 * std::accumulate(std::begin(twice), std::end(twice), 0.0);
}

}  // namespace

double elastic_energy(const LatticeModel& model, const State& state) {
  Team alone(1);
  return elastic_energy(model, state, alone);
}

double elastic_energy(const LatticeModel& model, const State& state, Team& team) {
  double energy = cell_energy(model.cell_lattice, state.displacement, team);
  if (model.has_springs())
    for (int s = 0; s < directions; ++s) energy += spring_energy(model, state, s);
  return model.sector.count() * energy;
}

double kinetic_energy(const LatticeModel& model, const State& state) {
  Team alone(1);
  return kinetic_energy(model, state, alone);
}

double kinetic_energy(const LatticeModel& model, const State& state, Team& team) {
  const double part = sum_in_portions<16>(
      team, model.blocks.size(),
      [&](std::size_t begin, std::size_t end) { return kinetic_energy(model, state, begin, end); });
  return model.sector.count() * part;
}

Vector3 linear_momentum(const LatticeModel& model, const State& state) {
  Vector3 sum = Vector3::Zero();
  for (const std::size_t i : model.particles) sum += model.mass[i] * state.velocity.at(i);
  return model.sector.whole(Vector3(model.grid.axes * sum));
}

}  // namespace fingertip::lattice::inline forces
