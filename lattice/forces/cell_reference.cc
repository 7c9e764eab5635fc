// The cells' energy and forces in plain code: README of kernels/, formula by formula.
#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "lattice/forces/cell_forces.h"
#include "lattice/kernels/stencil.h"

namespace fingertip::lattice {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using meshes::Vector3;

namespace {

using Modes = Eigen::Matrix<double, 3, 4>;    // columns: yz, zx, xy, xyz
using Corners = Eigen::Matrix<double, 3, 8>;  // a vector per corner

struct Cell {
  std::size_t lowest = 0;  ///< grid index of its lowest corner
  double fraction = 1.0;
  Vector3 mean = Vector3::Zero();     ///< of x, y, z over the rubber
  Vector3 product = Vector3::Zero();  ///< of yz, zx, xy
  Matrix4d bent = Matrix4d::Zero();   ///< bending Omega [Pa]
};

Cell cell_of(const CellLattice& cells, const CellBlock& block, std::size_t lane) {
  Cell cell;
  cell.lowest = block.first + lane;
  if (block.cut == CellBlock::whole) {
    cell.bent = cells.material.bending * Eigen::Vector4d(2.0, 2.0, 2.0, 3.0).asDiagonal();
    return cell;
  }
  const auto value = [&](std::size_t v) { return cells.cut[block.cut + v].at[lane]; };
  cell.fraction = value(0);
  cell.mean = {value(1), value(2), value(3)};
  cell.product = {value(4), value(5), value(6)};
  if (cell.fraction == 0.0) return cell;  // absent
  Matrix4d root = Matrix4d::Zero();
  std::size_t next = 7;
  for (int m = 0; m < 4; ++m)
    for (int n = m; n < 4; ++n) root(m, n) = value(next++);
  cell.bent = root.transpose() * root / (0.25 * cells.spacing * cells.spacing * cell.fraction);
  return cell;
}

template <typename Visit>
void for_all_cells(const CellLattice& cells, const Visit& visit) {
  for (const CellBlock& block : cells.blocks) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const Cell cell = cell_of(cells, block, lane);
      if (cell.fraction > 0.0) visit(cell);
    }
  }
}

std::size_t corner(const CellLattice& cells, const Cell& cell, int c) {
  return cell.lowest + std::size_t((c & 1) + (c >> 1 & 1) * cells.row + (c >> 2) * cells.plane);
}

Corners at_corners(const CellLattice& cells, const Cell& cell, const VectorField& field) {
  Corners values;
  for (int c = 0; c < 8; ++c) values.col(c) = field.at(corner(cells, cell, c));
  return values;
}

Vector3 signs_of(int c) {
  return {c & 1 ? 1.0 : -1.0, c & 2 ? 1.0 : -1.0, c & 4 ? 1.0 : -1.0};
}

/// Per corner, how the mean gradient follows from its displacement: H = Σ u_c slope_cᵀ [1/m].
Vector3 mean_slope(const Cell& cell, double spacing, int c) {
  const Vector3 s = signs_of(c), m = cell.mean, p = cell.product;
  const double x = s.x(), y = s.y(), z = s.z();
  return Vector3(x * (1.0 + z * m.z() + y * m.y() + y * z * p.x()),
                 y * (1.0 + z * m.z() + x * m.x() + z * x * p.y()),
                 z * (1.0 + y * m.y() + x * m.x() + x * y * p.z())) /
         (4.0 * spacing);
}

/// Per corner, the weights of its displacement in the bilinear modes [1/m].
Eigen::Vector4d mode_weights(double spacing, int c) {
  const Vector3 s = signs_of(c);
  return Eigen::Vector4d(s.y() * s.z(), s.z() * s.x(), s.x() * s.y(), s.prod()) / (4.0 * spacing);
}

struct Deformation {
  Matrix3d H = Matrix3d::Zero();
  Modes q = Modes::Zero();
};

Deformation deformation(const CellLattice& cells, const Cell& cell, const VectorField& field) {
  const Corners u = at_corners(cells, cell, field);
  Deformation d;
  for (int c = 0; c < 8; ++c) {
    d.H += u.col(c) * mean_slope(cell, cells.spacing, c).transpose();
    d.q += u.col(c) * mode_weights(cells.spacing, c).transpose();
  }
  return d;
}

Matrix3d cofactor(const Matrix3d& F) {
  Matrix3d result;
  for (int J = 0; J < 3; ++J) result.col(J) = F.col((J + 1) % 3).cross(F.col((J + 2) % 3));
  return result;
}

