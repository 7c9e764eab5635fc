/// Bond and contact of the published model.
#pragma once

#include "lattice/contact.h"
#include "lattice/surfaces.h"

namespace fingertip::lattice {

/// Ligaments (bond.h) and boundary particles that the plane anchors (contact.h).
class ParticleSurfaces : public Surfaces {
 public:
  ParticleSurfaces(const LatticeModel& model, const Plane& plane, meshes::ContactMode mode);

  Wrench hold(const State& state, const RodState& rod, double step, VectorField& force) override;
  meshes::Vector3 settle(State& state, const VectorField& force, double step) override;
  double energy(const State& state, const RodState& rod) const override;
  int touching() const override { return contact_.anchored(); }
  double contact_radius(const State&) const override { return contact_.radius(); }
  std::vector<std::uint8_t> held() const override;

 private:
  const LatticeModel* model_;
  PlaneContact contact_;
};

}  // namespace fingertip::lattice
