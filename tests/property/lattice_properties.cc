// Properties that hold for every deformation, checked on random ones.
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>

#include "lattice/energy.h"
#include "lattice/forces.h"
#include "lattice/model.h"
#include "lattice/reference_forces.h"
#include "lattice/state.h"

using namespace fingertip;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::State;
using lattice::VectorField;
using meshes::Vector3;

namespace {

double uniform(double from, double to) {
  return from + (to - from) * 1e-9 * *rc::gen::inRange(0, 1000000001);
}
Vector3 random_vector(double size) {
  return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
}

LatticeModel random_block() {
  const auto kind = *rc::gen::element(ModelKind::published, ModelKind::central, ModelKind::hookean);
  const auto kinematics = *rc::gen::element(Kinematics::small, Kinematics::finite);
  const std::array<int, 3> cells{*rc::gen::inRange(1, 11), *rc::gen::inRange(1, 4),
                                 *rc::gen::inRange(1, 4)};
  const double a = uniform(1e-4, 1e-2);
  const lattice::SpringConstants k{uniform(0.1, 10.0), uniform(0.0, 10.0), uniform(0.0, 10.0),
                                   uniform(0.0, 1e4)};
  return lattice::build_block(kind, kinematics, k, a, cells, 500.0, uniform(0.0, 1e-3));
}

State random_state(const LatticeModel& model, double speed) {
  State state(model);
  for (const std::size_t i : model.particles) {
    state.displacement.set(i, random_vector(0.2 * model.spacing()));
    state.velocity.set(i, random_vector(speed));
  }
  return state;
}

VectorField forces(const LatticeModel& model, const State& state) {
  lattice::Team team(1);
  lattice::InternalForces internal(model, team);
  VectorField force(model.points());
  internal.accumulate(state, force);
  return force;
}

double power(const LatticeModel& model, const VectorField& force, const VectorField& velocity) {
  double sum = 0.0;
  for (const std::size_t i : model.particles) sum += force.at(i).dot(velocity.at(i));
  return sum;
}

/// Sum of the forces' magnitudes, plus the round-off that even a body at rest has.
double size_of(const LatticeModel& model, const VectorField& field) {
  double sum = 0.0;
  for (const std::size_t i : model.particles) sum += field.at(i).norm();
  const double stiffest = model.stiffness[0] + model.stiffness[1] + model.stiffness[2];
  return sum + 1e-3 * stiffest * model.spacing();
}

bool kernel_equals_edge_list() {
  return rc::check("the kernel computes the edge list's forces", [] {
    const LatticeModel model = random_block();
    const State state = random_state(model, 1.0);
    const VectorField expected = lattice::reference_forces(model, state);
    const VectorField computed = forces(model, state);
    const double scale = size_of(model, expected);
    for (const std::size_t i : model.particles) {
      RC_ASSERT((computed.at(i) - expected.at(i)).norm() <= 1e-12 * scale);
    }
  });
}

bool forces_balance() {
  return rc::check("internal forces add up to nothing, and so do their moments", [] {
    const LatticeModel model = random_block();
    const State state = random_state(model, 1.0);
    const VectorField force = forces(model, state);
    Vector3 sum = Vector3::Zero(), moment = Vector3::Zero();
    for (const std::size_t i : model.particles) {
      const Vector3 at = model.kinematics == Kinematics::small
                             ? model.rest_position(i)
                             : Vector3(lattice::position(model, state, i));
      sum += force.at(i);
      moment += at.cross(force.at(i));
    }
    const double scale = size_of(model, force);
    RC_ASSERT(sum.norm() <= 1e-12 * scale);
    RC_ASSERT(moment.norm() <= 1e-12 * scale * 20.0 * model.spacing());
  });
}

bool forces_come_from_the_energy() {
  return rc::check("power against any motion is the fall of the elastic energy", [] {
    const LatticeModel model = random_block();
    State state = random_state(model, 0.0);
    const VectorField force = forces(model, state);
    VectorField motion(model.points());
    for (const std::size_t i : model.particles) motion.set(i, random_vector(1.0));
    const double h = 1e-6 * model.spacing();
    const auto energy = [&](double step) {
      State moved = state;
      for (const std::size_t i : model.particles) moved.displacement.add(i, step * motion.at(i));
      return lattice::elastic_energy(model, moved);
    };
    const double slope = (energy(h) - energy(-h)) / (2.0 * h);
    RC_ASSERT(std::abs(slope + power(model, force, motion)) <= 1e-6 * size_of(model, force));
  });
}

bool dampers_only_take_energy() {
  return rc::check("dampers never feed energy into the motion", [] {
    const LatticeModel model = random_block();
    const State moving = random_state(model, 1.0);
    State still = moving;
    for (const std::size_t i : model.particles) still.velocity.set(i, Vector3::Zero());
    const double viscous = power(model, forces(model, moving), moving.velocity) -
                           power(model, forces(model, still), moving.velocity);
    RC_ASSERT(viscous <= 1e-10 * size_of(model, forces(model, moving)));
  });
}

bool finite_models_are_objective() {
  return rc::check("turning a deformed body turns its forces", [] {
    LatticeModel model = random_block();
    model.kinematics = Kinematics::finite;
    const State state = random_state(model, 1.0);
    const Eigen::AngleAxisd turn(uniform(-3.0, 3.0),
                                 (random_vector(1.0) + Vector3(0.1, 0.2, 1.3)).normalized());
    const Vector3 spin = random_vector(5.0);
    State turned(model);
    for (const std::size_t i : model.particles) {
      const Vector3 x = turn * lattice::position(model, state, i);
      turned.displacement.set(i, x - model.rest_position(i));
      turned.velocity.set(i, turn * state.velocity.at(i) + spin.cross(x));
    }
    const VectorField before = forces(model, state), after = forces(model, turned);
    const double scale = size_of(model, before);
    for (const std::size_t i : model.particles) {
      RC_ASSERT((turn * before.at(i) - after.at(i)).norm() <= 1e-10 * scale);
    }
  });
}

}  // namespace

int main() {
  bool good = kernel_equals_edge_list();
  good = forces_balance() && good;
  good = forces_come_from_the_energy() && good;
  good = dampers_only_take_energy() && good;
  good = finite_models_are_objective() && good;
  return good ? 0 : 1;
}
