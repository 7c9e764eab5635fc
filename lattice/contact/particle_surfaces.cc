#include "lattice/contact/particle_surfaces.h"

#include "lattice/contact/bond.h"

namespace fingertip::lattice::inline contact {

ParticleSurfaces::ParticleSurfaces(const LatticeModel& model, const Plane& plane,
                                   const ContactLaw& law)
    : model_(&model), contact_(model, plane, law) {}

Wrench ParticleSurfaces::apply(const State& state, const RodState& rod, const Plane& /*plane*/,
                               double /*step*/, VectorField& force, double* stored) {
  if (stored != nullptr) *stored = bond_energy(state, rod);
  return model_->sector.whole(add_ligament_forces(*model_, state, rod, force));
}

Wrench ParticleSurfaces::correct(State& state, const VectorField& force, const Plane& plane,
                                 double step) {
  return model_->sector.whole(contact_.resolve(state, force, plane, step));
}

std::vector<std::uint8_t> ParticleSurfaces::held() const {
  std::vector<std::uint8_t> result;
  for (std::size_t b = 0; b < model_->boundary.size(); ++b) {
    result.push_back(contact_.slides(b) ? 2 : contact_.holds(b));
  }
  return result;
}

double ParticleSurfaces::bond_energy(const State& state, const RodState& rod) const {
  return model_->sector.count() * ligament_energy(*model_, state, rod.pose());
}

}  // namespace fingertip::lattice::inline contact
