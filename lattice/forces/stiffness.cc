#include "lattice/forces/stiffness.h"

#include <Eigen/Dense>
#include <vector>

namespace fingertip::lattice::inline forces {

using Eigen::Matrix3d;
using meshes::Vector3;

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;
using CellVector = Eigen::Matrix<double, 24, 1>;

void add_block(Triplets& entries, Eigen::Index i, Eigen::Index j, const Matrix3d& block) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      if (block(r, c) != 0.0) entries.emplace_back(int(3 * i + r), int(3 * j + c), block(r, c));
    }
  }
}

/// Change of a cell's volume per corner displacement: ±a²/4 along each axis.
CellVector volume_gradient(double spacing) {
  CellVector gradient;
  for (int c = 0; c < 8; ++c) {
    for (int k = 0; k < 3; ++k) {
      gradient(3 * c + k) = (c >> k & 1 ? 0.25 : -0.25) * spacing * spacing;
    }
  }
  return gradient;
}

}  // namespace

Eigen::SparseMatrix<double> small_strain_stiffness(const LatticeModel& model) {
  std::vector<Eigen::Index> number(model.points(), -1);
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    number[model.particles[p]] = Eigen::Index(p);
  }
  Triplets entries;
  entries.reserve(model.spring_count() * 36 + model.cells.size() * 576);
  for (int s = 0; s < directions; ++s) {
    const Direction& d = half_stencil[std::size_t(s)];
    const Vector3 direction = Vector3(d.dx, d.dy, d.dz).normalized();
    const std::size_t step = std::size_t(neighbour_offset(model.grid.size, s));
    for (const std::size_t point : model.particles) {
      const double weight = model.weight[std::size_t(s)][point];
      if (weight == 0.0) continue;
      const Matrix3d block = weight * model.stiffness[d.family] * direction * direction.transpose();
      const Eigen::Index i = number[point], j = number[point + step];
      add_block(entries, i, i, block);
      add_block(entries, j, j, block);
      add_block(entries, i, j, -block);
      add_block(entries, j, i, -block);
    }
  }
  if (model.constants.kappa != 0.0) {
    const double a = model.spacing();
    const CellVector gradient = volume_gradient(a);
    for (const std::size_t cell : model.cells) {
      for (int p = 0; p < 8; ++p) {
        for (int q = 0; q < 8; ++q) {
          add_block(entries, number[cell_corner(model.grid.size, cell, p)],
                    number[cell_corner(model.grid.size, cell, q)],
                    model.constants.kappa / (a * a * a) * gradient.segment<3>(3 * p) *
                        gradient.segment<3>(3 * q).transpose());
        }
      }
    }
  }
  const Eigen::Index size = 3 * Eigen::Index(model.particles.size());
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace fingertip::lattice::inline forces
