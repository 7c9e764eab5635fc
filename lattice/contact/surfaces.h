/// What holds the tip: its bond to the rod and its contact with the plane.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "lattice/contact/contact_patch.h"
#include "lattice/contact/point_load.h"
#include "lattice/contact/tie_inertia.h"
#include "lattice/kernels/parallel.h"
#include "lattice/model/model.h"
#include "lattice/model/plane.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "meshes/geometry.h"
#include "meshes/press_protocol.h"

namespace fingertip::lattice {

/// One step of a Finger asks apply() with the forces at its start, moves the particles and asks
/// correct(). Momentum is exchanged with rod and plane only: what apply() adds to the particles'
/// forces, and what correct() changes of their velocities, is the opposite of what rod and plane
/// receive. Neither allocates. The plane is that of the step's start; it moves on at its
/// velocities.
class Surfaces {
 public:
  virtual ~Surfaces() = default;
  /// With all it remembers: where points were anchored, which are near.
  virtual std::unique_ptr<Surfaces> clone() const = 0;

  /// Adds to `force`, which holds the internal forces [N] at the start of a step of length `step`
  /// [s], what rod and plane exert on the particles. Returns the bond's wrench on the rod about its
  /// endpoint.
  virtual Wrench apply(const State& state, const RodState& rod, const Plane& plane, double step,
                       VectorField& force) = 0;
  /// Corrects the state after the particles moved freely through the step under `force`. Returns
  /// the impulse of the plane on the tip during the step: [N s], and [N m s] about the world's
  /// origin.
  virtual Wrench correct(State& state, const VectorField& force, const Plane& plane,
                         double step) = 0;

  /// Inertia against the rod in steps of `step` [s], by increasing index; empty where there is
  /// none.
  virtual std::span<const BondInertia> bond_inertia(double step) = 0;
  /// How the plane held in the last apply() with that step [s].
  virtual PlaneHold plane_hold(double step) = 0;
  /// To be told what the plane does to the tip in the end, if particles accelerate otherwise than
  /// by the forces of the last apply(): [N] and [N m] about the world's origin. It enters
  /// correct().
  virtual void set_plane_wrench(const Wrench& on_tip) = 0;

  /// What rod and plane exert at one moment.
  struct Trial {
    Wrench bond;                  ///< on the rod about its endpoint
    Wrench plane;                 ///< on the tip, about the world's origin
    double contact_energy = 0.0;  ///< where contact is elastic [J]
  };
  /// As apply() with step 0 would, but for a state that is only tried: what is remembered stays as
  /// it is. Throws std::logic_error for surfaces that act between steps (published).
  virtual Trial attempt(const State& state, const RodState& rod, const Plane& plane,
                        VectorField& force);

  virtual double bond_energy(const State& state, const RodState& rod) const = 0;  ///< [J]
  /// Of bond and, where it is elastic, contact [J].
  virtual double energy(const State& state, const RodState& rod) const = 0;
  /// How many points touch the plane.
  virtual int touching() const = 0;
  /// How many of them slide (coulomb; without friction none is said to).
  virtual int sliding() const = 0;
  /// Of the last step; zeros without contact. Its pressure is unknown (NaN) where particles touch
  /// by themselves (published).
  virtual ContactPatch patch() const = 0;
  /// What the plane does to each point that touches it; none where contact acts between steps
  /// (published).
  virtual std::vector<PointLoad> point_loads(const State& /*state*/) const { return {}; }
  /// Per boundary particle of the model: 1 where it sticks to the plane or touches it without
  /// friction, 2 where it slides (coulomb), else 0.
  virtual std::vector<std::uint8_t> held() const = 0;
};

/// Ligaments and anchored particles for the published model, tied surfaces for the others. Model
/// and team must outlive them; the finger must start clear of the plane.
std::unique_ptr<Surfaces> make_surfaces(const LatticeModel& model, const Plane& plane,
                                        const ContactLaw& law, Team& team);

}  // namespace fingertip::lattice
