/// What holds the tip: its bond to the rod and its contact with the plane.
#pragma once

#include <variant>

#include "lattice/contact/cut_surfaces.h"
#include "lattice/contact/particle_surfaces.h"

namespace fingertip::lattice::inline contact {

/// Ligaments and anchored particles for the published model, which act between steps; bond and
/// penalty contact for the others, which act by forces alone and so know states that are only
/// tried, and their inertia (CutSurfaces::attempt, bond_inertia). A copy remembers all that the
/// original does: where points were anchored, which are near. Both have
///
///   apply         adds to `force`, which holds the internal forces [N] at the start of a step of
///                 length `step` [s], what rod and plane exert on the particles. Returns the bond's
///                 wrench on the rod about its endpoint. `stored` (null: not asked for) receives
///                 energy() at this start
///   correct       corrects the state after the particles moved freely through the step under
///                 `force`. Returns the impulse of the plane on the tip during the step: [N s], and
///                 [N m s] about the world's origin
///   bond_energy, energy      of the bond; of it and, where it is elastic, the contact [J]
///   touching, sliding        how many points touch the plane; of these slide (coulomb)
///   patch         of the last step; zeros without contact
///   points        what the plane does to each point near it
///   held          per boundary particle of the model: 1 where it sticks to the plane or touches it
///                 without friction, 2 where it slides (coulomb), else 0
///
/// Momentum is exchanged with rod and plane only: what apply() adds to the particles' forces, and
/// what correct() changes of their velocities, is the opposite of what rod and plane receive.
/// Neither allocates. The plane is that of the step's start; it moves on at its velocities. Of a
/// part of a tip (LatticeModel::sector) wrenches, impulses, energies and counts are those of the
/// whole.
using Surfaces = std::variant<ParticleSurfaces, CutSurfaces>;

/// Model and team must outlive them; the finger must start clear of the plane.
inline Surfaces make_surfaces(const LatticeModel& model, const Plane& plane, const ContactLaw& law,
                              Team& team) {
  if (model.is_cut()) return CutSurfaces(model, plane, law, team);
  return ParticleSurfaces(model, plane, law);
}

}  // namespace fingertip::lattice::inline contact
