/// Small lattices and states shared by the tests of this room.
#pragma once

#include <random>

#include "lattice/model.h"
#include "lattice/state.h"

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

inline lattice::LatticeModel block(lattice::ModelKind kind, lattice::Kinematics kinematics,
                                   std::array<int, 3> cells, double retardation_time = 3e-4) {
  const double spacing = 1e-3;
  return lattice::build_block(kind, kinematics, constants_for(kind, {}, spacing), spacing, cells,
                              500.0, retardation_time);
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

/// Largest magnitude of a field over the particles.
inline double largest(const lattice::LatticeModel& model, const lattice::VectorField& field) {
  double result = 0.0;
  for (const std::size_t i : model.particles) result = std::max(result, field.at(i).norm());
  return result;
}

inline constexpr std::array all_models{lattice::ModelKind::published, lattice::ModelKind::central,
                                       lattice::ModelKind::hookean};
inline constexpr std::array both_kinematics{lattice::Kinematics::small,
                                            lattice::Kinematics::finite};

}  // namespace fixtures
