#include "lattice/tied_surfaces.h"

#include "lattice/particle_surfaces.h"

namespace fingertip::lattice {

TiedSurfaces::TiedSurfaces(const LatticeModel& model, const Plane& plane, meshes::ContactMode mode,
                           Team& team)
    : model_(&model), bond_(model, team), contact_(model, plane, mode) {
  shared_.reserve(model.boundary.size());
}

Wrench TiedSurfaces::hold(const State& state, const RodState& rod, double step,
                          VectorField& force) {
  shared_.clear();
  plane_force_ = contact_.add(state, step, force, &shared_);
  const Wrench on_rod = bond_.add(state, rod, step, force, &shared_);
  for (const SharedLoad& load : shared_) plane_force_ += model_->grid.axes * load.held_back;
  return on_rod;
}

double TiedSurfaces::energy(const State& state, const RodState& rod) const {
  return bond_.energy(state, rod) + contact_.energy();
}

std::unique_ptr<Surfaces> make_surfaces(const LatticeModel& model, const Plane& plane,
                                        meshes::ContactMode mode, Team& team) {
  if (model.is_cut()) return std::make_unique<TiedSurfaces>(model, plane, mode, team);
  return std::make_unique<ParticleSurfaces>(model, plane, mode);
}

}  // namespace fingertip::lattice
