/// The part of a tip that is computed, and what the whole is made of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lattice/model/rod.h"
#include "meshes/cells/cubic_grid.h"

namespace fingertip::lattice::inline model {

/// Where tip, grid, obstacle and motion are their own mirror images in the planes y = 0 and perhaps
/// x = 0 (world axes), the half y >= 0 or the quarter x, y >= 0 moves as the whole does. Mirror
/// planes hold the displacement across them; what the parts do together is `count` times what of
/// one is its own mirror image. The rod stays on the planes.
class Sector {
 public:
  /// The whole tip.
  Sector() = default;
  /// One of `count` (1, 2 or 4) parts, on a grid whose axes are the world's in some order.
  Sector(int count, const Eigen::Matrix3d& axes);

  int count() const { return count_; }
  /// The grid of the part: from a layer before its mirror planes, at index 1, on.
  void crop(meshes::CubicGrid& grid) const;
  /// Whether a place on the cropped grid lies in the layer before a mirror plane: of another part.
  bool is_before(const std::array<int, 3>& index) const;
  /// 1 over the number of parts that own a place, given by its indices on the cropped grid.
  double share(const std::array<int, 3>& index) const;
  /// Whether a mirror plane across `axis` goes through a place on the cropped grid.
  bool holds(std::size_t axis, int index) const { return mirrors_[axis] && index == 1; }
  /// Leaves out of a matrix that belongs to a place on the cropped grid what mirror planes hold.
  void hold(const std::array<int, 3>& index, Eigen::Matrix3d& matrix) const;

  /// Of all parts together. Wrenches and momenta about points on the axis, in world axes ...
  Wrench whole(const Wrench& part) const;
  meshes::Vector3 whole(const meshes::Vector3& part) const;
  Matrix6 whole(const Matrix6& part) const;
  /// ... and, as (force, torque), along the grid's axes.
  Vector6 whole_on_grid(const Vector6& part) const;
  Matrix6 whole_on_grid(const Matrix6& part) const;
  /// What of a wrench is its own mirror image.
  Wrench even(const Wrench& wrench) const;

 private:
  int count_ = 1;
  std::array<bool, 3> mirrors_{};  ///< per axis of the grid: whether a plane lies across it
  Vector6 world_ = Vector6::Ones(), grid_ = Vector6::Ones();  ///< 1: its own mirror image, or 0
};

}  // namespace fingertip::lattice::inline model
