/// Contact of the true outer surface with the plane.
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/model.h"
#include "lattice/plane.h"
#include "lattice/state.h"
#include "lattice/tied_bond.h"
#include "meshes/press_protocol.h"

namespace fingertip::lattice {

/// The ties of model.outer, one-sided, with those energies that equilibrium is sought with
/// (statics/static_contact.h), so that a press slow enough ends there:
///   frictionless  ½ k min(g, 0)²     g the point's gap
///   stick         ½ k |x - anchor|²  from where the point first touched, linearly interpolated
///                                    within the step, until the plane would have to pull
///
/// Stiff ties do not dictate the time step: they act as they will be at its end, and particles take
/// forces as in TiedBond, with the ties that act at the moment, frictionless along the normal
/// alone; the plane receives what they do not. (With the gap at the step's start instead, undamped
/// rubber bounces on its ties from step to step until cells turn inside out.)
///
/// Only points near the plane are looked at in every step, the others in turn, so many per step
/// that none comes nearer unseen by more than half of what counts as near (a/2).
class TiedContact {
 public:
  /// Model must outlive it; the points must be clear of the plane.
  TiedContact(const LatticeModel& model, const Plane& plane, meshes::ContactMode mode);

  /// Adds the plane's forces to `force`, which holds the internal ones; returns their sum, the
  /// plane's on the tip [N]. `step` [s] may be 0: the ties as they are. Particles of the bond that
  /// touch as well are appended to `shared` (unless null): they get the plain forces, and the bond
  /// takes both inertias into account at once.
  meshes::Vector3 add(const State& state, double step, VectorField& force,
                      std::vector<SharedLoad>* shared = nullptr);

  double energy() const { return energy_; }  ///< of the ties at the last add() [J]
  int touching() const { return touching_; }
  /// Of the patch that the forces of the last add() act on (contact_patch) [m].
  double radius(const State& state) const;
  /// Per boundary particle of the model: 1 where a tie that acts hangs on it.
  std::vector<std::uint8_t> held() const;

 private:
  struct Point {
    std::array<std::uint32_t, 8> corners{};  ///< numbers of contact particles
    double rest_gap = 0.0;                   ///< [m]
    bool near = false;                       ///< looked at in every step
    bool anchored = false;
    double gap = 0.0;                                 ///< at the end of the last step looked at [m]
    meshes::Vector3 shift = meshes::Vector3::Zero();  ///< displacement there [m]
    meshes::Vector3 anchor = meshes::Vector3::Zero();  ///< displacement it is held at [m]
    double push = 0.0;                                 ///< along the normal, last add() [N]
  };
  struct Load {
    meshes::Vector3 force = meshes::Vector3::Zero();  ///< along the grid's axes [N]
    double stiffness = 0.0;                           ///< Σ_j |K_ij| of the ties that act [N/m]
    bool loaded = false;
  };

  void look_around(const State& state, double ahead, std::size_t looks);
  void look_at(std::size_t point, const State& state, double ahead);
  meshes::Vector3 pull(std::size_t point) const;
  void load(std::size_t point, const meshes::Vector3& pull);
  meshes::Vector3 unload(double step, VectorField& force, std::vector<SharedLoad>* shared);
  std::size_t looks_per_step(const State& state, double step) const;

  const LatticeModel* model_;
  Plane plane_;
  meshes::Vector3 normal_;  ///< along the grid's axes
  bool stick_;
  double margin_;                    ///< gap below which a point is near [m]
  std::vector<Point> points_;        ///< in the order of model.outer
  std::vector<std::uint32_t> near_;  ///< points that are near, in the order they came
  std::size_t next_look_ = 0;
  std::vector<std::uint32_t> particles_;  ///< grid index per contact particle
  std::vector<std::uint8_t> bonded_;      ///< per contact particle: 1 where the bond holds it, too
  std::vector<Load> loads_;               ///< per contact particle, zero between calls
  std::vector<std::uint32_t> loaded_;     ///< contact particles with a load
  int touching_ = 0;
  double energy_ = 0.0;
};

}  // namespace fingertip::lattice
