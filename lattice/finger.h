/// The dynamics of the whole finger: particles, rod, ligaments and plane, one time step at a time.
#pragma once

#include <memory>
#include <vector>

#include "lattice/forces.h"
#include "lattice/model.h"
#include "lattice/parallel.h"
#include "lattice/plane.h"
#include "lattice/rod.h"
#include "lattice/settings.h"
#include "lattice/state.h"
#include "lattice/surfaces.h"

namespace fingertip::lattice {

/// Where a prescribed rod is at the end of a step (it does not turn).
struct RodMotion {
  meshes::Vector3 travel = meshes::Vector3::Zero();    ///< since the start [m]
  meshes::Vector3 velocity = meshes::Vector3::Zero();  ///< [m/s]
};

/// Advances a finger in time. A step evaluates all forces at its start, then updates
///   symplectic Euler:  v += f/m dt,  x += v dt (new v),
///   explicit Euler:    x += v dt (old v),  v += f/m dt  (paper, Fig. 4),
/// the rod alike. What rod and plane exert is the surfaces' matter (surfaces.h).
/// Steps allocate nothing. Not copyable; the model must outlive it.
class Finger {
 public:
  /// `step` [s] must respect the stability bound (time_step.h); `threads` = 0 takes all cores. The
  /// finger must start clear of the plane.
  Finger(const LatticeModel& model, const RodBody& rod, const Plane& plane,
         meshes::ContactMode contact, Integrator integrator, double step, int threads);
  Finger(const Finger&) = delete;
  Finger& operator=(const Finger&) = delete;

  /// One step with `applied` acting at the rod's endpoint (world axes).
  void advance(const Wrench& applied);
  /// One step with the rod's motion prescribed.
  void advance(const RodMotion& at_end);

  double time() const { return time_; }
  double step() const { return step_; }
  void set_step(double step) { step_ = step; }  ///< of the steps to come [s]
  const LatticeModel& model() const { return *model_; }
  const State& state() const { return state_; }
  State& state() { return state_; }
  const RodState& rod() const { return rod_; }
  RodState& rod() { return rod_; }
  int touching() const { return surfaces_->touching(); }  ///< points on the plane
  double contact_radius() const { return surfaces_->contact_radius(state_); }  ///< [m]
  /// Per boundary particle of the model: 1 where the plane holds it.
  std::vector<std::uint8_t> held() const { return surfaces_->held(); }
  /// Of the cells at the start of the last step.
  const CellExtremes& extremes() const { return extremes_; }

  /// The bond's wrench on the rod about its endpoint, at the start of the last step.
  const Wrench& bond() const { return bond_; }
  /// Impulse of the plane on the tip during the last step [N s].
  const meshes::Vector3& plane_impulse() const { return plane_impulse_; }
  /// Elastic energy of springs, cells and surfaces [J].
  double elastic_energy() const;

  /// Largest defect so far of (change of momentum of particles and rod) = (applied impulse) +
  /// (plane's impulse) over a step [N s]; the momenta are summed afresh from the velocities.
  double momentum_defect() const { return momentum_defect_; }
  /// Largest impulse exchanged in a step so far [N s], the scale of momentum_defect().
  double largest_impulse() const { return largest_impulse_; }

 private:
  void find_forces();
  void move_particles();
  void close_step(const meshes::Vector3& applied_impulse);
  void check_momentum(const meshes::Vector3& momentum);

  const LatticeModel* model_;
  Team team_;
  InternalForces internal_;
  std::unique_ptr<Surfaces> surfaces_;
  kernel::MoveParticles move_;
  Integrator integrator_;
  double step_ = 0.0;
  double time_ = 0.0;
  State state_;
  VectorField force_;
  RodState rod_;
  Wrench bond_;
  CellExtremes extremes_;
  meshes::Vector3 plane_impulse_ = meshes::Vector3::Zero();
  std::vector<meshes::Vector3> partial_momentum_;  ///< of fixed portions of the particles
  meshes::Vector3 expected_momentum_ = meshes::Vector3::Zero();
  bool balance_started_ = false;
  double momentum_defect_ = 0.0;
  double largest_impulse_ = 0.0;
};

}  // namespace fingertip::lattice
