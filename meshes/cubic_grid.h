/// The regular grid on which the lattice lives, and the paper's volumetric sampling of the tip.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meshes/geometry.h"

namespace fingertip::meshes {

/// A cubic grid of points origin + spacing (i, j, k), 0 <= i < size[0] etc., x fastest.
struct CubicGrid {
  double spacing = 0.0;              ///< a [m] (the paper's A)
  Vector3 origin = Vector3::Zero();  ///< position of point (0, 0, 0) [m]
  std::array<int, 3> size{0, 0, 0};  ///< points along x, y, z

  std::size_t points() const {
    return std::size_t(size[0]) * std::size_t(size[1]) * std::size_t(size[2]);
  }
  std::size_t index(int i, int j, int k) const {
    return (std::size_t(k) * std::size_t(size[1]) + std::size_t(j)) * std::size_t(size[0]) +
           std::size_t(i);
  }
  Vector3 position(int i, int j, int k) const {
    return origin + spacing * Vector3(double(i), double(j), double(k));
  }
};

/// The grid of the paper's points w_ijk = (A i, A j, A k - L) + offset A, with i and j over both
/// signs, large enough to hold the whole tip and `margin` further layers of points on every side.
/// (The printed formula subtracts R/2 from the first two coordinates; with i, j >= 0 that keeps
/// little more than half of the tip, so it is read as a misprint.)
/// Throws InvalidInput unless 0 < spacing <= (R - r)/2 and every |offset| <= 1.
CubicGrid covering_grid(const Geometry& geometry, double spacing, const Vector3& offset,
                        int margin);

/// The paper's set P: for every grid point whether it is a particle (1) or not (0). Points within
/// 1e-9 R of a surface count as lying on it.
std::vector<std::uint8_t> sample_particles(const Geometry& geometry, const CubicGrid& grid);

/// V/A³, the paper's estimate of |P| (section II.C).
double expected_particle_count(const Geometry& geometry, double spacing);

}  // namespace fingertip::meshes
