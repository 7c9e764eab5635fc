#include "lattice/dynamics/integrators/energy_balance.h"

#include "lattice/forces/energy.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

using meshes::Vector3;

EnergyBalance::EnergyBalance(Finger& finger)
    : finger_(&finger),
      force_(finger.model().points()),
      undamped_(finger.model().points()),
      still_(finger.model()) {}

/// v·(f(u, 0) - f(u, v)) of the internal forces [W], without what branches lose.
double EnergyBalance::dissipation(const State& state) {
  const LatticeModel& model = finger_->model();
  if (model.retardation_time == 0.0 &&
      !(model.damping[0] + model.damping[1] + model.damping[2] > 0.0))
    return 0.0;
  still_.displacement = state.displacement;
  finger_->internal_forces(state, finger_->time(), force_);
  finger_->internal_forces(still_, finger_->time(), undamped_);
  double sum = 0.0;
  for (const std::uint32_t i : model.particles) {
    sum += state.velocity.at(i).dot(undamped_.at(i) - force_.at(i));
  }
  return model.sector.count() * sum;
}

EnergyInstant EnergyBalance::measure(bool prescribed) {
  const State& state = finger_->state();
  const RodState& rod = finger_->rod();
  const LatticeModel& model = finger_->model();
  const Plane& plane = finger_->plane();
  EnergyInstant now;
  const BranchEnergy branches = finger_->branch_energy();
  now.dissipation = dissipation(state) + branches.dissipation;
  const Finger::Trial trial = finger_->attempt(state, rod, plane, finger_->time(), force_);
  now.kinetic = finger_->kinetic_energy() + (prescribed ? 0.0 : rod.kinetic_energy());
  now.stored = lattice::elastic_energy(model, state) + branches.stored + finger_->bond_energy() +
               trial.surfaces.contact_energy;
  now.endpoint = rod.endpoint();
  now.spin = rod.angular_velocity();
  const Vector3& gravity = finger_->gravity();
  if (!gravity.isZero(0.0)) {
    Vector3 moment = Vector3::Zero();
    for (const std::uint32_t i : model.particles) {
      moment += model.mass[i] * (model.grid.axes * state.displacement.at(i));
    }
    moment = model.sector.whole(moment);
    if (!prescribed) moment += rod.body().mass * rod.centre();
    now.weight = -gravity.dot(moment);
  }
  const Wrench& by_plane = trial.surfaces.plane;
  now.plane_power = by_plane.force.dot(plane.velocity) +
                    plane.angular_velocity.dot(by_plane.torque - plane.point.cross(by_plane.force));
  if (prescribed) {
    const Wrench& bond = trial.surfaces.bond;
    now.rod_power = -bond.force.dot(rod.velocity_at(now.endpoint)) - bond.torque.dot(now.spin);
  }
  return now;
}

double EnergyBalance::drift(const EnergyInstant& from, const EnergyInstant& to, double duration,
                            const Drive& drive) {
  const auto integral = [duration](double a, double b) { return 0.5 * duration * (a + b); };
  double work = integral(from.plane_power, to.plane_power);
  if (const Wrench* wrench = std::get_if<Wrench>(&drive)) {
    work += wrench->force.dot(to.endpoint - from.endpoint) +
            integral(wrench->torque.dot(from.spin), wrench->torque.dot(to.spin));
  } else {
    work += integral(from.rod_power, to.rod_power);
  }
  return to.kinetic - from.kinetic + to.stored - from.stored + to.weight - from.weight +
         integral(from.dissipation, to.dissipation) - work;
}

}  // namespace fingertip::lattice::inline dynamics::inline integrators
