/// Bond and contact of the published model.
#pragma once

#include "lattice/contact/contact.h"
#include "lattice/contact/contact_smoothing.h"
#include "meshes/press/contact_patch.h"
#include "meshes/press/press_response.h"

namespace fingertip::lattice::inline contact {

/// Ligaments (bond.h) and boundary particles that the plane anchors (contact.h).
class ParticleSurfaces {
 public:
  ParticleSurfaces(const LatticeModel& model, const Plane& plane, const ContactLaw& law);

  // What Surfaces have in common (surfaces.h).
  Wrench apply(const State& state, const RodState& rod, const Plane& plane, double step,
               VectorField& force, double* stored);
  Wrench correct(State& state, const VectorField& force, const Plane& plane, double step);
  double bond_energy(const State& state, const RodState& rod) const;
  double energy(const State& state, const RodState& rod) const { return bond_energy(state, rod); }
  int touching() const { return contact_.anchored(); }
  int sliding() const { return contact_.sliding(); }
  /// The pressure of particles that touch by themselves is unknown.
  meshes::ContactPatch patch() const { return {contact_.radius(), meshes::unknown}; }
  /// None: the contact acts between steps.
  std::vector<TiedPoint> points(const State&, const meshes::Vector3&) const { return {}; }
  std::vector<std::uint8_t> held() const;

 private:
  const LatticeModel* model_;
  PlaneContact contact_;
};

}  // namespace fingertip::lattice::inline contact
