#include "lattice/reference_forces.h"

#include <Eigen/LU>
#include <cmath>

#include "lattice/cell.h"

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

void add_cell(const LatticeModel& model, const State& state, std::size_t cell, VectorField& force) {
  const double a = model.spacing();
  Eigen::Matrix3d edges = a * Eigen::Matrix3d::Identity();
  if (model.kinematics == Kinematics::finite) edges += mean_edges(model, state.displacement, cell);
  // dV/d(edge k) is the face vector spanned by the other two edges.
  const Eigen::Matrix3d faces = edges.inverse().transpose() * edges.determinant();
  const Eigen::Matrix3d rates = mean_edges(model, state.velocity, cell);
  const double pressure = model.volume_stiffness * volume_change(model, state.displacement, cell) +
                          model.volume_damping * faces.cwiseProduct(rates).sum() / (a * a * a);
  for (int c = 0; c < 8; ++c) {
    Vector3 face = Vector3::Zero();
    for (int k = 0; k < 3; ++k) face += (c >> k & 1 ? 0.25 : -0.25) * faces.col(k);
    force.add(cell_corner(model.grid.size, cell, c), -pressure * face);
  }
}

}  // namespace

VectorField reference_forces(const LatticeModel& model, const State& state) {
  VectorField force(model.points());
  for (int s = 0; s < directions; ++s) {
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
  if (model.has_volume_term()) {
    for (const std::size_t cell : model.cells) add_cell(model, state, cell, force);
  }
  return force;
}

}  // namespace fingertip::lattice
