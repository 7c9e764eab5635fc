/// What the spring engine computes: equal masses on some points of a regular grid, neighbours
/// joined by damped central springs, above a frictionless plane.
///
/// With d = x_j - x_i and w = v_j - v_i of two neighbours of class c (`Family`),
///
///     f_i = [k_c (|d| - l_c) + mu_c (w·d)/|d|] d/|d| = -f_j,     l_c = a sqrt(c + 1)
///
/// the plane n·x = h pushes a mass that is below it by p = h - n·x > 0 with
///
///     f_i = max(0, k_p p - c_p n·v_i) n
///
/// and one step of length dt is symplectic Euler: v += dt (f/m + g), then x += dt v.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meshes/base/errors.h"

namespace fingertip::lattice::springs {

/// A rigid plane at rest, felt by every mass as a one-sided damped spring along the normal.
struct PenaltyPlane {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< n, a unit vector into the free half space
  double height = 0.0;                                ///< h, n·x on the plane [m]
  double stiffness = 0.0;                             ///< k_p >= 0 of one mass [N/m]; 0: no plane
  double damping = 0.0;                               ///< c_p >= 0 of one mass [N s/m]
};

struct SpringProblem {
  std::array<int, 3> size{};       ///< points along x, y, z, each >= 1
  std::vector<std::uint8_t> mask;  ///< per point, x fastest: whether a mass sits there; empty: all
  double spacing = 0.0;            ///< a [m] > 0
  std::array<double, 3> stiffness{};                  ///< k_c >= 0 per class [N/m]
  std::array<double, 3> damping{};                    ///< mu_c >= 0 per class [N s/m]
  double mass = 0.0;                                  ///< m > 0 of every mass [kg]
  double step = 0.0;                                  ///< dt > 0 [s]
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< g [m/s²]
  PenaltyPlane plane;

  std::size_t points() const {
    return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
  }
  std::size_t index(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
           std::size_t(i);
  }
  /// Whether (i, j, k) is a point of the grid with a mass on it.
  bool occupied(int i, int j, int k) const;

  /// Every rule these values break; empty when they can be simulated. Whether the step is stable
  /// is not asked: lattice/time_step.h knows.
  std::vector<meshes::Violation> violations() const;
};

/// Grid index of every mass, ascending: the order in which positions and velocities are handed out.
std::vector<std::size_t> mass_points(const SpringProblem& problem);

/// Where the masses are at rest: a (i, j, k), one column per mass [m].
Eigen::Matrix3Xd rest_positions(const SpringProblem& problem);

}  // namespace fingertip::lattice::springs
