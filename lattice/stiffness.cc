#include "lattice/stiffness.h"

#include <Eigen/Dense>
#include <bit>
#include <vector>

namespace fingertip::lattice {

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

Vector3 corner_position(int c) {
  return Vector3(c & 1, c >> 1 & 1, c >> 2 & 1);
}

}  // namespace

Eigen::Matrix<double, 24, 24> cell_stiffness(const SpringConstants& constants, double spacing) {
  const std::array<double, 3> k{constants.k1, constants.k2, constants.k3};
  const CellVector gradient = volume_gradient(spacing);
  Eigen::Matrix<double, 24, 24> matrix =
      constants.kappa / (spacing * spacing * spacing) * gradient * gradient.transpose();
  for (int p = 0; p < 8; ++p) {
    for (int q = p + 1; q < 8; ++q) {
      const std::size_t family = std::size_t(std::popcount(unsigned(p ^ q)) - 1);
      const Vector3 direction = (corner_position(q) - corner_position(p)).normalized();
      const Matrix3d block = cell_share[family] * k[family] * direction * direction.transpose();
      matrix.block<3, 3>(3 * p, 3 * p) += block;
      matrix.block<3, 3>(3 * q, 3 * q) += block;
      matrix.block<3, 3>(3 * p, 3 * q) -= block;
      matrix.block<3, 3>(3 * q, 3 * p) -= block;
    }
  }
  return matrix;
}

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
  if (model.has_volume_term()) {
    const double a = model.spacing();
    const CellVector gradient = volume_gradient(a);
    for (const std::size_t cell : model.cells) {
      for (int p = 0; p < 8; ++p) {
        for (int q = 0; q < 8; ++q) {
          add_block(entries, number[cell_corner(model.grid.size, cell, p)],
                    number[cell_corner(model.grid.size, cell, q)],
                    model.volume_stiffness / (a * a * a) * gradient.segment<3>(3 * p) *
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

Eigen::VectorXd mass_vector(const LatticeModel& model) {
  Eigen::VectorXd mass(3 * Eigen::Index(model.particles.size()));
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    mass.segment<3>(3 * Eigen::Index(p)).setConstant(model.mass[model.particles[p]]);
  }
  return mass;
}

}  // namespace fingertip::lattice
