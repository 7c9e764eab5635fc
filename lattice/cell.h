/// The volume term of one lattice cell, scalar, for energies and references.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "lattice/model.h"
#include "lattice/state.h"

namespace fingertip::lattice {

/// Columns: mean edge vectors of the cell along x, y, z of a vector field (displacement or
/// velocity), i.e. a times the mean gradient.
inline Eigen::Matrix3d mean_edges(const LatticeModel& model, const VectorField& field,
                                  std::size_t cell) {
  Eigen::Matrix3d edges = Eigen::Matrix3d::Zero();
  for (int c = 0; c < 8; ++c) {
    const meshes::Vector3 value = 0.25 * field.at(cell_corner(model.grid.size, cell, c));
    for (int k = 0; k < 3; ++k) edges.col(k) += (c >> k & 1 ? 1.0 : -1.0) * value;
  }
  return edges;
}

/// Relative change of the cell's volume: V/V0 - 1 with V the triple product of the mean edges, or
/// its linearisation, the mean dilatation.
inline double volume_change(const LatticeModel& model, const VectorField& displacement,
                            std::size_t cell) {
  const Eigen::Matrix3d gradient = mean_edges(model, displacement, cell) / model.spacing();
  if (model.kinematics == Kinematics::small) return gradient.trace();
  return (Eigen::Matrix3d::Identity() + gradient).determinant() - 1.0;
}

}  // namespace fingertip::lattice
