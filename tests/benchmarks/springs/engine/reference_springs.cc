#include "tests/benchmarks/springs/engine/reference_springs.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/kernels/stencil.h"

namespace fingertip::lattice::springs {

ReferenceSprings::ReferenceSprings(const SpringProblem& problem) : problem_(problem) {
  if (auto broken = problem.violations(); !broken.empty()) throw meshes::InvalidInput(broken);
  const std::vector<std::size_t> points = mass_points(problem);
  std::vector<Eigen::Index> mass_at(problem.points(), -1);
  for (std::size_t n = 0; n < points.size(); ++n) mass_at[points[n]] = Eigen::Index(n);
  for (int z = 0; z < problem.size[2]; ++z) {
    for (int y = 0; y < problem.size[1]; ++y) {
      for (int x = 0; x < problem.size[0]; ++x) {
        if (!problem.occupied(x, y, z)) continue;
        for (const Direction& d : half_stencil) {
          if (!problem.occupied(x + d.dx, y + d.dy, z + d.dz)) continue;
          springs_.push_back({mass_at[problem.index(x, y, z)],
                              mass_at[problem.index(x + d.dx, y + d.dy, z + d.dz)],
                              problem.stiffness[d.family], problem.damping[d.family],
                              problem.spacing * std::sqrt(double(d.family) + 1.0)});
        }
      }
    }
  }
  positions_ = rest_positions(problem);
  velocities_.setZero(3, positions_.cols());
}

void ReferenceSprings::set_motion(const Eigen::Matrix3Xd& positions,
                                  const Eigen::Matrix3Xd& velocities) {
  if (positions.cols() != positions_.cols() || velocities.cols() != velocities_.cols()) {
    throw std::invalid_argument("ReferenceSprings::set_motion: one column per mass");
  }
  positions_ = positions;
  velocities_ = velocities;
}

Eigen::Matrix3Xd ReferenceSprings::spring_forces() const {
  Eigen::Matrix3Xd forces = Eigen::Matrix3Xd::Zero(3, positions_.cols());
  for (const Spring& s : springs_) {
    const Eigen::Vector3d d = positions_.col(s.j) - positions_.col(s.i);
    const Eigen::Vector3d w = velocities_.col(s.j) - velocities_.col(s.i);
    const double length = d.norm();
    const Eigen::Vector3d along = d / length;
    const Eigen::Vector3d force =
        (s.stiffness * (length - s.rest_length) + s.damping * w.dot(along)) * along;
    forces.col(s.i) += force;
    forces.col(s.j) -= force;
  }
  return forces;
}

void ReferenceSprings::step() {
  const Eigen::Matrix3Xd forces = spring_forces();
  const PenaltyPlane& plane = problem_.plane;
  for (Eigen::Index i = 0; i < positions_.cols(); ++i) {
    Eigen::Vector3d force = forces.col(i);
    const double depth = plane.height - plane.normal.dot(positions_.col(i));
    if (depth > 0.0) {
      const double push =
          plane.stiffness * depth - plane.damping * plane.normal.dot(velocities_.col(i));
      force += std::max(0.0, push) * plane.normal;
    }
    velocities_.col(i) += problem_.step * (force / problem_.mass + problem_.gravity);
    positions_.col(i) += problem_.step * velocities_.col(i);
  }
}

void ReferenceSprings::run(int steps) {
  for (int n = 0; n < steps; ++n) step();
}

}  // namespace fingertip::lattice::springs
