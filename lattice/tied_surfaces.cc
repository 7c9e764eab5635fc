#include "lattice/tied_surfaces.h"

#include "lattice/particle_surfaces.h"

namespace fingertip::lattice {

TiedSurfaces::TiedSurfaces(const LatticeModel& model, const Plane& plane, meshes::ContactMode mode,
                           Team& team)
    : model_(&model), bond_(model, team), contact_(model, plane, mode) {}

Wrench TiedSurfaces::hold(const State& state, const RodState& rod, double step,
                          VectorField& force) {
  plane_force_ = contact_.add(state, step, force);
  return bond_.add(state, rod, step, force);
}

double TiedSurfaces::energy(const State& state, const RodState& rod) const {
  return bond_.energy(state, rod) + contact_.energy();
}

bool TiedSurfaces::holds(std::size_t boundary_number) const {
  return contact_.holds(model_->boundary[boundary_number]);
}

std::unique_ptr<Surfaces> make_surfaces(const LatticeModel& model, const Plane& plane,
                                        meshes::ContactMode mode, Team& team) {
  if (model.is_cut()) return std::make_unique<TiedSurfaces>(model, plane, mode, team);
  return std::make_unique<ParticleSurfaces>(model, plane, mode);
}

}  // namespace fingertip::lattice
