/// The ligaments that hang the tip on the rod.
#pragma once

#include "lattice/model/model.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"

namespace fingertip::lattice::inline contact {

/// Adds every ligament's force to its particle and returns what they exert together on the rod,
/// about the rod's endpoint. Particle force: -k (x_p - T(X_p)) - mu (v_p - v_rod(x_p)), with
/// v_rod(x_p) the rod's velocity at the particle's place, so that rigid motion of rod and tip is
/// not damped; the rod takes the opposite force on the same line of action: force and moment
/// balance exactly.
Wrench add_ligament_forces(const LatticeModel& model, const State& state, const RodState& rod,
                           VectorField& force);

/// Sum of ½ k |x_p - T(X_p)|² [J].
double ligament_energy(const LatticeModel& model, const State& state, const Pose& rod);

}  // namespace fingertip::lattice::inline contact
