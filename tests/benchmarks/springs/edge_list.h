/// What every textbook prints, to measure the spring engine against: a list of springs, an array
/// of masses, one square root and one division per spring.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tests/benchmarks/springs/engine/spring_problem.h"

namespace spring_peers {

/// The same physics as `lattice::springs::SpringLattice`. Masses are an array of structures in the
/// grid's order, springs are sorted by their first mass: as favourable to the cache as lists get.
class EdgeList {
 public:
  /// Starts at rest. Throws meshes::InvalidInput when the problem breaks a rule.
  explicit EdgeList(const fingertip::lattice::springs::SpringProblem& problem);

  /// Positions [m] and velocities [m/s], one column per mass.
  void set_motion(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities);
  Eigen::Matrix3Xd positions() const;
  Eigen::Matrix3Xd velocities() const;

  void run(int steps);

  std::size_t masses() const { return masses_.size(); }
  std::size_t springs() const { return springs_.size(); }

 private:
  struct Mass {
    double x[3], v[3], f[3];
  };
  struct Spring {
    int i, j;
    double stiffness, rest_length, damping;
  };
  void add_spring_forces();
  void move();

  fingertip::lattice::springs::SpringProblem problem_;
  std::vector<Mass> masses_;
  std::vector<Spring> springs_;
};

}  // namespace spring_peers
