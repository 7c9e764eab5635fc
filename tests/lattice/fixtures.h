/// Small lattices and states shared by the tests of this folder.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <ostream>
#include <random>
#include <string>

#include "lattice/model/cut_model.h"
#include "lattice/model/formulation.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "tests/lattice/reference.h"

namespace fingertip::lattice {

inline void PrintTo(ModelKind kind, std::ostream* out) {
  *out << name(kind);
}

}  // namespace fingertip::lattice

namespace fixtures {

using namespace fingertip;
using meshes::Vector3;

inline lattice::SpringConstants constants_for(lattice::ModelKind kind, const meshes::Rubber& rubber,
                                              double spacing) {
  if (kind == lattice::ModelKind::published) return lattice::published_constants(rubber, spacing);
  // A nonzero k3, so that every class of spring takes part.
  auto k = lattice::hookean_constants(rubber, spacing, 0.2 * spacing * rubber.shear_modulus);
  if (kind == lattice::ModelKind::central) k.kappa = 0.0;
  return k;
}

inline lattice::LatticeSettings settings_for(lattice::ModelKind kind,
                                             lattice::Kinematics kinematics, int per_radius) {
  lattice::LatticeSettings settings;
  settings.model = kind;
  settings.kinematics = kinematics;
  settings.spacing = 0.01 / per_radius;
  settings.constants = constants_for(kind, {}, settings.spacing);
  return settings;
}

inline lattice::LatticeModel tip(lattice::ModelKind kind, lattice::Kinematics kinematics,
                                 int per_radius) {
  return lattice::build_tip({}, {}, settings_for(kind, kinematics, per_radius));
}

/// A free block of whole cells as tips are made of, its lowest corner at the origin.
inline lattice::LatticeModel cell_block(lattice::LatticeSettings settings,
                                        const std::array<int, 3>& cells,
                                        const meshes::Rubber& rubber = {}) {
  meshes::CubicGrid grid;
  grid.spacing = settings.spacing;
  grid.axes = settings.axes;
  grid.origin = Vector3::Constant(-settings.spacing);
  grid.size = {cells[0] + 3 + lattice::row_margin, cells[1] + 3, cells[2] + 3};
  return lattice::build_model(lattice::GridCells(grid, lattice::whole_cells({1, 1, 1}, cells)),
                              settings.model, lattice::formulation_for(rubber, settings),
                              rubber.density);
}

/// The same on R/10; network from its formulation, the others from springs.
inline lattice::LatticeModel block(lattice::ModelKind kind, lattice::Kinematics kinematics,
                                   std::array<int, 3> cells, double retardation_time = 3e-4) {
  const double spacing = 1e-3;
  meshes::Rubber rubber;
  rubber.retardation_time = retardation_time;
  if (kind == lattice::ModelKind::network) {
    return cell_block(settings_for(kind, kinematics, 10), cells, rubber);
  }
  return lattice::build_block(kind, kinematics, constants_for(kind, rubber, spacing), spacing,
                              cells, rubber.density, retardation_time);
}

/// Displacements up to `amplitude` spacings and velocities up to `speed` on every particle.
inline lattice::State random_state(const lattice::LatticeModel& model, double amplitude,
                                   double speed, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  lattice::State state(model);
  for (const std::size_t i : model.particles) {
    Vector3 shift, velocity;
    for (int c = 0; c < 3; ++c) shift[c] = uniform(generator);
    for (int c = 0; c < 3; ++c) velocity[c] = uniform(generator);
    state.displacement.set(i, amplitude * model.spacing() * shift);
    state.velocity.set(i, speed * velocity);
  }
  return state;
}

/// Leaves out what mirror planes hold of a part of a tip.
inline lattice::VectorField held(const lattice::LatticeModel& model, lattice::VectorField field) {
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::uint32_t p : model.held[c]) field.component[c][p] = 0.0;
  return field;
}

/// -df/du (`rates` false) or -df/dv about a state, by central differences of the plain forces;
/// exact for linear ones. Degree of freedom 3 p + c is axis c of the p-th entry of model.particles.
inline Eigen::MatrixXd tangent(const lattice::LatticeModel& model, lattice::State state,
                               bool rates = false) {
  const Eigen::Index count = Eigen::Index(model.particles.size());
  lattice::VectorField& field = rates ? state.velocity : state.displacement;
  const double h = 1e-5 * model.spacing();
  Eigen::MatrixXd matrix(3 * count, 3 * count);
  for (Eigen::Index j = 0; j < 3 * count; ++j) {
    double& value = field.component[std::size_t(j % 3)][model.particles[std::size_t(j / 3)]];
    const double at = value;
    value = at + h;
    const lattice::VectorField above = reference::forces(model, state);
    value = at - h;
    const lattice::VectorField below = reference::forces(model, state);
    value = at;
    for (Eigen::Index p = 0; p < count; ++p) {
      const std::size_t i = model.particles[std::size_t(p)];
      matrix.col(j).segment<3>(3 * p) = (below.at(i) - above.at(i)) / (2.0 * h);
    }
  }
  return matrix;
}

/// The diagonal of the mass matrix [kg]; degree of freedom 3 p + c is axis c of the p-th particle.
inline Eigen::VectorXd mass_vector(const lattice::LatticeModel& model) {
  Eigen::VectorXd mass(3 * Eigen::Index(model.particles.size()));
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    mass.segment<3>(3 * Eigen::Index(p)).setConstant(model.mass[model.particles[p]]);
  }
  return mass;
}

/// Largest eigenvalue of M⁻¹A, A a tangent's symmetric part [1/s² or 1/s].
inline double largest_rate(const lattice::LatticeModel& model, const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scale = mass_vector(model).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled =
      scale.asDiagonal() * (0.5 * (matrix + matrix.transpose())) * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
}

/// Largest magnitude of a field over the particles.
inline double largest(const lattice::LatticeModel& model, const lattice::VectorField& field) {
  double result = 0.0;
  for (const std::size_t i : model.particles) result = std::max(result, field.at(i).norm());
  return result;
}

inline constexpr std::array all_models{lattice::ModelKind::published, lattice::ModelKind::central,
                                       lattice::ModelKind::hookean, lattice::ModelKind::network};
/// Those on cut cells.
inline constexpr std::array cell_models{lattice::ModelKind::central, lattice::ModelKind::hookean,
                                        lattice::ModelKind::network};
inline constexpr std::array both_kinematics{lattice::Kinematics::small,
                                            lattice::Kinematics::finite};

/// The model's name, its kinematics: what a failure is about.
inline std::string label(lattice::ModelKind kind, lattice::Kinematics kinematics) {
  return std::string(name(kind)) + ", " + std::string(name(kinematics));
}

}  // namespace fixtures
