/// What holds the tip: its bond to the rod and its contact with the plane.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lattice/model.h"
#include "lattice/parallel.h"
#include "lattice/plane.h"
#include "lattice/rod.h"
#include "lattice/state.h"
#include "meshes/geometry.h"
#include "meshes/press_protocol.h"

namespace fingertip::lattice {

/// One step of a Finger asks hold() with the forces at its start, moves the particles and asks
/// settle(). Momentum is exchanged with rod and plane only: what hold() adds to the particles'
/// forces, and what settle() changes of their velocities, is the opposite of what rod and plane
/// receive. Neither allocates.
class Surfaces {
 public:
  virtual ~Surfaces() = default;

  /// Adds to `force`, which holds the internal forces [N] at the start of a step of length `step`
  /// [s], what rod and plane exert on the particles. Returns the bond's wrench on the rod about its
  /// endpoint.
  virtual Wrench hold(const State& state, const RodState& rod, double step, VectorField& force) = 0;
  /// Corrects the state after the particles moved freely through the step under `force`. Returns
  /// the impulse of the plane on the tip during the step [N s].
  virtual meshes::Vector3 settle(State& state, const VectorField& force, double step) = 0;

  /// Of bond and, where it is elastic, contact [J].
  virtual double energy(const State& state, const RodState& rod) const = 0;
  /// How many points touch the plane.
  virtual int touching() const = 0;
  virtual double contact_radius(const State& state) const = 0;  ///< [m], 0 without contact
  /// Per boundary particle of the model: 1 where the plane holds it.
  virtual std::vector<std::uint8_t> held() const = 0;
};

/// Ligaments and anchored particles for the published model, tied surfaces for the others. Model
/// and team must outlive them; the finger must start clear of the plane.
std::unique_ptr<Surfaces> make_surfaces(const LatticeModel& model, const Plane& plane,
                                        meshes::ContactMode mode, Team& team);

}  // namespace fingertip::lattice
