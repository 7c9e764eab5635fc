/// Bond and contact on the tip's true surfaces.
#pragma once

#include "lattice/surfaces.h"
#include "lattice/tied_bond.h"
#include "lattice/tied_contact.h"

namespace fingertip::lattice {

/// Elastic ties to the rod (tied_bond.h) and to the plane (tied_contact.h).
class TiedSurfaces : public Surfaces {
 public:
  TiedSurfaces(const LatticeModel& model, const Plane& plane, meshes::ContactMode mode, Team& team);

  Wrench hold(const State& state, const RodState& rod, double step, VectorField& force) override;
  meshes::Vector3 settle(State&, const VectorField&, double step) override {
    return step * plane_force_;
  }
  double energy(const State& state, const RodState& rod) const override;
  int touching() const override { return contact_.touching(); }
  double contact_radius(const State& state) const override { return contact_.radius(state); }
  std::vector<std::uint8_t> held() const override { return contact_.held(); }

 private:
  const LatticeModel* model_;
  TiedBond bond_;
  TiedContact contact_;
  std::vector<SharedLoad> shared_;                         ///< particles on both surfaces
  meshes::Vector3 plane_force_ = meshes::Vector3::Zero();  ///< on the tip [N]
};

}  // namespace fingertip::lattice
