/// What the kernels are tested against: one spring and one cell after another, from definitions.
///
/// Independent of the product's laws (lattice/kernels/cell_law.h, cell_response.h): of cells only
/// energy and dissipation are written here, no stress. Forces are their derivatives by complex
/// steps, which are exact to round-off.
#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <complex>
#include <limits>
#include <map>

#include "lattice/kernels/stencil.h"
#include "lattice/model/cell_lattice.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/paper/particle_system.h"

namespace reference {

using namespace fingertip;
using Eigen::Matrix3d;
using Eigen::Matrix4d;
using lattice::CellLattice;
using lattice::CellLawKind;
using lattice::CellMaterial;
using lattice::VectorField;
using meshes::Vector3;

using Complex = std::complex<double>;
template <typename Number>
using Gradient = Eigen::Matrix<Number, 3, 3>;
template <typename Number>
using Modes = Eigen::Matrix<Number, 3, 4>;  // columns: yz, zx, xy, xyz

struct Cell {
  std::size_t lowest = 0;  ///< grid index of its lowest corner
  double fraction = 1.0;
  Vector3 mean = Vector3::Zero();     ///< of x, y, z over the rubber
  Vector3 product = Vector3::Zero();  ///< of yz, zx, xy
  Matrix4d bent = Matrix4d::Zero();   ///< bending Omega [Pa]
};

inline Cell cell_of(const CellLattice& cells, const lattice::CellBlock& block, std::size_t lane) {
  Cell cell;
  cell.lowest = block.first + lane;
  if (block.cut == lattice::CellBlock::whole) {
    cell.bent = cells.material.hourglass_modulus * Eigen::Vector4d(2.0, 2.0, 2.0, 3.0).asDiagonal();
    return cell;
  }
  const auto value = [&](std::size_t v) { return cells.cut[block.cut + v].at[lane]; };
  cell.fraction = value(0);
  cell.mean = {value(1), value(2), value(3)};
  cell.product = {value(4), value(5), value(6)};
  if (cell.fraction == 0.0) return cell;  // absent
  Matrix4d root = Matrix4d::Zero();
  std::size_t next = 7;
  for (int m = 0; m < 4; ++m)
    for (int n = m; n < 4; ++n) root(m, n) = value(next++);
  cell.bent = root.transpose() * root / (0.25 * cells.spacing * cells.spacing * cell.fraction);
  return cell;
}

template <typename Visit>
void for_all_cells(const CellLattice& cells, const Visit& visit) {
  for (const lattice::CellBlock& block : cells.blocks) {
    for (std::size_t lane = 0; lane < lattice::lanes; ++lane) {
      const Cell cell = cell_of(cells, block, lane);
      if (cell.fraction > 0.0) visit(cell);
    }
  }
}

inline std::size_t corner(const CellLattice& cells, const Cell& cell, int c) {
  return cell.lowest + std::size_t((c & 1) + (c >> 1 & 1) * cells.row + (c >> 2) * cells.plane);
}

inline Vector3 signs_of(int c) {
  return {c & 1 ? 1.0 : -1.0, c & 2 ? 1.0 : -1.0, c & 4 ? 1.0 : -1.0};
}

/// Per corner, how the mean gradient follows from its displacement: H = Σ u_c slope_cᵀ [1/m].
inline Vector3 mean_slope(const Cell& cell, double spacing, int c) {
  const Vector3 s = signs_of(c), m = cell.mean, p = cell.product;
  const double x = s.x(), y = s.y(), z = s.z();
  return Vector3(x * (1.0 + z * m.z() + y * m.y() + y * z * p.x()),
                 y * (1.0 + z * m.z() + x * m.x() + z * x * p.y()),
                 z * (1.0 + y * m.y() + x * m.x() + x * y * p.z())) /
         (4.0 * spacing);
}

/// Per corner, the weights of its displacement in the bilinear modes [1/m].
inline Eigen::Vector4d mode_weights(double spacing, int c) {
  const Vector3 s = signs_of(c);
  return Eigen::Vector4d(s.y() * s.z(), s.z() * s.x(), s.x() * s.y(), s.prod()) / (4.0 * spacing);
}

/// Mean gradient and modes of a displacement or velocity; or what is conjugate to them.
template <typename Number>
struct Field {
  Gradient<Number> H = Gradient<Number>::Zero();
  Modes<Number> q = Modes<Number>::Zero();
};

inline Field<double> field_of(const CellLattice& cells, const Cell& cell,
                              const VectorField& values) {
  Field<double> d;
  for (int c = 0; c < 8; ++c) {
    const Vector3 u = values.at(corner(cells, cell, c));
    d.H += u * mean_slope(cell, cells.spacing, c).transpose();
    d.q += u * mode_weights(cells.spacing, c).transpose();
  }
  return d;
}

template <typename Matrix>
auto sum_of_squares(const Matrix& m) {
  return m.cwiseProduct(m).sum();
}

/// Of a Mooney-Rivlin law free of volume with K/2 (J - 1)², or of an ogden law of l⁴ and l⁻² with
/// m/2 (ln J)², whose sums are polynomials of the invariants.
template <typename Number>
Number hyperelastic_density(const CellMaterial& m, const Field<Number>& u, const Number& excess) {
  const Gradient<Number> F = Gradient<Number>::Identity() + u.H, C = F.transpose() * F;
  const Number J = F.determinant(), I1 = C.trace(), log_J = std::log(J);
  const Number I2 = 0.5 * (I1 * I1 - sum_of_squares(C));
  const auto& s = m.energy.shape;
  const double G = m.shear, k = m.volumetric;
  if (m.energy.law == meshes::RubberLaw::mooney_rivlin) {
    const Number a = std::exp(-2.0 / 3.0 * log_J);
    return 0.5 * G * (1.0 - s[0]) * (a * (I1 + excess) - 3.0) +
           0.5 * G * s[0] * (a * a * (I2 + I1 * excess / 3.0) - 3.0) +
           0.5 * k * (J - 1.0) * (J - 1.0);
  }
  const Number fourth = I1 * I1 - 2.0 * I2, inverse = I2 / (J * J),
               inverse_fourth = inverse * inverse - 2.0 * I1 / (J * J);
  const double mu = G * s[0], nu = G * s[2];  // of l⁴ and of l⁻²
  return mu / 8.0 * (fourth - 3.0) + nu / 2.0 * (inverse - 3.0) - (0.5 * mu - nu) * log_J +
         0.5 * k * log_J * log_J + 0.5 * excess * (mu * I1 + nu * inverse_fourth) / 3.0;
}

/// Stored per volume (CellMaterial) [J/m³].
template <typename Number>
Number energy_density(const CellMaterial& m, const Field<Number>& u, const Matrix4d& bent) {
  const Number bending = 0.5 * (u.q * bent.cast<Number>()).cwiseProduct(u.q).sum();
  if (m.kind == CellLawKind::cubic) {
    const Gradient<Number> strain = 0.5 * (u.H + u.H.transpose());
    const Number trace = strain.trace(), normal = sum_of_squares(strain.diagonal());
    return 0.5 * ((m.c11 - m.c12) * normal + m.c12 * trace * trace) +
           m.c44 * (sum_of_squares(strain) - normal) + bending;
  }
  const Number J = (Gradient<Number>::Identity() + u.H).determinant();
  if (m.kind == CellLawKind::volume) return 0.5 * m.kappa * (J - 1.0) * (J - 1.0);
  if (m.holds_fibres()) return hyperelastic_density<Number>(m, u, 2.0 * bending / m.shear);
  // |F|² - 3 written so that it does not cancel at small strain.
  const Number excess = 2.0 * u.H.trace() + sum_of_squares(u.H), log_J = std::log(J);
  return 0.5 * m.shear * excess - m.shear * log_J + 0.5 * m.lambda * log_J * log_J + bending;
}

/// Half of what the dampers of a cell deformed by `u` take per volume at a velocity `v` [W/m³].
template <typename Number>
Number dissipation(const CellMaterial& m, const Field<double>& u, const Field<Number>& v,
                   const Matrix4d& bent) {
  const Matrix3d F = Matrix3d::Identity() + u.H, inverse = F.inverse();
  const Gradient<Number> L = v.H * inverse.cast<Number>();
  const double tau = m.retardation_time;
  if (m.kind == CellLawKind::volume) {
    const Number rate = F.determinant() * L.trace();
    return 0.5 * tau * m.kappa * rate * rate;
  }
  const Gradient<Number> D = 0.5 * (L + L.transpose());
  const Modes<Number> slip = v.q - L * u.q.cast<Number>();
  return 0.5 * tau * (m.lambda * L.trace() * L.trace() + 2.0 * m.shear * sum_of_squares(D)) +
         0.5 * tau * (slip * bent.cast<Number>()).cwiseProduct(slip).sum();
}

/// Derivatives of `function` by all entries of its argument.
template <typename Function>
Field<double> derivative(const Field<double>& at, const Function& function) {
  constexpr double step = 1e-30;
  Field<Complex> z{at.H.cast<Complex>(), at.q.cast<Complex>()};
  Field<double> result;
  const auto differentiate = [&](auto& entries, auto& slopes) {
    for (Eigen::Index n = 0; n < entries.size(); ++n) {
      const Complex before = entries.data()[n];
      entries.data()[n] += Complex(0.0, step);
      slopes.data()[n] = function(z).imag() / step;
      entries.data()[n] = before;
    }
  };
  differentiate(z.H, result.H);
  differentiate(z.q, result.q);
  return result;
}

/// Energy of all cells [J]; infinite where the law needs J > 0 and has not got it.
inline double cell_energy(const CellLattice& cells, const VectorField& displacement) {
  double sum = 0.0;
  for_all_cells(cells, [&](const Cell& cell) {
    const Field<double> u = field_of(cells, cell, displacement);
    const bool lost = cells.material.kind == CellLawKind::network &&
                      !((Matrix3d::Identity() + u.H).determinant() > 0.0);
    sum += lost ? std::numeric_limits<double>::infinity()
                : cell.fraction * std::pow(cells.spacing, 3) *
                      energy_density(cells.material, u, cell.bent);
  });
  return sum;
}

/// What CellForces::add does.
inline void cell_forces(const CellLattice& cells, const VectorField& displacement,
                        const VectorField& velocity, VectorField& force) {
  const CellMaterial& m = cells.material;
  const bool rates = m.kind != CellLawKind::cubic && m.retardation_time > 0.0;
  for_all_cells(cells, [&](const Cell& cell) {
    const Field<double> u = field_of(cells, cell, displacement);
    Field<double> all =
        derivative(u, [&](const Field<Complex>& at) { return energy_density(m, at, cell.bent); });
    if (rates) {
      const Field<double> viscous =
          derivative(field_of(cells, cell, velocity),
                     [&](const Field<Complex>& at) { return dissipation(m, u, at, cell.bent); });
      all.H += viscous.H;
      all.q += viscous.q;
    }
    const double volume = cell.fraction * std::pow(cells.spacing, 3);
    for (int c = 0; c < 8; ++c) {
      force.add(corner(cells, cell, c), -volume * (all.H * mean_slope(cell, cells.spacing, c) +
                                                   all.q * mode_weights(cells.spacing, c)));
    }
  });
}

/// The model's particles and springs as the paper has them, in the tip's frame.
inline lattice::paper::ParticleSystem particle_system(const lattice::LatticeModel& model,
                                                      const lattice::State& state) {
  lattice::paper::ParticleSystem system;
  std::map<std::size_t, std::size_t> number;
  for (const std::size_t i : model.particles) {
    number[i] = system.P.size();
    system.P.push_back({.m = model.mass[i],
                        .x = model.rest_position(i) + model.grid.axes * state.displacement.at(i),
                        .v = model.grid.axes * state.velocity.at(i)});
  }
  for (std::size_t s = 0; model.has_springs() && s < lattice::half_stencil.size(); ++s) {
    const lattice::Family family = lattice::half_stencil[s].family;
    for (const std::size_t i : model.particles) {
      const double weight = model.weight[s][i];
      if (weight == 0.0) continue;
      const std::size_t j = i + std::size_t(lattice::neighbour_offset(model.grid.size, int(s)));
      system.S.push_back({number.at(i), number.at(j), weight * model.stiffness[family],
                          weight * model.damping[family], model.rest_length(family)});
    }
  }
  return system;
}

/// What equation (1) is to first order in displacements and velocities.
inline Vector3 linear_spring_force(const lattice::paper::ParticleSystem& rest,
                                   const lattice::paper::ParticleSystem& system,
                                   const lattice::paper::Spring& s) {
  const Vector3 direction = (rest.P[s.j].x - rest.P[s.i].x).normalized();
  const Vector3 relative = (system.P[s.j].x - rest.P[s.j].x) - (system.P[s.i].x - rest.P[s.i].x);
  const Vector3 rate = system.P[s.j].v - system.P[s.i].v;
  return (s.k * direction.dot(relative) + s.mu * direction.dot(rate)) * direction;
}

/// The internal force on every particle [N], zero elsewhere: AccumulateForces (lattice/paper) and
/// the cells.
inline VectorField forces(const lattice::LatticeModel& model, const lattice::State& state) {
  lattice::paper::ParticleSystem system = particle_system(model, state);
  if (model.kinematics == lattice::Kinematics::small) {
    const auto rest = particle_system(model, lattice::State(model));
    for (const lattice::paper::Spring& s : system.S) {
      const Vector3 u = linear_spring_force(rest, system, s);
      system.P[s.i].f += u;
      system.P[s.j].f -= u;
    }
  } else {
    lattice::paper::AccumulateForces(system);
  }
  VectorField force(model.points());
  for (std::size_t p = 0; p < model.particles.size(); ++p)
    force.add(model.particles[p], model.grid.axes.transpose() * system.P[p].f);
  // At small strain u + tau v stands for stiffness and damping together.
  VectorField displacement = state.displacement;
  if (model.kinematics == lattice::Kinematics::small) {
    for (const std::size_t i : model.particles)
      displacement.add(i, model.retardation_time * state.velocity.at(i));
  }
  cell_forces(model.cell_lattice, displacement, state.velocity, force);
  return force;
}

}  // namespace reference
