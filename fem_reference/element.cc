#include "fem_reference/element.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

using Eigen::Index;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

Index node_count(const dealii::FEValues<3>& values) {
  return Index(values.get_fe().n_dofs_per_cell());
}

/// Values of the polynomials that carry the projected volumetric part, at the quadrature points.
Eigen::MatrixXd volumetric_basis(const dealii::FEValues<3>& values) {
  return ElementPolynomials(values, int(values.get_fe().degree) - 1)
      .at(values.get_quadrature_points());
}

Index point_count(const dealii::FEValues<3>& values) {
  return Index(values.n_quadrature_points);
}

/// F = I + grad u at a quadrature point.
Eigen::Matrix3d deformation_gradient(const dealii::FEValues<3>& values, unsigned q,
                                     const Eigen::VectorXd& displacement) {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Identity();
  for (Index a = 0; a < node_count(values); ++a) {
    const auto& g = values.shape_grad(unsigned(a), q);
    for (Index i = 0; i < 3; ++i)
      for (Index j = 0; j < 3; ++j) gradient(i, j) += displacement[3 * a + i] * g[unsigned(j)];
  }
  return gradient;
}

/// First and second derivative of h(J) with respect to F, index 3 i + J:
/// dh = h' J F^-T and d²h = (h'' J² + h' J) F^-T ⊗ F^-T - h' J F^-T_iL F^-T_kJ.
struct VolumeDerivatives {
  Eigen::Matrix<double, 9, 1> first;
  Matrix9 second;
};

VolumeDerivatives differentiate(const VolumetricMeasure& h, double jacobian,
                                const Eigen::Matrix3d& inverse) {
  VolumeDerivatives result;
  Eigen::Matrix<double, 9, 1> cofactor;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j) cofactor[3 * i + j] = inverse(j, i);
  const double slope = h.first * jacobian;
  result.first = slope * cofactor;
  result.second = (h.second * jacobian * jacobian + slope) * cofactor * cofactor.transpose();
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j)
      for (Index k = 0; k < 3; ++k)
        for (Index l = 0; l < 3; ++l)
          result.second(3 * i + j, 3 * k + l) -= slope * inverse(l, i) * inverse(j, k);
  return result;
}

}  // namespace

ElementPolynomials::ElementPolynomials(const dealii::FEValues<3>& values, int degree)
    : degree_(degree) {
  double measure = 0.0;
  for (unsigned q = 0; q < values.n_quadrature_points; ++q) {
    centre_ += values.JxW(q) * values.quadrature_point(q);
    measure += values.JxW(q);
  }
  centre_ /= measure;
  size_ = std::cbrt(measure);
  const Eigen::MatrixXd basis = monomials(values.get_quadrature_points());
  const Eigen::Map<const Eigen::VectorXd> weights(values.get_JxW_values().data(), basis.rows());
  mass_.compute(basis.transpose() * weights.asDiagonal() * basis);
}

Eigen::MatrixXd ElementPolynomials::at(const std::vector<dealii::Point<3>>& points) const {
  // With mass = L L^T the columns of monomials L^-T are orthonormal.
  return mass_.matrixL().solve(monomials(points).transpose()).transpose();
}

Eigen::MatrixXd ElementPolynomials::monomials(const std::vector<dealii::Point<3>>& points) const {
  Eigen::MatrixXd values(Index(points.size()), (degree_ + 1) * (degree_ + 2) * (degree_ + 3) / 6);
  for (Index row = 0; row < values.rows(); ++row) {
    const dealii::Tensor<1, 3> x = (points[std::size_t(row)] - centre_) / size_;
    Index column = 0;
    for (int i = 0; i <= degree_; ++i)
      for (int j = 0; i + j <= degree_; ++j)
        for (int k = 0; i + j + k <= degree_; ++k)
          values(row, column++) = std::pow(x[0], i) * std::pow(x[1], j) * std::pow(x[2], k);
  }
  return values;
}

HookeKernel::HookeKernel(const meshes::Rubber& rubber, Volumetric volumetric)
    : lambda_(rubber.lame_lambda()), shear_(rubber.shear_modulus), volumetric_(volumetric) {}

void HookeKernel::integrate(const dealii::FEValues<3>& values, const Eigen::VectorXd& displacement,
                            ElementSystem& result) {
  const Index nodes = node_count(values), points = point_count(values);
  gradients_.resize(3 * nodes, points);
  for (Index q = 0; q < points; ++q) {
    const double root = std::sqrt(values.JxW(unsigned(q)));
    for (Index a = 0; a < nodes; ++a)
      for (Index i = 0; i < 3; ++i)
        gradients_(3 * a + i, q) = root * values.shape_grad(unsigned(a), unsigned(q))[unsigned(i)];
  }
  products_.noalias() = gradients_ * gradients_.transpose();
  Eigen::MatrixXd& k = result.matrix;
  if (volumetric_ == Volumetric::pointwise) {
    k = lambda_ * products_;
  } else {
    Eigen::MatrixXd basis = volumetric_basis(values);
    for (Index q = 0; q < points; ++q) basis.row(q) *= std::sqrt(values.JxW(unsigned(q)));
    const Eigen::MatrixXd projected = gradients_ * basis;
    k.noalias() = lambda_ * (projected * projected.transpose());
  }
  for (Index b = 0; b < nodes; ++b)
    for (Index a = 0; a < nodes; ++a) {
      const Eigen::Matrix3d block = products_.block<3, 3>(3 * a, 3 * b);
      k.block<3, 3>(3 * a, 3 * b) +=
          shear_ * (block.transpose() + block.trace() * Eigen::Matrix3d::Identity());
    }
  result.force.noalias() = k * displacement;
  result.energy = 0.5 * displacement.dot(result.force);
  result.min_jacobian = 1.0;
}

