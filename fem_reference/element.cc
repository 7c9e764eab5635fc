#include "fem_reference/element.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>

#include "fem_reference/kinematics.h"
#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

using Eigen::Index;
using Matrix9 = Eigen::Matrix<double, 9, 9>;

template <int dim>
Index node_count(const dealii::FEValues<dim>& values) {
  return Index(values.get_fe().n_dofs_per_cell());
}

/// Values of the polynomials that carry the projected volumetric part, at the quadrature points.
template <int dim>
Eigen::MatrixXd volumetric_basis(const dealii::FEValues<dim>& values) {
  return ElementPolynomials<dim>(values, int(values.get_fe().degree) - 1)
      .at(values.get_quadrature_points());
}

template <int dim>
Index point_count(const dealii::FEValues<dim>& values) {
  return Index(values.n_quadrature_points);
}

template <int dim>
Eigen::VectorXd weights_of(const dealii::FEValues<dim>& values) {
  Eigen::VectorXd weights(point_count(values));
  for (Index q = 0; q < weights.size(); ++q) weights[q] = weight(values, unsigned(q));
  return weights;
}

/// The entries of F that an element can change.
template <int dim>
constexpr Index entry_count = Index(Kinematics<dim>::entries.size());

/// The matrix B with B u = those entries of grad u, at all quadrature points.
template <int dim>
void fill_strain_operator(const dealii::FEValues<dim>& values, Eigen::MatrixXd& strain_operator) {
  constexpr Index size = entry_count<dim>;
  strain_operator.setZero(size * point_count(values), dim * node_count(values));
  for (Index q = 0; q < point_count(values); ++q)
    for (Index a = 0; a < node_count(values); ++a) {
      const auto& gradient = values.shape_grad(unsigned(a), unsigned(q));
      for (Index i = 0; i < dim; ++i)
        for (Index j = 0; j < dim; ++j)
          strain_operator(size * q + dim * i + j, dim * a + i) = gradient[unsigned(j)];
      if constexpr (Kinematics<dim>::revolved)
        strain_operator(size * q + dim * dim, dim * a) =
            values.shape_value(unsigned(a), unsigned(q)) / values.quadrature_point(unsigned(q))[0];
    }
}

