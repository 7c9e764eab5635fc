/// What holds the tip: its bond to the rod and its contact with the plane.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lattice/contact/contact_patch.h"
#include "lattice/contact/point_load.h"
#include "lattice/kernels/parallel.h"
#include "lattice/model/model.h"
#include "lattice/model/plane.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "meshes/press/press_protocol.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline contact {

class CutSurfaces;

/// One step of a Finger asks apply() with the forces at its start, moves the particles and asks
/// correct(). Momentum is exchanged with rod and plane only: what apply() adds to the particles'
/// forces, and what correct() changes of their velocities, is the opposite of what rod and plane
/// receive. Neither allocates. The plane is that of the step's start; it moves on at its
/// velocities. Of a part of a tip (LatticeModel::sector) wrenches, impulses, energies and counts
/// are those of the whole.
class Surfaces {
 public:
  virtual ~Surfaces() = default;
  /// With all it remembers: where points were anchored, which are near.
  virtual std::unique_ptr<Surfaces> clone() const = 0;

  /// Adds to `force`, which holds the internal forces [N] at the start of a step of length `step`
  /// [s], what rod and plane exert on the particles. Returns the bond's wrench on the rod about its
  /// endpoint. `stored` (null: not asked for) receives energy() at this start.
  virtual Wrench apply(const State& state, const RodState& rod, const Plane& plane, double step,
                       VectorField& force, double* stored) = 0;
  /// Corrects the state after the particles moved freely through the step under `force`. Returns
  /// the impulse of the plane on the tip during the step: [N s], and [N m s] about the world's
  /// origin.
  virtual Wrench correct(State& state, const VectorField& force, const Plane& plane,
                         double step) = 0;

  /// Itself where it acts by forces alone and so knows states that are only tried, and its inertia;
  /// null where it acts between steps (published).
  virtual CutSurfaces* ties() { return nullptr; }

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

/// Ligaments and anchored particles for the published model, bond and penalty contact for the
/// others. Model and team must outlive them; the finger must start clear of the plane.
std::unique_ptr<Surfaces> make_surfaces(const LatticeModel& model, const Plane& plane,
                                        const ContactLaw& law, Team& team);

}  // namespace fingertip::lattice::inline contact
