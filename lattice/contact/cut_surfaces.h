/// Bond and contact on the tip's true surfaces.
#pragma once

#include <optional>
#include <span>

#include "lattice/contact/penalty_contact.h"
#include "lattice/contact/tie_inertia.h"
#include "lattice/contact/tied_bond.h"

namespace fingertip::lattice::inline contact {

/// Tied bond to the rod (tied_bond.h) and penalty contact with the plane (penalty_contact.h).
class CutSurfaces {
 public:
  CutSurfaces(const LatticeModel& model, const Plane& plane, const ContactLaw& law, Team& team);

  // What Surfaces have in common (surfaces.h).
  Wrench apply(const State& state, const RodState& rod, const Plane& plane, double step,
               VectorField& force, double* stored);
  Wrench correct(State&, const VectorField&, const Plane&, double step) {
    return {step * on_tip_.force, step * on_tip_.torque};
  }
  double bond_energy(const State& state, const RodState& rod) const {
    return parts() * bond_.energy(state, rod);
  }
  double energy(const State& state, const RodState& rod) const;
  int touching() const { return parts() * contact_.touching(); }
  int sliding() const { return parts() * contact_.sliding(); }
  meshes::ContactPatch patch() const { return contact_.patch(); }
  std::vector<TiedPoint> points(const State& state, const meshes::Vector3& travel) const {
    return contact_.points(state, travel);
  }
  std::vector<std::uint8_t> held() const { return contact_.held(); }

  /// As PenaltyContact::start_at.
  void start_at(const State& state, const Plane& plane, const Pose& rod) {
    contact_.start_at(state, plane, rod);
  }

  /// Inertia against the rod in steps of `step` [s], by increasing index.
  std::span<const BondInertia> bond_inertia(double step);
  /// How the plane held in the last apply() with that step [s].
  PlaneHold plane_hold(double step);
  /// To be told what the plane does to the tip in the end, if particles accelerate otherwise than
  /// by the forces of the last apply(): [N] and [N m] about the world's origin. It enters
  /// correct().
  void set_plane_wrench(const Wrench& on_tip) { on_tip_ = on_tip; }

  /// What rod and plane exert at one moment.
  struct Trial {
    Wrench bond;                  ///< on the rod about its endpoint
    Wrench plane;                 ///< on the tip, about the world's origin
    double contact_energy = 0.0;  ///< [J]
  };
  /// As apply() with step 0 would, but for a state that is only tried: what is remembered stays as
  /// it is.
  Trial attempt(const State& state, const RodState& rod, const Plane& plane, VectorField& force);

 private:
  int parts() const { return model_->sector.count(); }
  Wrench hold_with(PenaltyContact& contact, const State& state, const RodState& rod,
                   const Plane& plane, double step, VectorField& force, Wrench& on_tip,
                   double* stored = nullptr);

  const LatticeModel* model_;
  TiedBond bond_;
  PenaltyContact contact_;
  std::optional<PenaltyContact> trial_;  ///< contact_ as attempt() needs it, made by the first one
  std::vector<BondInertia> bond_inertia_;      ///< of the last bond_inertia()
  std::vector<ContactInertia> plane_inertia_;  ///< of the last plane_hold()
  std::vector<SharedLoad> shared_;             ///< particles on both surfaces
  Wrench on_tip_;                              ///< of the plane, about the world's origin
};

}  // namespace fingertip::lattice::inline contact