double energy_density(const CellMaterial& m, const Deformation& d, const Matrix4d& bent) {
  const double bending = 0.5 * (d.q * bent * d.q.transpose()).trace();
  if (m.kind == CellLawKind::cubic) {
    const Matrix3d strain = 0.5 * (d.H + d.H.transpose());
    const Vector3 normal = strain.diagonal();
    const double shear = strain.squaredNorm() - normal.squaredNorm();
    return 0.5 * ((m.c11 - m.c12) * normal.squaredNorm() + m.c12 * std::pow(normal.sum(), 2)) +
           m.c44 * shear + bending;
  }
  const double J = (Matrix3d::Identity() + d.H).determinant();
  if (m.kind == CellLawKind::volume) return 0.5 * m.kappa * std::pow(J - 1.0, 2);
  if (!(J > 0.0)) return std::numeric_limits<double>::infinity();
  // |F|² - 3 written so that it does not cancel at small strain.
  const double excess = 2.0 * d.H.trace() + d.H.squaredNorm(), log_J = std::log(J);
  return 0.5 * m.shear * excess - m.shear * log_J + 0.5 * m.lambda * log_J * log_J + bending;
}

/// dW/dF and what is conjugate to the modes.
struct Response {
  Matrix3d P = Matrix3d::Zero();
  Modes h = Modes::Zero();
};

Response elastic_response(const CellMaterial& m, const Deformation& d, const Matrix4d& bent) {
  if (m.kind == CellLawKind::cubic) {
    Matrix3d P = m.c44 * (d.H + d.H.transpose());
    P.diagonal() = (m.c11 - m.c12) * d.H.diagonal();
    P.diagonal().array() += m.c12 * d.H.trace();
    return {P, d.q * bent};
  }
  const Matrix3d F = Matrix3d::Identity() + d.H;
  const double J = F.determinant();
  if (m.kind == CellLawKind::volume) return {m.kappa * (J - 1.0) * cofactor(F), Modes::Zero()};
  const Matrix3d P = m.shear * F + (m.lambda * std::log(J) - m.shear) * F.inverse().transpose();
  return {P, d.q * bent};
}

/// `rate`: the same of the velocity [1/s].
Response viscous_response(const CellMaterial& m, const Deformation& d, const Deformation& rate,
                          const Matrix4d& bent) {
  const double tau = m.retardation_time;
  const Matrix3d F = Matrix3d::Identity() + d.H;
  if (m.kind == CellLawKind::volume) {
    const Matrix3d slope = cofactor(F);
    return {tau * m.kappa * slope.cwiseProduct(rate.H).sum() * slope, Modes::Zero()};
  }
  const Matrix3d inverse = F.inverse(), L = rate.H * inverse, D = 0.5 * (L + L.transpose());
  const Modes g = tau * (rate.q - L * d.q) * bent;
  const Matrix3d T = tau * (m.lambda * D.trace() * Matrix3d::Identity() + 2.0 * m.shear * D);
  return {T * inverse.transpose() - g * (inverse * d.q).transpose(), g};
}

}  // namespace

double cell_energy(const CellLattice& cells, const VectorField& displacement) {
  const double cube = std::pow(cells.spacing, 3);
  double sum = 0.0;
  for_all_cells(cells, [&](const Cell& cell) {
    sum += cell.fraction * cube *
           energy_density(cells.material, deformation(cells, cell, displacement), cell.bent);
  });
  return sum;
}

void reference_cell_forces(const CellLattice& cells, const VectorField& displacement,
                           const VectorField& velocity, VectorField& force) {
  const CellMaterial& m = cells.material;
  const bool rates = m.kind != CellLawKind::cubic && m.retardation_time > 0.0;
  for_all_cells(cells, [&](const Cell& cell) {
    const Deformation d = deformation(cells, cell, displacement);
    Response r = elastic_response(m, d, cell.bent);
    if (rates) {
      const Response v = viscous_response(m, d, deformation(cells, cell, velocity), cell.bent);
      r.P += v.P;
      r.h += v.h;
    }
    const double volume = cell.fraction * std::pow(cells.spacing, 3);
    for (int c = 0; c < 8; ++c) {
      force.add(corner(cells, cell, c), -volume * (r.P * mean_slope(cell, cells.spacing, c) +
                                                   r.h * mode_weights(cells.spacing, c)));
    }
  });
}

}  // namespace fingertip::lattice
