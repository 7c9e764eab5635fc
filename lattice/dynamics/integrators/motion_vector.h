/// The unknowns of a finger's motion in one array.
#pragma once

#include <cstddef>

#include "lattice/contact/cut_surfaces.h"
#include "lattice/model/model.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

/// Displacements and velocities of the model's blocks, the rod's centre, orientation (x, y, z, w),
/// momentum and angular momentum, and the impulses of the plane (force, moment) and of the bond on
/// the rod (force). Entries of blocks that are no particles are zero and stay so.
class MotionVector {
 public:
  /// Model must outlive it.
  explicit MotionVector(const LatticeModel& model);

  std::size_t size() const { return rod_ + rod_entries + impulse_entries; }

  /// The impulses are zero.
  void write(const State& state, const RodState& rod, double* y) const;
  void read(const double* y, State& state, RodState& rod) const;

  /// u', v' and the rates of the impulses; the rod's are zero.
  void write_rates(const State& state, const VectorField& force, const CutSurfaces::Trial& exerted,
                   double* rates) const;
  /// Those of a free rod under a wrench at its endpoint and its weight [N].
  void write_rod_rates(const RodState& rod, const Wrench& at_endpoint,
                       const meshes::Vector3& weight, double* rates) const;

  struct Impulses {
    Wrench plane;
    meshes::Vector3 bond = meshes::Vector3::Zero();

    Impulses operator-(const Impulses& other) const {
      return {{plane.force - other.plane.force, plane.torque - other.plane.torque},
              bond - other.bond};
    }
  };
  Impulses impulses(const double* y) const;

  /// What errors are relative to (runge_kutta.h); `frequency` [rad/s] is the rubber's highest. The
  /// impulses' is so large that they have no say.
  void write_scales(const RodState& rod, double frequency, double* scales) const;

 private:
  static constexpr std::size_t rod_entries = 13, impulse_entries = 9;

  const LatticeModel* model_;
  std::size_t velocity_, rod_, impulse_;  ///< where they start
};

}  // namespace fingertip::lattice::inline dynamics::inline integrators
