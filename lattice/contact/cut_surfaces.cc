#include "lattice/contact/cut_surfaces.h"

namespace fingertip::lattice::inline contact {

CutSurfaces::CutSurfaces(const LatticeModel& model, const Plane& plane, const ContactLaw& law,
                         Team& team)
    : model_(&model), bond_(model, team), contact_(model, plane, law, team) {
  shared_.reserve(model.boundary.size());
  bond_inertia_.reserve(8 * model.bond.size());
  plane_inertia_.reserve(model.particles.size());
}

Wrench CutSurfaces::apply(const State& state, const RodState& rod, const Plane& plane, double step,
                          VectorField& force, double* stored) {
  return hold_with(contact_, state, rod, plane, step, force, on_tip_, stored);
}

CutSurfaces::Trial CutSurfaces::attempt(const State& state, const RodState& rod, const Plane& plane,
                                        VectorField& force) {
  if (!trial_) trial_ = contact_;
  trial_->try_from(contact_);
  Trial trial;
  trial.bond = hold_with(*trial_, state, rod, plane, 0.0, force, trial.plane);
  trial.contact_energy = parts() * trial_->energy();
  return trial;
}

Wrench CutSurfaces::hold_with(PenaltyContact& contact, const State& state, const RodState& rod,
                              const Plane& plane, double step, VectorField& force, Wrench& on_tip,
                              double* stored) {
  shared_.clear();
  on_tip = contact.add(state, plane, step, force, &shared_, rod.pose());
  const Wrench on_rod = bond_.add(state, rod, step, force, &shared_, stored);
  if (stored != nullptr) *stored = parts() * (*stored + contact.energy());
  for (const SharedLoad& load : shared_) {
    const meshes::Vector3 held_back = model_->grid.axes * load.held_back;
    on_tip.force += held_back;
    on_tip.torque += position(*model_, state, load.particle).cross(held_back);
  }
  on_tip = model_->sector.whole(on_tip);
  return model_->sector.whole(on_rod);
}

std::span<const BondInertia> CutSurfaces::bond_inertia(double step) {
  bond_.list_inertia(step, bond_inertia_);
  return bond_inertia_;
}

PlaneHold CutSurfaces::plane_hold(double step) {
  contact_.list_inertia(step, plane_inertia_);
  const Eigen::Matrix3d to_grid = model_->grid.axes.transpose();
  return {plane_inertia_, contact_.normal(), {to_grid * on_tip_.force, to_grid * on_tip_.torque}};
}

double CutSurfaces::energy(const State& state, const RodState& rod) const {
  return bond_energy(state, rod) + parts() * contact_.energy();
}

}  // namespace fingertip::lattice::inline contact
