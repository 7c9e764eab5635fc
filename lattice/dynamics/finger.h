/// The dynamics of the whole finger: particles, rod, ligaments and plane, one time step at a time.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "lattice/contact/surfaces.h"
#include "lattice/dynamics/integrator.h"
#include "lattice/dynamics/scaling/mass_scaling.h"
#include "lattice/forces/forces.h"
#include "lattice/model/model.h"
#include "lattice/model/plane.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline dynamics {

/// Where a prescribed rod is at the end of a step (it does not turn).
struct RodMotion {
  meshes::Vector3 travel = meshes::Vector3::Zero();    ///< since the start [m]
  meshes::Vector3 velocity = meshes::Vector3::Zero();  ///< [m/s]
};

/// Everything of a finger that changes in time.
struct FingerMemory {
  State state;
  RodState rod;
  Plane plane;
  double time = 0.0;                             ///< [s]
  RelaxingMemory relaxing{};                     ///< noted at the start of the last step
  Wrench bond{};                                 ///< on the rod about its endpoint
  Wrench plane_impulse{};                        ///< of the last step
  CellExtremes extremes{};                       ///< at the start of the last step
  double step = 0.0;                             ///< of the steps to come [s]
  std::shared_ptr<const MassScaling> scaling{};  ///< null: plain masses
  Restraint restraint{};                         ///< of a free rod's rubber
  /// Of a free rod with scaled masses, in the last step; wrenches and accelerations of what is at
  /// the world's origin, along the grid's axes.
  struct CarryingRod {
    Vector6 acceleration = Vector6::Zero();  ///< [m/s²], [rad/s²]
    Vector6 load = Vector6::Zero();          ///< what acted on it but for the bond [N], [N m]
  };
  std::optional<CarryingRod> carrying_rod{};
  meshes::Vector3 expected_momentum = meshes::Vector3::Zero();  ///< [N s]
  bool balance_started = false;
  double momentum_defect = 0.0;
  double largest_impulse = 0.0;
};

/// Advances a finger in time. A step evaluates all forces at its start, then updates
///   symplectic Euler:  v += f/m dt,  x += v dt (new v),
///   explicit Euler:    x += v dt (old v),  v += f/m dt  (paper, Fig. 4),
/// the rod alike; other integrators (integrators/) ask for forces and say where a step ended. What
/// rod and plane exert is the surfaces' matter (surfaces.h); the plane moves on at its velocities.
/// Of a part of a tip all sums are those of the whole (LatticeModel::sector).
/// Steps allocate nothing. Not copyable; the model must outlive it.
class Finger {
  /// Of the surfaces, whichever they are.
  template <typename Question>
  auto ask(const Question& question) const {
    return std::visit(question, surfaces_);
  }

 public:
  /// `step` [s] must respect the stability bound (time_step.h); `threads` = 0 takes all cores. The
  /// finger must start clear of the plane.
  Finger(const LatticeModel& model, const RodBody& rod, const Plane& plane, const ContactLaw& law,
         Integrator integrator, double step, int threads)
      : Finger(model, rod, plane, law, integrator, step, Team(threads)) {}
  Finger(const LatticeModel& model, const RodBody& rod, const Plane& plane, const ContactLaw& law,
         Integrator integrator, double step, const Team& team);
  Finger(const Finger&) = delete;
  Finger& operator=(const Finger&) = delete;

  /// One step with `applied` acting at the rod's endpoint (world axes).
  void advance(const Wrench& applied);
  /// One step with the rod's motion prescribed.
  void advance(const RodMotion& at_end);

  /// From now on particles accelerate by this scaling, made for steps of the present length about
  /// the present state. A step of another length throws std::logic_error.
  void scale_masses(std::shared_ptr<MassScaling> scaling);

  const MassScaling* mass_scaling() const { return now_.scaling.get(); }

  /// For integrators of their own: forces at a state that is only tried, at a time not before the
  /// last start_step(); nothing changes. `force` receives all forces on the particles [N]
  /// (CutSurfaces::attempt). Throws std::logic_error for the published model, whose surfaces act
  /// between steps.
  struct Trial {
    CutSurfaces::Trial surfaces;
    CellExtremes extremes;
  };
  Trial attempt(const State& state, const RodState& rod, const Plane& plane, double time,
                VectorField& force);
  /// Forces of springs and cells alone [N].
  CellExtremes internal_forces(const State& state, double time, VectorField& force);
  /// What holds the stress of a rubber that relaxes, at the present state.
  BranchEnergy branch_energy() const {
    return internal_.branch_energy(now_.state, now_.time, now_.relaxing);
  }
  /// Takes note of the present state as one that a step starts from: anchors of the contact,
  /// bond(), extremes().
  void start_step();
  /// Ends a step of `duration` [s] after which state() and rod() have been set: `plane_impulse` as
  /// in plane_impulse(), `on_rod` the impulse on the rod but for the bond's [N s].
  void finish_step(double duration, const Wrench& plane_impulse, const meshes::Vector3& on_rod);
  long force_evaluations() const { return evaluations_; }  ///< of springs and cells, so far