HyperelasticKernel::HyperelasticKernel(const HyperelasticLaw& law, Volumetric volumetric)
    : law_(law), volumetric_(volumetric) {}

void HyperelasticKernel::integrate(const dealii::FEValues<3>& values,
                                   const Eigen::VectorXd& displacement, ElementSystem& result) {
  const Index nodes = node_count(values), points = point_count(values);
  strain_operator_.setZero(9 * points, 3 * nodes);
  stressed_operator_.resize(9 * points, 3 * nodes);
  for (Index q = 0; q < points; ++q)
    for (Index a = 0; a < nodes; ++a)
      for (Index i = 0; i < 3; ++i)
        for (Index j = 0; j < 3; ++j)
          strain_operator_(9 * q + 3 * i + j, 3 * a + i) =
              values.shape_grad(unsigned(a), unsigned(q))[unsigned(j)];

  std::vector<Eigen::Matrix3d> gradient(std::size_t(points), Eigen::Matrix3d::Identity());
  Eigen::VectorXd measure(points), weights(points), jacobians(points);
  for (Index q = 0; q < points; ++q) {
    gradient[std::size_t(q)] = deformation_gradient(values, unsigned(q), displacement);
    weights[q] = values.JxW(unsigned(q));
    jacobians[q] = gradient[std::size_t(q)].determinant();
    if (!(jacobians[q] > 0.0))
      throw meshes::NotConverged("an element of the rubber is turned inside out (J = " +
                                 std::to_string(jacobians[q]) + ")");
    measure[q] = law_.volumetric(jacobians[q]).value;
  }
  Eigen::MatrixXd basis;
  Eigen::VectorXd effective = measure;  // the measure that multiplies the modulus
  if (volumetric_ == Volumetric::projected) {
    basis = volumetric_basis(values);
    effective = basis * (basis.transpose() * weights.cwiseProduct(measure));
  }
  const double modulus = law_.volumetric_modulus();
  result.energy = 0.5 * modulus * weights.dot(effective.cwiseProduct(effective));
  result.min_jacobian = jacobians.minCoeff();

  Eigen::MatrixXd volume_rows(points, 3 * nodes);  // dh/du at every point
  Eigen::VectorXd stresses(9 * points);
  for (Index q = 0; q < points; ++q) {
    const Eigen::Matrix3d& f = gradient[std::size_t(q)];
    const auto response = law_.pointwise(f);
    const auto volume = differentiate(law_.volumetric(jacobians[q]), jacobians[q], f.inverse());
    const auto rows = strain_operator_.middleRows(9 * q, 9);
    volume_rows.row(q).noalias() = volume.first.transpose() * rows;
    Matrix9 tangent = response.tangent + modulus * effective[q] * volume.second;
    if (volumetric_ == Volumetric::pointwise)
      tangent += modulus * volume.first * volume.first.transpose();
    stressed_operator_.middleRows(9 * q, 9).noalias() = weights[q] * tangent * rows;
    for (Index i = 0; i < 3; ++i)
      for (Index j = 0; j < 3; ++j)
        stresses[9 * q + 3 * i + j] =
            weights[q] * (response.stress(i, j) + modulus * effective[q] * volume.first[3 * i + j]);
    result.energy += weights[q] * response.energy;
  }
  result.force.noalias() = strain_operator_.transpose() * stresses;
  result.matrix.noalias() = strain_operator_.transpose() * stressed_operator_;
  if (volumetric_ == Volumetric::projected) {
    const Eigen::MatrixXd projected = volume_rows.transpose() * weights.asDiagonal() * basis;
    result.matrix.noalias() += modulus * (projected * projected.transpose());
  }
}

void MassKernel::integrate(const dealii::FEValues<3>& values, const Eigen::VectorXd&,
                           ElementSystem& result) {
  const Index nodes = node_count(values);
  result.matrix.setZero(3 * nodes, 3 * nodes);
  result.force.setZero(3 * nodes);
  result.min_jacobian = 1.0;
  for (Index a = 0; a < nodes; ++a)
    for (Index b = 0; b < nodes; ++b) {
      double entry = 0.0;
      for (unsigned q = 0; q < values.n_quadrature_points; ++q)
        entry +=
            values.shape_value(unsigned(a), q) * values.shape_value(unsigned(b), q) * values.JxW(q);
      for (Index i = 0; i < 3; ++i) result.matrix(3 * a + i, 3 * b + i) = density_ * entry;
    }
}

}  // namespace fingertip::fem_reference
