#include "lattice/forces/reference_forces.h"

#include <cmath>

#include "lattice/forces/cell_forces.h"

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

/// Equation (1): the force spring s applies to particle i; particle j feels the opposite.
Vector3 spring_force(const LatticeModel& model, const State& state, std::size_t i, std::size_t j,
                     const Direction& s) {
  const Vector3 rest = model.spacing() * Vector3(s.dx, s.dy, s.dz);
  const Vector3 relative = state.displacement.at(j) - state.displacement.at(i);
  const Vector3 rate = state.velocity.at(j) - state.velocity.at(i);
  const double k = model.stiffness[s.family], mu = model.damping[s.family];
  if (model.kinematics == Kinematics::small) {
    const Vector3 direction = rest.normalized();
    return (k * direction.dot(relative) + mu * direction.dot(rate)) * direction;
  }
  const Vector3 d = rest + relative;
  const Vector3 direction = d.normalized();
  return (k * (d.norm() - rest.norm()) + mu * rate.dot(direction)) * direction;
}

/// At small strain u + tau v stands for stiffness and damping together.
void add_cells(const LatticeModel& model, const State& state, VectorField& force) {
  VectorField displacement = state.displacement;
  if (model.kinematics == Kinematics::small) {
    for (const std::size_t i : model.particles) {
      displacement.add(i, model.retardation_time * state.velocity.at(i));
    }
  }
  reference_cell_forces(model.cell_lattice, displacement, state.velocity, force);
}

}  // namespace

VectorField reference_forces(const LatticeModel& model, const State& state) {
  VectorField force(model.points());
  for (int s = 0; model.has_springs() && s < directions; ++s) {
    const Direction& direction = half_stencil[std::size_t(s)];
    for (const std::size_t i : model.particles) {
      const double weight = model.weight[std::size_t(s)][i];
      if (weight == 0.0) continue;
      const std::size_t j = i + std::size_t(neighbour_offset(model.grid.size, s));
      const Vector3 pull = weight * spring_force(model, state, i, j, direction);
      force.add(i, pull);
      force.add(j, -pull);
    }
  }
  add_cells(model, state, force);
  return force;
}

}  // namespace fingertip::lattice
