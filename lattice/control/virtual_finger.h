/// The finger behind the virtual control interface: what the robot's hardware would be.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <variant>

#include "lattice/control/controller.h"
#include "lattice/dynamics/finger.h"
#include "lattice/dynamics/integrator.h"
#include "lattice/dynamics/integrators/stepper.h"
#include "lattice/dynamics/time_step.h"
#include "lattice/model/lattice_settings.h"

namespace fingertip::lattice::inline control {

/// Specimen, lattice and surroundings of one finger.
struct FingerSetup {
  meshes::Geometry geometry;
  meshes::Rubber rubber;
  LatticeSettings lattice;
  RodSettings rod;
  ContactLaw contact;
  Plane plane;                                        ///< clear of the tip
  meshes::Vector3 gravity = meshes::Vector3::Zero();  ///< [m/s²]
  meshes::TaxelSkin skin;                             ///< that read() tells
  bool prescribed = false;  ///< the rod moves as it is told (RodMotion), whatever pulls at it
  Integrator integrator = Integrator::symplectic_euler;
  std::optional<double> time_step;  ///< largest one [s]; the largest safe one when absent
  double tolerance = 1e-6;          ///< of Integrator::runge_kutta
  double energy_bound = 1e-7;       ///< of Integrator::energy_controlled, per E R³
  int threads = 0;                  ///< 0: fastest_threads. The result does not depend on it.
  /// 4, 2 or 1: computes one of so many parts that are each other's mirror images, for grids that
  /// divide so (grid_symmetry). The rod then keeps to their planes, whatever acts on it.
  int sectors = 1;
};

/// A co-simulation slave in the sense of FMI 3.0: write() sets inputs that hold until the next
/// write, do_step() advances by one communication step and may return early, read() tells the
/// outputs at the present communication point; save() and load() are get/setFMUState, reset() is
/// fmi3Reset. With a fixed communication step, read-command-write-do_step is ros2_control's cycle
/// of read(), update() and write() on a hardware component.
class VirtualFinger {
 public:
  /// Called after every integration step; false ends do_step() there.
  using StepObserver = std::function<bool()>;
  using Motion = lattice::Motion;

  /// Throws InvalidInput for a time step above the stability bound and for what cannot be built.
  explicit VirtualFinger(const FingerSetup& setup);
  VirtualFinger(const VirtualFinger&) = delete;
  VirtualFinger& operator=(const VirtualFinger&) = delete;

  Measurement read() const;
  /// The wrench at the rod's endpoint from now on (world axes).
  void write(const Wrench& applied);
  /// The rod's motion from now on; for a prescribed finger.
  void write(Motion motion);
  /// Moves the plane from now on (Plane::velocity, angular_velocity); it must not jump.
  void move_plane(const Plane& plane) { finger_->set_plane(plane); }

  /// Advances by `duration` [s] > 0, in steps that the integrator chooses. Returns
  /// whether it got there. Throws CrushedCells.
  bool do_step(double duration, const StepObserver& after_step = {});

  struct Snapshot {
    Finger::Snapshot finger;
    StepController::Memory steps;
    Stepper::Memory stepper{};
    Drive drive;  ///< the inputs
  };
  Snapshot save() const;
  void load(const Snapshot& snapshot);
  void reset() { load(start_); }  ///< as it was built
  /// Goes on where `other` is, a finger of the same specimen and surroundings with another lattice;
  /// `state`: of the particles of this one, which has not moved yet. Points that stick are anchored
  /// anew where they are, and rubber that relaxes has forgotten its past.
  void take_over(const VirtualFinger& other, State state);

  double time() const { return finger_->time(); }
  const FingerSetup& setup() const { return setup_; }
  const LatticeModel& model() const { return model_; }
  const RodBody& rod_body() const { return rod_; }
  const Finger& finger() const { return *finger_; }
  Finger& finger() { return *finger_; }
  /// Steps so far, whatever was loaded in between.
  const StepCount& step_count() const { return stepper_->count(); }
  /// How the steps that divide `period` [s] relate to the bounds at rest.
  StepReport step_report(double period) const;

 private:
  FingerSetup setup_;
  LatticeModel model_;
  RodBody rod_;
  Team team_;
  StepController steps_;
  std::unique_ptr<Finger> finger_;
  std::unique_ptr<Stepper> stepper_;
  Drive drive_;  ///< at the start none, and a prescribed rod rests
  Snapshot start_;
};

}  // namespace fingertip::lattice::inline control
