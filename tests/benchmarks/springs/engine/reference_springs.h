/// The spring engine to read: one spring after another, as the equations are printed. Every
/// vectorised kernel is tested against it.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tests/benchmarks/springs/engine/spring_problem.h"

namespace fingertip::lattice::springs {

class ReferenceSprings {
 public:
  /// Starts at rest. Throws meshes::InvalidInput when the problem breaks a rule.
  explicit ReferenceSprings(const SpringProblem& problem);

  /// Positions [m] and velocities [m/s], one column per mass (order of `mass_points`).
  void set_motion(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities);
  const Eigen::Matrix3Xd& positions() const { return positions_; }
  const Eigen::Matrix3Xd& velocities() const { return velocities_; }

  void run(int steps);

  /// Forces of the springs alone at the present motion [N].
  Eigen::Matrix3Xd spring_forces() const;

  std::size_t springs() const { return springs_.size(); }

 private:
  struct Spring {
    Eigen::Index i, j;
    double stiffness, damping, rest_length;
  };
  void step();

  SpringProblem problem_;
  std::vector<Spring> springs_;
  Eigen::Matrix3Xd positions_, velocities_;
};

}  // namespace fingertip::lattice::springs
