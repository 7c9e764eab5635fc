/// Bodies, motions and comparisons shared by the tests of the spring engine.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <random>
#include <vector>

#include "meshes/cells/cubic_grid.h"
#include "tests/benchmarks/springs/engine/spring_lattice.h"
#include "tests/benchmarks/springs/engine/spring_problem.h"

namespace scenes {

using namespace fingertip;
using lattice::springs::SpringProblem;

inline constexpr double spacing = 1e-3;

/// Rubber-like constants, different for every class, and a plane that the body's lowest masses
/// touch; everything on.
inline SpringProblem box(int nx, int ny, int nz) {
  SpringProblem problem;
  problem.size = {nx, ny, nz};
  problem.spacing = spacing;
  problem.stiffness = {100.0, 70.0, 40.0};
  problem.damping = {0.010, 0.006, 0.003};
  problem.mass = 1e-6;
  problem.step = 2e-6;
  problem.gravity = {0.3, -0.2, -9.81};
  problem.plane.normal = Eigen::Vector3d(0.1, -0.2, 1.0).normalized();
  problem.plane.height = 0.1 * spacing;
  problem.plane.stiffness = 200.0;
  problem.plane.damping = 0.01;
  return problem;
}

/// The same far above the plane, without gravity.
inline SpringProblem floating(SpringProblem problem) {
  problem.gravity.setZero();
  problem.plane.height = -1.0;
  return problem;
}

inline SpringProblem ball(int n) {
  SpringProblem problem = box(n, n, n);
  problem.mask.assign(problem.points(), 0);
  const double middle = 0.5 * (n - 1);
  const Eigen::Vector3d centre = Eigen::Vector3d::Constant(middle);
  for (int k = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        problem.mask[problem.index(i, j, k)] =
            (Eigen::Vector3d(i, j, k) - centre).norm() <= middle + 0.5 ? 1 : 0;
  return problem;
}

/// The default tip as the paper samples it, a = R / per_radius: its axis is z.
inline SpringProblem fingertip_body(int per_radius) {
  const meshes::Geometry geometry;
  const meshes::CubicGrid grid =
      meshes::covering_grid(geometry, geometry.tip_radius / per_radius, meshes::Vector3::Zero(), 0);
  SpringProblem problem = box(grid.size[0], grid.size[1], grid.size[2]);
  problem.mask = meshes::sample_particles(geometry, grid);
  return problem;
}

/// Masses of a box taken away at random.
inline SpringProblem sponge(int nx, int ny, int nz, double filled, unsigned seed) {
  SpringProblem problem = box(nx, ny, nz);
  std::mt19937 random(seed);
  std::bernoulli_distribution there(filled);
  problem.mask.resize(problem.points());
  for (std::uint8_t& m : problem.mask) m = there(random) ? 1 : 0;
  return problem;
}

struct Motion {
  Eigen::Matrix3Xd positions, velocities;
};

/// Random displacements up to a tenth of the spacing, random velocities up to 0.1 m/s.
inline Motion shaken(const SpringProblem& problem, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Motion motion{lattice::springs::rest_positions(problem), {}};
  motion.velocities.resizeLike(motion.positions);
  for (Eigen::Index i = 0; i < motion.positions.size(); ++i) {
    motion.positions(i) += 0.1 * spacing * unit(random);
    motion.velocities(i) = 0.1 * unit(random);
  }
  return motion;
}

/// Register widths, in doubles, of all kernels that the running processor can execute.
inline std::vector<int> widths() {
  std::vector<int> all;
  for (int width = 2; width <= lattice::springs::widest(); width *= 2) all.push_back(width);
  return all;
}

inline double largest(const Eigen::Matrix3Xd& values) {
  return values.size() == 0 ? 0.0 : values.cwiseAbs().maxCoeff();
}

}  // namespace scenes
