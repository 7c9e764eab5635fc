/// The rubber as the rod carries it: its particles together as one body.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "lattice/dynamics/scaling/multigrid.h"
#include "lattice/dynamics/scaling/restraint.h"
#include "lattice/model/model.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

/// (force, moment about the origin) of a force [N] that acts at x [m].
Vector6 acting_at(const meshes::Vector3& x, const meshes::Vector3& force);

/// Sums over the whole tip's particles where they are now, about the origin, along the grid's axes.
/// A rigid motion (a, w) accelerates the point x by a + w x x.
class CarriedRubber {
 public:
  explicit CarriedRubber(const LatticeModel& model);

  struct Scratch {
    std::vector<std::array<double, 16>> partial;  ///< of portions of the particles
  };
  Scratch scratch() const;

  /// load = gain force, less what it takes to accelerate the mass by a rigid motion.
  void load(const Vector6& motion, const std::vector<double>& gain, const State& state, Team& team,
            const VectorField& force, MultigridFields::Field& load) const;
  struct Sums {
    Vector6 taken = Vector6::Zero();    ///< by the accelerations: [N], [N m]
    Matrix6 inertia = Matrix6::Zero();  ///< of a rigid motion
  };
  Sums sums(const MultigridFields::Field& acceleration, const State& state, Team& team,
            Scratch& scratch) const;
  struct Moved {
    meshes::Vector3 momentum = meshes::Vector3::Zero();  ///< before [N s]
    double kinetic_energy = 0.0;                         ///< before [J]
    Vector6 kept = Vector6::Zero();  ///< what accelerates as much as is kept: [N], [N m]
  };
  /// A step of symplectic Euler with the acceleration and that of the rigid motion, less what the
  /// restraint, if there is one, keeps of it.
  Moved move(const Vector6& motion, const Restraint* restraint,
             const MultigridFields::Field& acceleration, double step, Team& team, Scratch& scratch,
             State& state) const;

 private:
  const LatticeModel* model_;
  std::vector<std::array<double, 3>> starts_;  ///< per block: X of its first point [m]
  std::vector<Single> moves_;                  ///< per point: 1 at particles, else 0
};

}  // namespace fingertip::lattice::inline dynamics::inline scaling