/// I + grad u.
template <int dim>
Eigen::Matrix3d deformation_gradient(const Eigen::Ref<const Eigen::VectorXd>& entries) {
  Eigen::Matrix3d result = Eigen::Matrix3d::Identity();
  for (Index e = 0; e < entries.size(); ++e) {
    const Index place = Kinematics<dim>::entries[std::size_t(e)];
    result(place / 3, place % 3) += entries[e];
  }
  return result;
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

template <int dim>
ElementPolynomials<dim>::ElementPolynomials(const dealii::FEValues<dim>& values, int degree)
    : degree_(degree) {
  const Eigen::VectorXd weights = weights_of(values);
  double extent = 0.0;
  for (unsigned q = 0; q < values.n_quadrature_points; ++q) {
    centre_ += weights[Index(q)] * values.quadrature_point(q);
    extent += values.JxW(q);
  }
  centre_ /= weights.sum();
  size_ = std::pow(extent, 1.0 / dim);
  const Eigen::MatrixXd basis = monomials(values.get_quadrature_points());
  mass_.compute(basis.transpose() * weights.asDiagonal() * basis);
}

template <int dim>
Eigen::MatrixXd ElementPolynomials<dim>::at(const std::vector<dealii::Point<dim>>& points) const {
  // With mass = L L^T the columns of monomials L^-T are orthonormal.
  return mass_.matrixL().solve(monomials(points).transpose()).transpose();
}

template <int dim>
Eigen::MatrixXd ElementPolynomials<dim>::monomials(
    const std::vector<dealii::Point<dim>>& points) const {
  const int solid = dim == 3 ? degree_ : 0;  // the third coordinate's highest power
  const Index count = dim == 3 ? (degree_ + 1) * (degree_ + 2) * (degree_ + 3) / 6
                               : (degree_ + 1) * (degree_ + 2) / 2;
  Eigen::MatrixXd values(Index(points.size()), count);
  for (Index row = 0; row < values.rows(); ++row) {
    const dealii::Tensor<1, dim> x = (points[std::size_t(row)] - centre_) / size_;
    Index column = 0;
    for (int i = 0; i <= degree_; ++i)
      for (int j = 0; i + j <= degree_; ++j)
        for (int k = 0; k <= std::min(solid, degree_ - i - j); ++k)
          values(row, column++) = std::pow(x[0], i) * std::pow(x[1], j) * std::pow(x[dim - 1], k);
  }
  return values;
}

template <int dim>
HookeKernel<dim>::HookeKernel(const meshes::Rubber& rubber, Volumetric volumetric)
    : lambda_(rubber.lame_lambda()), shear_(rubber.shear_modulus), volumetric_(volumetric) {}

template <int dim>
void HookeKernel<dim>::integrate(const dealii::FEValues<dim>& values,
                                 const Eigen::VectorXd& displacement, ElementSystem& result) {
  constexpr bool revolved = Kinematics<dim>::revolved;
  const Index nodes = node_count(values), points = point_count(values);
  const Eigen::VectorXd roots = weights_of(values).cwiseSqrt();
  gradients_.resize(dim * nodes, points);
  for (Index q = 0; q < points; ++q)
    for (Index a = 0; a < nodes; ++a)
      for (Index i = 0; i < dim; ++i)
        gradients_(dim * a + i, q) =
            roots[q] * values.shape_grad(unsigned(a), unsigned(q))[unsigned(i)];
  if constexpr (revolved) {
    hoops_.resize(nodes, points);
    divergences_ = gradients_;
    for (Index q = 0; q < points; ++q)
      for (Index a = 0; a < nodes; ++a) {
        hoops_(a, q) = roots[q] * values.shape_value(unsigned(a), unsigned(q)) /
                       values.quadrature_point(unsigned(q))[0];
        divergences_(dim * a, q) += hoops_(a, q);
      }
  }
  const Eigen::MatrixXd& divergences = revolved ? divergences_ : gradients_;
  products_.noalias() = gradients_ * gradients_.transpose();
  Eigen::MatrixXd& k = result.matrix;
  if (volumetric_ == Volumetric::projected) {
    const Eigen::MatrixXd projected = divergences * roots.asDiagonal() * volumetric_basis(values);
    k.noalias() = lambda_ * (projected * projected.transpose());
  } else if (revolved) {
    k.noalias() = lambda_ * (divergences * divergences.transpose());
  } else {
    k = lambda_ * products_;
  }
  using Block = Eigen::Matrix<double, dim, dim>;
  for (Index b = 0; b < nodes; ++b)
    for (Index a = 0; a < nodes; ++a) {
      const Block block = products_.block<dim, dim>(dim * a, dim * b);
      k.block<dim, dim>(dim * a, dim * b) +=
          shear_ * (block.transpose() + block.trace() * Block::Identity());
      if constexpr (revolved) k(dim * a, dim * b) += 2 * shear_ * hoops_.row(a).dot(hoops_.row(b));
    }
  result.force.noalias() = k * displacement;
  result.energy = 0.5 * displacement.dot(result.force);
  result.min_jacobian = 1.0;
}

template <int dim>
HyperelasticKernel<dim>::HyperelasticKernel(const HyperelasticLaw& law, Volumetric volumetric)
    : law_(law), volumetric_(volumetric) {}

template <int dim>
void HyperelasticKernel<dim>::integrate(const dealii::FEValues<dim>& values,
                                        const Eigen::VectorXd& displacement,
                                        ElementSystem& result) {
  constexpr Index size = entry_count<dim>;
  constexpr auto entries = Kinematics<dim>::entries;
  const Index nodes = node_count(values), points = point_count(values);
  fill_strain_operator(values, strain_operator_);
  stressed_operator_.resize(size * points, dim * nodes);
  const Eigen::VectorXd changes = strain_operator_ * displacement;

  std::vector<Eigen::Matrix3d> gradient(static_cast<std::size_t>(points));
  Eigen::VectorXd measure(points), jacobians(points);
  const Eigen::VectorXd weights = weights_of(values);
  for (Index q = 0; q < points; ++q) {
    gradient[std::size_t(q)] = deformation_gradient<dim>(changes.segment(size * q, size));
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

  Eigen::MatrixXd volume_rows(points, dim * nodes);  // dh/du at every point
  Eigen::VectorXd stresses(size * points);
  for (Index q = 0; q < points; ++q) {
    const Eigen::Matrix3d& f = gradient[std::size_t(q)];
    const auto response = law_.pointwise(f);
    const auto volume = differentiate(law_.volumetric(jacobians[q]), jacobians[q], f.inverse());
    const auto rows = strain_operator_.middleRows(size * q, size);
    volume_rows.row(q).noalias() = volume.first(entries).transpose() * rows;
    Matrix9 tangent = response.tangent + modulus * effective[q] * volume.second;
    if (volumetric_ == Volumetric::pointwise)
      tangent += modulus * volume.first * volume.first.transpose();
    const Eigen::Matrix<double, size, size> reduced = tangent(entries, entries);
    stressed_operator_.middleRows(size * q, size).noalias() = weights[q] * reduced * rows;
    for (Index e = 0; e < size; ++e) {
      const Index place = entries[std::size_t(e)];
      stresses[size * q + e] = weights[q] * (response.stress(place / 3, place % 3) +
                                             modulus * effective[q] * volume.first[place]);
    }
    result.energy += weights[q] * response.energy;
  }
  result.force.noalias() = strain_operator_.transpose() * stresses;
  result.matrix.noalias() = strain_operator_.transpose() * stressed_operator_;
  if (volumetric_ == Volumetric::projected) {
    const Eigen::MatrixXd projected = volume_rows.transpose() * weights.asDiagonal() * basis;
    result.matrix.noalias() += modulus * (projected * projected.transpose());
  }
}

template <int dim>
void MassKernel<dim>::integrate(const dealii::FEValues<dim>& values, const Eigen::VectorXd&,
                                ElementSystem& result) {
  const Index nodes = node_count(values);
  result.matrix.setZero(dim * nodes, dim * nodes);
  result.force.setZero(dim * nodes);
  result.min_jacobian = 1.0;
  for (Index a = 0; a < nodes; ++a)
    for (Index b = 0; b < nodes; ++b) {
      double entry = 0.0;
      for (unsigned q = 0; q < values.n_quadrature_points; ++q)
        entry += values.shape_value(unsigned(a), q) * values.shape_value(unsigned(b), q) *
                 weight(values, q);
      for (Index i = 0; i < dim; ++i) result.matrix(dim * a + i, dim * b + i) = density_ * entry;
    }
}

template class HookeKernel<2>;
template class HookeKernel<3>;
template class HyperelasticKernel<2>;
template class HyperelasticKernel<3>;
template class MassKernel<2>;
template class MassKernel<3>;
template class ElementPolynomials<2>;
template class ElementPolynomials<3>;

}  // namespace fingertip::fem_reference
