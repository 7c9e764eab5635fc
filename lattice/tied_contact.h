/// Contact of the true outer surface with the plane.
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/model.h"
#include "lattice/plane.h"
#include "lattice/point_load.h"
#include "lattice/state.h"
#include "lattice/tied_bond.h"
#include "meshes/press_protocol.h"

namespace fingertip::lattice {

/// The ties of model.outer, one-sided, with those energies that equilibrium is sought with
/// (statics/static_contact.h), so that a press slow enough ends there:
///   frictionless  ½ k min(g, 0)²     g the point's gap
///   stick         ½ k |x - anchor|²  from where the point first touched, linearly interpolated
///                                    within the step, until the plane would have to pull; the
///                                    anchor moves with the plane
///   coulomb       as stick while the tie's force t in the plane is at most mu times that along the
///                 normal, n = -k g; else |t| = mu n. What the tie would be longer than mu n/k the
///                 anchor is dragged behind: elastic-plastic slip by return mapping (Simo & Hughes,
///                 Computational Inelasticity, 1998, ch. 2). The anchor of the next step follows
///                 from where the point was at the end of the last one, not from where it was
///                 expected to be: guesses would add up to slip.
///
/// Stiff ties do not dictate the time step: they act as they will be at its end, and particles take
/// forces as in TiedBond, with the ties that act at the moment, frictionless along the normal
/// alone; the plane receives what they do not. (With the gap at the step's start instead, undamped
/// rubber bounces on its ties from step to step until cells turn inside out.) In the plane a tie
/// that slides counts with the share mu n/(k s) of its stiffness, s what its length would be
/// without slip. For given n its energy in a step is E(s) = ½ k s² up to s_c = mu n/k, mu n (s -
/// s_c/2) beyond; a concave function of s², so the parabola of curvature E'(s)/s that touches it at
/// s lies above it everywhere, also where the tie unloads and sticks again: what makes backward
/// Euler with diagonal inertia stable. A tie that slides steadily feels none of it, its force is mu
/// n.
///
/// Only points near the plane are looked at in every step, the others in turn, so many per step
/// that none comes nearer unseen by more than half of what counts as near (a/2).
class TiedContact {
 public:
  /// Model must outlive it; the points must be clear of the plane.
  TiedContact(const LatticeModel& model, const Plane& plane, const ContactLaw& law);

  /// Adds the plane's forces to `force`, which holds the internal ones; returns their sum, the
  /// plane's on the tip [N], and their moment about the world's origin [N m]. `step` [s] may be 0:
  /// the ties as they are. Particles of the bond that touch as well are appended to `shared`
  /// (unless null): they get the plain forces, and the bond takes both inertias into account at
  /// once.
  Wrench add(const State& state, const Plane& plane, double step, VectorField& force,
             std::vector<SharedLoad>* shared = nullptr);

  /// From now on this is a trial of `accepted`, a contact of the same finger: add() starts from
  /// what that one remembers and looks only at the points that are near to it. Cheap.
  void try_from(const TiedContact& accepted);

  /// Adds the inertia against the plane that particles had in the last add() with that step [s].
  /// `ties` starts with those of the bond, by increasing index.
  void add_inertia(double step, std::vector<TieInertia>& ties) const;

  double energy() const { return energy_; }  ///< of the ties at the last add() [J]
  int touching() const { return touching_; }
  int sliding() const { return sliding_; }  ///< of those touching, in the last step (coulomb)
  /// Of the patch that the forces of the last add() act on (contact_patch) [m].
  double radius(const State& state) const;
  /// What each tie that acts does to the tip, at the last add().
  std::vector<PointLoad> point_loads(const State& state) const;
  /// Per boundary particle of the model: 1 where a tie that acts hangs on it, 2 if all of
  /// these slide (coulomb).
  std::vector<std::uint8_t> held() const;

 private:
  struct Point {
    std::array<std::uint32_t, 8> corners{};  ///< numbers of contact particles
    bool near = false;                       ///< looked at in every step
    bool anchored = false;
    bool sliding = false;                             ///< slipped in the last step (coulomb)
    double gap = 0.0;                                 ///< at the end of the last step looked at [m]
    meshes::Vector3 place = meshes::Vector3::Zero();  ///< there, relative to the plane (fixed) [m]
    meshes::Vector3 anchor = meshes::Vector3::Zero();  ///< where it is held, likewise [m]
    meshes::Vector3 force = meshes::Vector3::Zero();   ///< world axes, last add() [N]
  };
  /// What a tie does: its force on the tip along the grid's axes [N] and how much of its stiffness
  /// acts in the plane, 0 to 1.
  struct Pull {
    meshes::Vector3 force = meshes::Vector3::Zero();
    double aside = 1.0;
  };
  struct Load {
    meshes::Vector3 force = meshes::Vector3::Zero();  ///< along the grid's axes [N]
    double stiffness = 0.0;  ///< Σ_j |K_ij| of the ties that act, along the normal [N/m]
    double aside = 0.0;      ///< and in the plane
    bool loaded = false;
  };

  meshes::Vector3 place_of(std::size_t point, const State& state, double ahead) const;
  void look_around(const State& state, double ahead, std::size_t looks);
  void look_at(std::size_t point, const State& state, double ahead);
  void drag_anchor(std::size_t point, const State& state, const Plane& now);
  Pull pull(std::size_t point) const;
  double push(std::size_t point) const;
  void load(std::size_t point, const Pull& pull);
  Wrench unload(const State& state, double step, VectorField& force,
                std::vector<SharedLoad>* shared);
  std::size_t looks_per_step(const State& state, double step) const;

  const LatticeModel* model_;
  Plane plane_;  ///< as it will be at the end of the step
  ContactLaw law_;
  double margin_;                    ///< gap below which a point is near [m]
  std::vector<Point> points_;        ///< in the order of model.outer
  std::vector<std::uint32_t> near_;  ///< points that are near, in the order they came
  std::size_t next_look_ = 0;
  bool is_trial_ = false;
  std::vector<std::uint32_t> particles_;  ///< grid index per contact particle
  std::vector<std::uint8_t> bonded_;      ///< per contact particle: 1 where the bond holds it, too
  std::vector<Load> loads_;               ///< per contact particle, zero between calls
  std::vector<std::uint32_t> loaded_;     ///< contact particles with a load
  struct Held {
    std::uint32_t particle = 0;  ///< contact particle
    double stiffness = 0.0, aside = 0.0;
  };
  std::vector<Held> held_;  ///< those that had one in the last add()
  int touching_ = 0, sliding_ = 0;
  double energy_ = 0.0;
};

}  // namespace fingertip::lattice
