/// The regular grid on which the lattice lives, and the paper's volumetric sampling of the tip.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline cells {

/// A cubic grid of points axes (origin + spacing (i, j, k)), 0 <= i < size[0] etc., i fastest.
struct CubicGrid {
  double spacing = 0.0;              ///< a [m] (the paper's A)
  Vector3 origin = Vector3::Zero();  ///< point (0, 0, 0) in the grid's own directions [m]
  std::array<int, 3> size{0, 0, 0};  ///< points along the grid's x, y, z
  /// Columns: the grid's x, y, z directions in the tip's frame, orthonormal and right-handed.
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();

  std::size_t points() const {
    return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
  }
  std::size_t index(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
           std::size_t(i);
  }
  /// The point of an index.
  std::array<int, 3> place(std::size_t point) const {
    const std::size_t nx = std::size_t(size[0]), ny = std::size_t(size[1]);
    return {int(point % nx), int(point / nx % ny), int(point / (nx * ny))};
  }
  Vector3 position(int i, int j, int k) const {
    return axes * (origin + spacing * Vector3(double(i), double(j), double(k)));
  }
  /// Grid coordinates, in cells, of a point [m] of the tip's frame: the inverse of `position`.
  Vector3 coordinates(const Vector3& position) const {
    return (axes.transpose() * position - origin) / spacing;
  }
  /// Indices of the point next to a point [m] of the tip's frame; it may lie outside the grid.
  std::array<int, 3> nearest(const Vector3& position) const {
    const Vector3 at = coordinates(position);
    return {int(std::lround(at.x())), int(std::lround(at.y())), int(std::lround(at.z()))};
  }
};

/// A grid cell that holds rubber. With chi = 1 in the rubber and 0 elsewhere, and (xi, eta, zeta)
/// in [0, 1]³ the cell's coordinates along the grid's axes from its lowest corner, the integrals of
/// the trilinear shape functions and of their gradients over the rubber are sums of the eight
/// moments.
struct CutCell {
  std::array<int, 3> index;  ///< the cell's lowest corner on the grid
  /// [i + 2 j + 4 k]: the integral of chi xi^i eta^j zeta^k over the unit cell, 0 <= . <= 1.
  std::array<double, 8> moments;

  /// Share of the cell that is rubber, in (0, 1].
  double fraction() const { return moments[0]; }
};

/// The grid of the paper's points w_ijk = (A i, A j, A k - L) + offset A, with i and j over both
/// signs, large enough to hold the whole tip and `margin` further layers of points on every side.
/// With `axes` the grid, its offset included, is turned about the centre (0, 0, -L) of the end.
/// (The printed formula subtracts R/2 from the first two coordinates; with i, j >= 0 that keeps
/// little more than half of the tip, so it is read as a misprint.)
/// Throws InvalidInput unless 0 < spacing <= (R - r)/2, every |offset| <= 1 and `axes` is a
/// rotation.
CubicGrid covering_grid(const Geometry& geometry, double spacing, const Vector3& offset, int margin,
                        const Eigen::Matrix3d& axes = Eigen::Matrix3d::Identity());

/// The paper's set P: for every grid point whether it is a particle (1) or not (0). Points within
/// 1e-9 R of a surface count as lying on it.
std::vector<std::uint8_t> sample_particles(const Geometry& geometry, const CubicGrid& grid);

/// V/A³, the paper's estimate of |P| (section II.C).
double expected_particle_count(const Geometry& geometry, double spacing);

}  // namespace fingertip::meshes::inline cells
