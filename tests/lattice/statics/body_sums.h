/// What lattice_body.h promises, added up term by term without the solver: for tests of the
/// builders.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <functional>
#include <vector>

#include "lattice/statics/lattice_body.h"

namespace body_sums {

using Eigen::Matrix3d;
using Eigen::VectorXd;
using fingertip::lattice::EmbeddedPoint;
using fingertip::lattice::LatticeBody;
using fingertip::lattice::MeanCell;
using fingertip::lattice::Spring;
using fingertip::meshes::Vector3;

/// A displacement field on the particles.
inline VectorXd on_particles(const LatticeBody& body,
                             const std::function<Vector3(const Vector3&)>& field) {
  VectorXd u(body.unknowns());
  for (std::size_t p = 0; p < body.rest.size(); ++p) {
    u.segment<3>(3 * Eigen::Index(p)) = field(body.rest[p]);
  }
  return u;
}

inline Vector3 at(const VectorXd& u, std::uint32_t particle) {
  return u.segment<3>(3 * Eigen::Index(particle));
}

inline Matrix3d mean_gradient(const MeanCell& cell, const VectorXd& u) {
  Matrix3d H = Matrix3d::Zero();
  for (int c = 0; c < 8; ++c) {
    H += at(u, cell.corners[std::size_t(c)]) * cell.gradients.col(c).transpose();
  }
  return H;
}

/// What edges' gradients differ by, times the fibres' share; of cells that hold their fibres.
inline double edge_variance(const MeanCell& cell, const VectorXd& u) {
  double sum = 0.0;
  for (int m = 0; m < 4; ++m) {
    Vector3 mode = Vector3::Zero();
    for (int c = 0; c < 8; ++c) mode += cell.modes(m, c) * at(u, cell.corners[std::size_t(c)]);
    sum += mode.squaredNorm();
  }
  return sum;
}

inline Vector3 displacement(const EmbeddedPoint& point, const VectorXd& u) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t c = 0; c < 8; ++c) sum += point.weights[c] * at(u, point.corners[c]);
  return sum;
}

inline double elastic_energy(const LatticeBody& body, const VectorXd& u) {
  double sum = 0.0;
  const auto add = [&](const Spring& spring, auto&& energy) {
    const Vector3 rest = body.rest[spring.ends[1]] - body.rest[spring.ends[0]];
    sum += spring.stiffness * energy(rest, Vector3(at(u, spring.ends[1]) - at(u, spring.ends[0])));
  };
  for (const Spring& fibre : body.fibres) {
    add(fibre, [&](const Vector3& rest, const Vector3& du) {
      return 0.5 *
             (body.finite ? (rest + du).squaredNorm() - rest.squaredNorm() : du.squaredNorm());
    });
  }
  for (const Spring& spring : body.springs) {
    add(spring, [&](const Vector3& rest, const Vector3& du) {
      const double stretch =
          body.finite ? (rest + du).norm() - rest.norm() : rest.normalized().dot(du);
      return 0.5 * stretch * stretch;
    });
  }
  for (const MeanCell& cell : body.cells) {
    sum += cell.volume * body.law.energy(mean_gradient(cell, u), edge_variance(cell, u));
  }
  return sum;
}

inline double bond_energy(const LatticeBody& body, const VectorXd& u) {
  double sum = 0.0;
  for (const EmbeddedPoint& point : body.bond) {
    sum += 0.5 * point.stiffness * displacement(point, u).squaredNorm();
  }
  return sum;
}

/// dU/du without bond, of fibres and cells.
inline VectorXd fibre_and_cell_forces(const LatticeBody& body, const VectorXd& u) {
  VectorXd sum = VectorXd::Zero(body.unknowns());
  for (const Spring& fibre : body.fibres) {
    Vector3 d = at(u, fibre.ends[1]) - at(u, fibre.ends[0]);
    if (body.finite) d += body.rest[fibre.ends[1]] - body.rest[fibre.ends[0]];
    sum.segment<3>(3 * Eigen::Index(fibre.ends[1])) += fibre.stiffness * d;
    sum.segment<3>(3 * Eigen::Index(fibre.ends[0])) -= fibre.stiffness * d;
  }
  for (const MeanCell& cell : body.cells) {
    const Eigen::Matrix<double, 9, 1> stress = body.law.evaluate(mean_gradient(cell, u)).stress;
    const Matrix3d P =
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(stress.data());
    for (int c = 0; c < 8; ++c) {
      sum.segment<3>(3 * Eigen::Index(cell.corners[std::size_t(c)])) +=
          cell.volume * P * cell.gradients.col(c);
    }
  }
  return sum;
}

/// d²U/du² without bond at small kinematics.
inline Eigen::SparseMatrix<double> stiffness(const LatticeBody& body) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto add = [&](std::uint32_t p, std::uint32_t q, const Matrix3d& block) {
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) entries.emplace_back(3 * int(p) + i, 3 * int(q) + j, block(i, j));
    }
  };
  const auto add_spring = [&](const Spring& spring, const Matrix3d& block) {
    for (const int a : {0, 1}) {
      for (const int b : {0, 1}) {
        add(spring.ends[std::size_t(a)], spring.ends[std::size_t(b)], a == b ? block : -block);
      }
    }
  };
  for (const Spring& fibre : body.fibres) add_spring(fibre, fibre.stiffness * Matrix3d::Identity());
  for (const Spring& spring : body.springs) {
    const Vector3 d = (body.rest[spring.ends[1]] - body.rest[spring.ends[0]]).normalized();
    add_spring(spring, spring.stiffness * d * d.transpose());
  }
  const Eigen::Matrix<double, 9, 9> C = body.law.evaluate(Matrix3d::Zero()).tangent;
  for (const MeanCell& cell : body.cells) {
    for (int c = 0; c < 8; ++c) {
      for (int d = 0; d < 8; ++d) {
        Matrix3d block;
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) {
            block(i, j) = cell.volume * cell.gradients.col(c).dot(C.block<3, 3>(3 * i, 3 * j) *
                                                                  cell.gradients.col(d));
          }
        }
        add(cell.corners[std::size_t(c)], cell.corners[std::size_t(d)], block);
      }
    }
  }
  Eigen::SparseMatrix<double> K(body.unknowns(), body.unknowns());
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

}  // namespace body_sums
