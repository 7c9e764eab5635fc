/// Bond and contact of the published model.
#pragma once

#include "lattice/contact/contact.h"
#include "lattice/contact/surfaces.h"
#include "meshes/press/press_response.h"

namespace fingertip::lattice::inline contact {

/// Ligaments (bond.h) and boundary particles that the plane anchors (contact.h).
class ParticleSurfaces : public Surfaces {
 public:
  ParticleSurfaces(const LatticeModel& model, const Plane& plane, const ContactLaw& law);

  std::unique_ptr<Surfaces> clone() const override {
    return std::make_unique<ParticleSurfaces>(*this);
  }
  Wrench apply(const State& state, const RodState& rod, const Plane& plane, double step,
               VectorField& force, double* stored) override;
  Wrench correct(State& state, const VectorField& force, const Plane& plane, double step) override;
  double bond_energy(const State& state, const RodState& rod) const override;
  double energy(const State& state, const RodState& rod) const override {
    return bond_energy(state, rod);
  }
  int touching() const override { return contact_.anchored(); }
  int sliding() const override { return contact_.sliding(); }
  ContactPatch patch() const override { return {contact_.radius(), meshes::unknown}; }
  std::vector<std::uint8_t> held() const override;

 private:
  const LatticeModel* model_;
  PlaneContact contact_;
};

}  // namespace fingertip::lattice::inline contact
