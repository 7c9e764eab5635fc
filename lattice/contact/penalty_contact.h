/// Contact of the true outer surface with the plane.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "lattice/contact/contact_shape.h"
#include "lattice/contact/contact_smoothing.h"
#include "lattice/contact/tie_inertia.h"
#include "lattice/contact/tied_bond.h"
#include "lattice/kernels/contact_kernel.h"
#include "lattice/model/model.h"
#include "lattice/model/plane.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"
#include "meshes/press/contact_patch.h"
#include "meshes/press/press_protocol.h"

namespace fingertip::lattice::inline contact {

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
/// forces as in TiedBond, with the ties that act at the moment, frictionless along the normal of
/// each alone, for what is heavy along a curved surface would not slide; the plane receives what
/// they do not. (With the gap at the step's start instead, undamped
/// rubber bounces on its ties from step to step until cells turn inside out.) In the plane a tie
/// that slides counts with the share mu n/(k s) of its stiffness, s what its length would be
/// without slip. For given n its energy in a step is E(s) = ½ k s² up to s_c = mu n/k, mu n (s -
/// s_c/2) beyond; a concave function of s², so the parabola of curvature E'(s)/s that touches it at
/// s lies above it everywhere, also where the tie unloads and sticks again: what makes backward
/// Euler with block-diagonal inertia stable. A tie that slides steadily feels none of it, its force
/// is mu n.
///
/// Against an obstacle that is no plane g is that of statics/static_contact.h, told at small strain
/// at points' feet, and so is its gradient, along which the ties push.
///
/// Points of a cell hang on the same eight particles and are treated together, eight at a time
/// (contact_kernel.h); then every particle collects what the groups of its cells do to it, always
/// in the same order. Only cells with a point near the plane are looked at in every step, the
/// others in turn, so many per step that none comes nearer unseen by more than half of what counts
/// as near (a/2); those farther away let turns pass.
class PenaltyContact {
 public:
  /// Model and team must outlive it; the points must be clear of the plane. `width`: doubles per
  /// register (2, 4, 8), 0 for the widest the processor has.
  PenaltyContact(const LatticeModel& model, const Plane& plane, const ContactLaw& law, Team& team,
                 int width = 0);

  /// Adds the plane's forces to `force`, which holds the internal ones; returns their sum, the
  /// plane's on the tip [N], and their moment about the world's origin [N m]. `step` [s] may be 0:
  /// the ties as they are. Particles of the bond that touch as well are appended to `shared`
  /// (unless null): they get the plain forces, and the bond takes both inertias into account at
  /// once.
  /// `rod` carries the places of rest, at which small strain asks for an obstacle's height.
  Wrench add(const State& state, const Plane& plane, double step, VectorField& force,
             std::vector<SharedLoad>* shared = nullptr, const Pose& rod = {});

  /// As if points that are on the other side of the plane had just come there, from next to where
  /// they are. Before the first add().
  void start_at(const State& state, const Plane& plane, const Pose& rod);

  /// From now on this is a trial of `accepted`, a contact of the same finger: add() starts from
  /// what that one remembers and looks only at the points that are near to it. Cheap.
  void try_from(const PenaltyContact& accepted);

  /// The inertia against the plane that particles had in the last add() with that step [s].
  void list_inertia(double step, std::vector<ContactInertia>& ties) const;
  /// Of the plane at the end of the last step, along the grid's axes.
  meshes::Vector3 normal() const { return model_->grid.axes.transpose() * plane_.normal; }

  double energy() const { return energy_; }  ///< of the ties at the last add() [J]
  int touching() const { return touching_; }
  int sliding() const { return sliding_; }  ///< of those touching, in the last step (coulomb)
  /// That the forces of the last add() act on: seen at rest where displacements are small.
  meshes::ContactPatch patch() const;
  /// The points near the plane, with the forces of their ties at the last add(): along the world's
  /// axes, places less `travel`, that of the rod [m], or at small strain at rest.
  std::vector<TiedPoint> points(const State& state, const meshes::Vector3& travel) const;
  /// Per boundary particle of the model: 1 where a tie that acts hangs on it, 2 if all of
  /// these slide (coulomb).
  std::vector<std::uint8_t> held() const;

 private:
  kernel::ContactArrays arrays(const State& state, const Plane& now, double step, const Pose& rod);
  void stand(const kernel::ContactArrays& arrays);
  void broad_phase(const kernel::ContactArrays& arrays, std::size_t looks);
  void enter(std::uint32_t group);
  void forget_near();
  void apply_near(const kernel::ContactArrays& arrays);
  Wrench unload(const State& state, double step, VectorField& force,
                std::vector<SharedLoad>* shared);
  kernel::ContactLoad load_on(std::uint32_t particle, bool& touches) const;
  Wrench unload_portion(std::size_t portion, const State& state, double square, bool shares,
                        VectorField& force);
  void list_held(std::vector<SharedLoad>* shared);
  double closing_speed(const State& state);
  std::size_t looks_per_step(const State& state, double step);
  double distance(const Plane& plane) const;
  kernel::PatchView patch_view() const;
  meshes::ContactPatch judged(const meshes::ContactPatch& patch,
                              const kernel::PatchView& view) const;

  const LatticeModel* model_;
  Team* team_;
  const kernel::ContactKernels* kernels_;
  std::shared_ptr<const ContactShape> shape_;
  Plane plane_;  ///< as it will be at the end of the step
  ContactLaw law_;
  double margin_;                              ///< gap below which a point is near [m]
  std::vector<kernel::ContactMemory> memory_;  ///< per group
  std::vector<std::uint8_t> is_near_;          ///< per group: looked at in every step
  std::vector<std::uint32_t> near_;            ///< groups that are near, in the order they came
  std::vector<std::uint8_t> skip_count_;       ///< per group: how many it lets pass, being far
  double drift_ = 0.0;  ///< how far the plane moved but by its velocities, since all looked [m]
  std::size_t next_look_ = 0;
  bool is_trial_ = false;
  std::vector<kernel::GroupFindings> found_;   ///< per group, of the last add(); nothing if far
  std::vector<kernel::GroupLoads> loads_;      ///< per group, of those that touch
  std::vector<std::uint32_t> near_particles_;  ///< contact particles that near groups hang on
  std::vector<std::uint16_t> near_groups_;     ///< per contact particle: how many
  std::vector<double> fastest_;                ///< of fixed portions of the contact particles
  std::vector<Wrench> given_;                  ///< of fixed portions of the near particles
  struct Held {
    std::uint32_t particle = 0;                           ///< contact particle
    Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero();  ///< along the grid's axes [N/m]
  };
  struct Load {
    Held held;
    bool acts = false;
  };
  std::vector<Load> on_particle_;  ///< per near particle, of the last add()
  std::vector<Held> held_;         ///< those of them that had a load
  int touching_ = 0, sliding_ = 0;
  double energy_ = 0.0;
};

}  // namespace fingertip::lattice::inline contact
