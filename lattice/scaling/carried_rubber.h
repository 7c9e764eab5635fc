/// The rubber as the rod carries it: its particles together as one body.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "lattice/model.h"
#include "lattice/parallel.h"
#include "lattice/scaling/multigrid.h"
#include "lattice/state.h"

namespace fingertip::lattice {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// (force, moment about the origin) of a force [N] that acts at x [m].
Vector6 acting_at(const meshes::Vector3& x, const meshes::Vector3& force);

/// Inertia of a point mass [kg] at x [m] against rigid motions about the origin.
Matrix6 point_inertia(double mass, const meshes::Vector3& x);

/// Sums over the particles where they are now, about the origin, along the grid's axes. A rigid
/// motion (a, w) accelerates the point x by a + w x x.
class CarriedRubber {
 public:
  explicit CarriedRubber(const LatticeModel& model);

  struct Scratch {
    std::vector<std::array<double, 16>> partial;  ///< of portions of the particles
  };
  Scratch scratch() const;

  /// load = inertia force/mass, less what it takes to accelerate the mass by a rigid motion.
  void load(const Vector6& motion, const std::vector<double>& inertia, const State& state,
            Team& team, const VectorField& force, MultigridFields::Field& load) const;
  struct Sums {
    Vector6 taken = Vector6::Zero();    ///< by the accelerations: [N], [N m]
    Matrix6 inertia = Matrix6::Zero();  ///< of a rigid motion
  };
  Sums sums(const MultigridFields::Field& acceleration, const State& state, Team& team,
            Scratch& scratch) const;
  /// force = m (acceleration + that of the rigid motion) [N].
  void accelerate(const Vector6& motion, const MultigridFields::Field& acceleration,
                  const State& state, Team& team, VectorField& force) const;
  /// x of a particle.
  meshes::Vector3 position(std::size_t point, const State& state) const;

 private:
  const LatticeModel* model_;
  std::vector<std::array<double, 3>> starts_;  ///< per block: X of its first point [m]
};

}  // namespace fingertip::lattice
