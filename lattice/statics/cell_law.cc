#include "lattice/statics/cell_law.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace fingertip::lattice {

namespace {

using Matrix9 = Eigen::Matrix<double, 9, 9>;
using Vector9 = Eigen::Matrix<double, 9, 1>;
using Eigen::Matrix3d;

/// Entries row by row: index 3 i + J.
Vector9 flat(const Matrix3d& m) {
  Vector9 entries;
  for (int i = 0; i < 3; ++i) entries.segment<3>(3 * i) = m.row(i);
  return entries;
}

/// The matrix of H -> axesᵀ H axes on flat entries.
Matrix9 change_of_axes(const Matrix3d& axes) {
  Matrix9 result;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) result(3 * i + j, 3 * k + l) = axes(k, i) * axes(l, j);
  return result;
}

/// Second derivative of ½ eps:C:eps by H in the cubic axes.
Matrix9 cubic_stiffness(double c11, double c12, double c44) {
  Matrix9 result = Matrix9::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result(4 * i, 4 * j) = i == j ? c11 : c12;
      if (i == j) continue;
      result(3 * i + j, 3 * i + j) = c44;
      result(3 * i + j, 3 * j + i) = c44;
    }
  }
  return result;
}

}  // namespace

CellLaw CellLaw::cubic(const SpringConstants& constants, double spacing, double share,
                       const Matrix3d& axes) {
  const double c44 = shear_stiffness(constants, spacing);
  const double c11 = (constants.k1 + constants.k2) / spacing + c44 + constants.kappa;
  const Matrix9 turn = change_of_axes(axes);
  CellLaw law;
  law.kind_ = Kind::linear;
  law.tangent_ = turn.transpose() * cubic_stiffness(c11, c44 + constants.kappa, c44) * turn -
                 share * c44 * Matrix9::Identity();
  return law;
}

CellLaw CellLaw::volume(double kappa, bool finite) {
  CellLaw law;
  law.kind_ = finite ? Kind::finite_volume : Kind::linear;
  law.kappa_ = kappa;
  const Vector9 trace = flat(Matrix3d::Identity());
  if (!finite) law.tangent_ = kappa * trace * trace.transpose();
  return law;
}

CellLaw CellLaw::network(const meshes::Rubber& rubber, double share) {
  return network(rubber.shear_modulus, rubber.lame_lambda(), share);
}

CellLaw CellLaw::network(double shear, double lambda, double share) {
  CellLaw law;
  law.kind_ = Kind::network;
  law.shear_ = shear;
  law.lambda_ = lambda;
  law.cell_shear_ = (1.0 - share) * shear;
  return law;
}

double CellLaw::energy(const Matrix3d& H) const {
  if (kind_ == Kind::none) return 0.0;
  if (kind_ == Kind::linear) return 0.5 * flat(H).dot(tangent_ * flat(H));
  const double J = (Matrix3d::Identity() + H).determinant();
  if (kind_ == Kind::finite_volume) return 0.5 * kappa_ * (J - 1.0) * (J - 1.0);
  if (!(J > 0.0)) return std::numeric_limits<double>::infinity();
  // I1 - 3 written so that it does not cancel at small strain.
  const double excess = 2.0 * H.trace() + H.squaredNorm(), log_J = std::log(J);
  return 0.5 * cell_shear_ * excess - shear_ * log_J + 0.5 * lambda_ * log_J * log_J;
}

CellResponse CellLaw::evaluate(const Matrix3d& H) const {
  if (kind_ == Kind::none) return {0.0, Vector9::Zero(), Matrix9::Zero()};
  if (kind_ == Kind::linear) return {energy(H), tangent_ * flat(H), tangent_};
  const Matrix3d F = Matrix3d::Identity() + H;
  CellResponse response = kind_ == Kind::network ? evaluate_network(F) : evaluate_volume(F);
  response.energy = energy(H);
  return response;
}

CellResponse CellLaw::evaluate_volume(const Matrix3d& F) const {
  // Columns of the cofactor are cross products of F's columns; cof depends on F also where J = 0.
  Matrix3d cofactor;
  for (int J = 0; J < 3; ++J) cofactor.col(J) = F.col((J + 1) % 3).cross(F.col((J + 2) % 3));
  const double excess = F.determinant() - 1.0;
  CellResponse response;
  const Vector9 slope = flat(cofactor);
  response.stress = kappa_ * excess * slope;
  response.tangent = kappa_ * slope * slope.transpose();
  // d cof_iJ / d F_kL = e_ikm e_JLN F_mN
  for (int i = 0; i < 3; ++i) {
    for (int J = 0; J < 3; ++J) {
      const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, J1 = (J + 1) % 3, J2 = (J + 2) % 3;
      const double factor = kappa_ * excess;
      response.tangent(3 * i + J, 3 * i1 + J1) += factor * F(i2, J2);
      response.tangent(3 * i + J, 3 * i2 + J2) += factor * F(i1, J1);
      response.tangent(3 * i + J, 3 * i1 + J2) -= factor * F(i2, J1);
      response.tangent(3 * i + J, 3 * i2 + J1) -= factor * F(i1, J2);
    }
  }
  return response;
}

CellResponse CellLaw::evaluate_network(const Matrix3d& F) const {
  const double J = F.determinant();
  if (!(J > 0.0)) throw std::domain_error("a cell is turned inside out");
  const Matrix3d inverse = F.inverse();  // d ln J / d F_iJ = inverse(J, i)
  const double pressure = lambda_ * std::log(J) - shear_;
  const Vector9 slope = flat(inverse.transpose());
  CellResponse response;
  response.stress = cell_shear_ * flat(F) + pressure * slope;
  response.tangent = lambda_ * slope * slope.transpose();
  response.tangent.diagonal().array() += cell_shear_;
  for (int i = 0; i < 3; ++i)
    for (int I = 0; I < 3; ++I)
      for (int k = 0; k < 3; ++k)
        for (int K = 0; K < 3; ++K)
          response.tangent(3 * i + I, 3 * k + K) -= pressure * inverse(K, i) * inverse(I, k);
  return response;
}

}  // namespace fingertip::lattice
