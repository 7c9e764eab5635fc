/// Coarse fingers behind the control interface, and what tests ask of them.
#pragma once

#include "lattice/control/virtual_finger.h"
#include "tests/lattice/fixtures.h"

namespace fixtures {

/// A hookean tip at R/5 above a plane `clearance` below its pole.
inline lattice::FingerSetup coarse_finger(double clearance) {
  lattice::FingerSetup setup;
  setup.lattice = settings_for(lattice::ModelKind::hookean, lattice::Kinematics::small, 5);
  setup.plane.point = Vector3(0.0, 0.0, setup.geometry.tip_radius + clearance);
  setup.threads = 1;
  return setup;
}

/// What to press, for tests that try many.
struct PressCase {
  lattice::ModelKind model;
  lattice::Kinematics kinematics;
  meshes::ContactMode contact;
  lattice::Integrator integrator;
};

/// At R/6, 10 um clear of the plane, with weight; its rod is to be moved (advancing()).
inline lattice::FingerSetup prescribed_finger(const PressCase& c, int threads) {
  lattice::FingerSetup setup;
  setup.lattice = settings_for(c.model, c.kinematics, 6);
  setup.plane = {Vector3(0.0, 0.0, setup.geometry.tip_radius + 1e-5), -Vector3::UnitZ()};
  setup.contact = {c.contact, 0.3};
  setup.integrator = c.integrator;
  setup.gravity = Vector3(0.0, 0.0, -9.81);
  setup.prescribed = true;
  setup.threads = threads;
  return setup;
}

/// The same without weight and with a free rod, which is to be pushed.
inline lattice::FingerSetup pushed_finger(const PressCase& c, int threads) {
  lattice::FingerSetup setup = prescribed_finger(c, threads);
  setup.gravity = Vector3::Zero();
  setup.prescribed = false;
  return setup;
}

/// Towards the plane at `speed` [m/s].
inline auto advancing(double speed) {
  return [speed](double time) {
    return lattice::RodMotion{Vector3(0.0, 0.0, speed * time), Vector3(0.0, 0.0, speed)};
  };
}

/// Of particles and rod [N s].
inline Vector3 momentum(const lattice::VirtualFinger& finger) {
  Vector3 sum = finger.finger().rod().momentum();
  for (const std::uint32_t i : finger.model().particles) {
    sum += finger.model().mass[i] *
           (finger.model().grid.axes * finger.finger().state().velocity.at(i));
  }
  return sum;
}

/// Of particles and rod about the world's origin [N m s].
inline Vector3 angular_momentum(const lattice::VirtualFinger& finger) {
  const lattice::RodState& rod = finger.finger().rod();
  const lattice::LatticeModel& model = finger.model();
  Vector3 sum = rod.angular_momentum() + rod.centre().cross(rod.momentum());
  for (const std::uint32_t i : model.particles) {
    const Vector3 velocity = model.grid.axes * finger.finger().state().velocity.at(i);
    sum += lattice::position(model, finger.finger().state(), i).cross(model.mass[i] * velocity);
  }
  return sum;
}

/// Whether two fingers are in the same state to the last bit.
inline bool same_bits(const lattice::VirtualFinger& a, const lattice::VirtualFinger& b) {
  const lattice::RodState &first = a.finger().rod(), &second = b.finger().rod();
  return a.time() == b.time() &&
         a.finger().state().displacement.component == b.finger().state().displacement.component &&
         a.finger().state().velocity.component == b.finger().state().velocity.component &&
         first.centre() == second.centre() && first.momentum() == second.momentum() &&
         first.pose().orientation.coeffs() == second.pose().orientation.coeffs() &&
         first.angular_momentum() == second.angular_momentum() &&
         a.finger().bond().force == b.finger().bond().force &&
         a.finger().touching() == b.finger().touching() && a.finger().step() == b.finger().step();
}

}  // namespace fixtures