  double time() const { return now_.time; }
  double step() const { return now_.step; }
  void set_step(double step) { now_.step = step; }  ///< of the steps to come [s]
  const LatticeModel& model() const { return *model_; }
  const State& state() const { return now_.state; }
  State& state() { return now_.state; }
  const RodState& rod() const { return now_.rod; }
  RodState& rod() { return now_.rod; }
  const Plane& plane() const { return now_.plane; }
  /// Moves the plane, from the next step on; contact follows it.
  void set_plane(const Plane& plane) { now_.plane = plane; }
  const meshes::Vector3& gravity() const { return gravity_; }
  /// On particles and rod [m/s²]; none at the start.
  void set_gravity(const meshes::Vector3& gravity) { gravity_ = gravity; }

  /// Points on the plane.
  int touching() const {
    return ask([](const auto& s) { return s.touching(); });
  }
  /// Of these (coulomb).
  int sliding() const {
    return ask([](const auto& s) { return s.sliding(); });
  }
  /// Whether the contact's field is known: not of a published finger.
  bool has_field() const { return model_->is_cut(); }
  /// Of live control: radius and peak of a press are those of its field.
  meshes::ContactPatch contact_patch() const {
    return ask([](const auto& s) { return s.patch(); });
  }
  /// The points near the plane, as it acted in the last step, of the part computed: along the
  /// world's axes, places as if the rod had stayed, or at small strain at rest. None of a published
  /// finger.
  std::vector<TiedPoint> tied_points() const {
    const meshes::Vector3 travel = now_.rod.endpoint() - now_.rod.body().endpoint;
    return ask([&](const auto& s) { return s.points(now_.state, travel); });
  }
  /// The field of the whole contact (contact_smoothing.h), along field_axes of the plane's normal.
  std::vector<meshes::ContactPoint> contact_field() const { return field_of(tied_points()); }
  /// The same along the world's axes, its points where they are now.
  std::vector<meshes::ContactPoint> contact_now() const;
  /// Per boundary particle of the model: 1 where it sticks to the plane or touches it without
  /// friction, 2 where it slides (coulomb), else 0.
  std::vector<std::uint8_t> held() const {
    return ask([](const auto& s) { return s.held(); });
  }
  /// Of the cells at the start of the last step.
  const CellExtremes& extremes() const { return now_.extremes; }

  /// The bond's wrench on the rod about its endpoint, at the start of the last step.
  const Wrench& bond() const { return now_.bond; }
  /// Impulse of the plane on the tip during the last step: [N s], and [N m s] about the world's
  /// origin.
  const Wrench& plane_impulse() const { return now_.plane_impulse; }
  double kinetic_energy() const;  ///< of the particles [J]
  /// Elastic energy of springs, cells and surfaces [J]; of the contact that of the last step's
  /// start.
  double elastic_energy() const;
  /// Asks the next step to note the energies of the state that it starts from: found with its
  /// forces, they cost a fraction of elastic_energy().
  void note_energy() { notes_energy_ = true; }
  /// Kinetic and elastic [J], all of the start of the last step for which they were to be noted.
  struct Energy {
    double kinetic = 0.0, elastic = 0.0;
  };
  const Energy& noted_energy() const { return noted_energy_; }
  /// [J]
  double bond_energy() const {
    return ask([&](const auto& s) { return s.bond_energy(now_.state, now_.rod); });
  }

  /// Largest defect so far of (change of momentum of particles and rod) = (applied impulse) +
  /// (plane's impulse) over a step [N s]; the momenta are summed afresh from the velocities.
  double momentum_defect() const { return now_.momentum_defect; }
  /// Largest impulse exchanged in a step so far [N s], the scale of momentum_defect().
  double largest_impulse() const { return now_.largest_impulse; }

  /// All that changes in time, so that load() of it and the same drive give the same bits again.
  struct Snapshot {
    FingerMemory memory;
    std::shared_ptr<const Surfaces> surfaces;
  };
  Snapshot save() const { return {now_, std::make_shared<const Surfaces>(surfaces_)}; }
  void load(const Snapshot& snapshot);
  /// Starts anew from another finger's moment: what is on the plane is anchored where it is. Of a
  /// finger that has not moved yet.
  void start_at(const FingerMemory& memory);

 private:
  std::vector<meshes::ContactPoint> field_of(std::vector<TiedPoint> points) const;
  void find_forces(double step);
  CutSurfaces& ties();
  Vector6 along_grid(const meshes::Vector3& force, const meshes::Vector3& torque) const;
  OuterLoads::Rod rod_load(const Wrench& applied) const;
  Vector6 expected_acceleration(const OuterLoads::Rod& rod) const;
  meshes::Vector3 move_scaled(const Wrench* applied);
  void weigh_particles(VectorField& force);
  meshes::Vector3 move_particles();
  void close_step(const meshes::Vector3& on_rod);
  void check_momentum(const meshes::Vector3& momentum);

  const LatticeModel* model_;
  Team team_;
  InternalForces internal_;
  Surfaces surfaces_;
  kernel::MoveParticles move_;
  Integrator integrator_;
  ContactLaw law_;
  double tip_mass_;  ///< [kg]
  meshes::Vector3 gravity_ = meshes::Vector3::Zero();
  FingerMemory now_;
  VectorField force_;
  std::unique_ptr<AccelerationFields> accelerations_;  ///< once masses are scaled
  long evaluations_ = 0;
  bool notes_energy_ = false;  ///< in the next step
  Energy noted_energy_;
  std::vector<meshes::Vector3> partial_momentum_;  ///< of fixed portions of the particles
};

}  // namespace fingertip::lattice::inline dynamics
