#include "lattice/particle_surfaces.h"

#include "lattice/bond.h"

namespace fingertip::lattice {

ParticleSurfaces::ParticleSurfaces(const LatticeModel& model, const Plane& plane,
                                   meshes::ContactMode mode)
    : model_(&model), contact_(model, plane, mode) {}

Wrench ParticleSurfaces::hold(const State& state, const RodState& rod, double /*step*/,
                              VectorField& force) {
  return add_ligament_forces(*model_, state, rod, force);
}

meshes::Vector3 ParticleSurfaces::settle(State& state, const VectorField& force, double step) {
  return contact_.resolve(state, force, step);
}

std::vector<std::uint8_t> ParticleSurfaces::held() const {
  std::vector<std::uint8_t> result;
  for (std::size_t b = 0; b < model_->boundary.size(); ++b) result.push_back(contact_.holds(b));
  return result;
}

double ParticleSurfaces::energy(const State& state, const RodState& rod) const {
  return ligament_energy(*model_, state, rod.pose());
}

}  // namespace fingertip::lattice
