#include "tests/studies/exchange/undamped_march.h"

#include "lattice/contact/bond.h"
#include "lattice/forces/energy.h"

namespace fingertip::studies {

using meshes::Vector3;

namespace {

/// Nothing reaches it: the bodies that are marched here have no boundary that could touch.
lattice::Plane nowhere() {
  lattice::Plane plane;
  plane.point = Vector3(0.0, 0.0, 1.0);
  return plane;
}

}  // namespace

UndampedMarch::UndampedMarch(const UndampedBody& body)
    : body_(&body),
      finger_(body.model, body.rod, nowhere(), {}, lattice::Integrator::symplectic_euler, body.step,
              1) {
  finger_.state() = body.start;
  finger_.set_gravity(body.gravity);
}

/// The wall's share of a step. Forces do not depend on velocities, so it makes no difference
/// whether all are added up before the velocity is changed, apart from rounding.
void UndampedMarch::push_by_wall() {
  const lattice::LatticeModel& model = body_->model;
  lattice::State& state = finger_.state();
  for (const std::uint32_t i : model.particles) {
    const Vector3 force = body_->wall->force(lattice::position(model, state, i), time());
    if (force.isZero(0.0)) continue;
    state.velocity.add(i,
                       body_->step * model.inverse_mass[i] * (model.grid.axes.transpose() * force));
  }
}

void UndampedMarch::advance() {
  if (body_->wall) push_by_wall();
  finger_.advance(lattice::RodMotion{});
  ++steps_;
}

Energies energies(const UndampedBody& body, const lattice::State& state, double time) {
  Energies sum{lattice::kinetic_energy(body.model, state),
               lattice::elastic_energy(body.model, state) +
                   lattice::ligament_energy(body.model, state, lattice::Pose{})};
  if (body.wall) {
    for (const std::uint32_t i : body.model.particles) {
      sum.elastic += body.wall->energy(lattice::position(body.model, state, i), time);
    }
  }
  return sum;
}

OuterForces outer_forces(const UndampedBody& body, const lattice::State& state, double time) {
  OuterForces sum;
  for (const lattice::Ligament& ligament : body.model.ligaments) {
    sum.rod += ligament.stiffness *
               (lattice::position(body.model, state, ligament.particle) - ligament.rest);
  }
  if (body.wall) {
    for (const std::uint32_t i : body.model.particles) {
      sum.wall -= body.wall->force(lattice::position(body.model, state, i), time);
    }
  }
  return sum;
}

}  // namespace fingertip::studies
