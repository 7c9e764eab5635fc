#include "fem_reference/elements/element.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "fem_reference/elements/kinematics.h"
#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline elements {
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

/// What a displacement component changes F by, point after point: its two or three derivatives and,
/// in a body of revolution, phi/r. A matrix (3 points, nodes), the same for every component.
template <int dim>
void fill_slopes(const dealii::FEValues<dim>& values, Eigen::MatrixXd& slopes) {
  slopes.resize(3 * point_count(values), node_count(values));
  for (Index q = 0; q < point_count(values); ++q)
    for (Index a = 0; a < node_count(values); ++a) {
      const auto& gradient = values.shape_grad(unsigned(a), unsigned(q));
      for (Index j = 0; j < dim; ++j) slopes(3 * q + j, a) = gradient[unsigned(j)];
      if constexpr (Kinematics<dim>::revolved)
        slopes(3 * q + 2, a) =
            values.shape_value(unsigned(a), unsigned(q)) / values.quadrature_point(unsigned(q))[0];
    }
}

/// `take(i, s, e)` for every slope s of a component i that changes entry e of F.
template <int dim, class Take>
void for_each_slope(Take take) {
  for (Index i = 0; i < dim; ++i)
    for (Index s = 0; s < 3; ++s)
      if (const int e = Kinematics<dim>::slopes[std::size_t(i)][std::size_t(s)]; e >= 0)
        take(i, s, Index(e));
}

/// First and second derivative of h(J) with respect to F, index 3 i + J:
/// dh = h' J F^-T and d²h = (h'' J² + h' J) F^-T ⊗ F^-T - h' J F^-T_iL F^-T_kJ.
struct VolumeDerivatives {
  Eigen::Matrix<double, 9, 1> first;
  Matrix9 second;
};

VolumeDerivatives differentiate(const meshes::VolumetricMeasure& h, double jacobian,
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

/// P += F S, dP += dF S.
void add_carried(const Eigen::Matrix3d& stress, const Eigen::Matrix3d& gradient,
                 meshes::PointResponse& response) {
  response.stress += gradient * stress;
  for (Index i = 0; i < 3; ++i) response.tangent.block<3, 3>(3 * i, 3 * i) += stress;
}

}  // namespace

Eigen::Matrix3d tensor_of(const Eigen::Matrix<double, 6, 1>& s) {
  Eigen::Matrix3d tensor;
  tensor << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
  return tensor;
}

Eigen::Matrix<double, 6, 1> entries_of(const Eigen::Matrix3d& t) {
  Eigen::Matrix<double, 6, 1> entries;
  entries << t(0, 0), t(1, 1), t(2, 2), t(1, 2), t(0, 2), t(0, 1);
  return entries;
}

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
    double of_x = 1.0;
    for (int i = 0; i <= degree_; ++i, of_x *= x[0]) {
      double of_xy = of_x;
      for (int j = 0; i + j <= degree_; ++j, of_xy *= x[1]) {
        double of_xyz = of_xy;
        for (int k = 0; k <= std::min(solid, degree_ - i - j); ++k, of_xyz *= x[dim - 1])
          values(row, column++) = of_xyz;
      }
    }
  }
  return values;
}

template <int dim>
HookeKernel<dim>::HookeKernel(const meshes::Rubber& rubber, Volumetric volumetric)
    : lambda_(rubber.lame_lambda()), shear_(rubber.shear_modulus), volumetric_(volumetric) {}

template <int dim>
void HookeKernel<dim>::integrate(const dealii::FEValues<dim>& values,
                                 const Eigen::VectorXd& displacement, Parts,
                                 ElementSystem& result) {
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
  if (volumetric_ == Volumetric::mean_dilatation) {
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
  if constexpr (revolved)
    if (displacement.size() > dim * nodes) add_twist(k);
  result.force.noalias() = k * displacement;
  result.energy = 0.5 * displacement.dot(result.force);
  result.min_jacobian = 1.0;
}

template <int dim>
void HookeKernel<dim>::add_twist(Eigen::MatrixXd& matrix) {
  const Index nodes = hoops_.rows();
  Eigen::MatrixXd along_r(nodes, hoops_.cols()), along_z(along_r);
  for (Index a = 0; a < nodes; ++a) {
    along_r.row(a) = gradients_.row(dim * a) - hoops_.row(a);
    along_z.row(a) = gradients_.row(dim * a + 1);
  }
  const Eigen::MatrixXd stiffness =
      shear_ * (along_r * along_r.transpose() + along_z * along_z.transpose());
  const Eigen::MatrixXd meridian = matrix;
  matrix.setZero(3 * nodes, 3 * nodes);
  for (Index b = 0; b < nodes; ++b)
    for (Index a = 0; a < nodes; ++a) {
      matrix.block<dim, dim>(3 * a, 3 * b) = meridian.block<dim, dim>(dim * a, dim * b);
      matrix(3 * a + 2, 3 * b + 2) = stiffness(a, b);
    }
}

template <int dim>
HyperelasticKernel<dim>::HyperelasticKernel(const meshes::HyperelasticLaw& law,
                                            Volumetric volumetric, const PointStresses* carried)
    : law_(law), volumetric_(volumetric), carried_(carried) {}

template <int dim>
void HyperelasticKernel<dim>::integrate(const dealii::FEValues<dim>& values,
                                        const Eigen::VectorXd& displacement, Parts parts,
                                        ElementSystem& result) {
  const Index nodes = node_count(values), points = point_count(values);
  const bool projects = volumetric_ == Volumetric::mean_dilatation;
  fill_slopes(values, slopes_);
  using NodeRows = Eigen::Matrix<double, Eigen::Dynamic, dim, Eigen::RowMajor>;
  const Eigen::MatrixXd changes =
      slopes_ * Eigen::Map<const NodeRows>(displacement.data(), nodes, dim);

  std::vector<Eigen::Matrix3d> gradient(static_cast<std::size_t>(points));
  Eigen::VectorXd measure(points), jacobians(points);
  const Eigen::VectorXd weights = weights_of(values);
  for (Index q = 0; q < points; ++q) {
    Eigen::Matrix3d& f = gradient[std::size_t(q)] = Eigen::Matrix3d::Identity();
    for_each_slope<dim>(
        [&](Index i, Index s, Index e) { f(e / 3, e % 3) += changes(3 * q + s, i); });
    jacobians[q] = f.determinant();
    if (!(jacobians[q] > 0.0))
      throw meshes::NotConverged("an element of the rubber is turned inside out (J = " +
                                 std::to_string(jacobians[q]) + ")");
    measure[q] = law_.volumetric(jacobians[q]).value;
  }
  Eigen::MatrixXd basis;
  Eigen::VectorXd effective = measure;  // the measure that multiplies the modulus
  if (projects) {
    basis = volumetric_basis(values);
    effective = basis * (basis.transpose() * weights.cwiseProduct(measure));
  }
  const double modulus = law_.volumetric_modulus();
  result.energy = 0.5 * modulus * weights.dot(effective.cwiseProduct(effective));
  result.min_jacobian = jacobians.minCoeff();

  const bool with_matrix = parts == Parts::all;
  // By point and slope, for every component: the stress, and how h changes.
  Eigen::MatrixXd stresses = Eigen::MatrixXd::Zero(3 * points, dim), swelling = stresses;
  tangents_.resize(with_matrix ? std::size_t(points) : 0);
  result.stresses.resize(6, parts == Parts::stresses ? points : 0);
  for (Index q = 0; q < points; ++q) {
    const Eigen::Matrix3d& f = gradient[std::size_t(q)];
    auto response = law_.pointwise(f);
    if (carried_)
      add_carried(tensor_of(carried_->of_cell(values.get_cell()->active_cell_index()).col(q)), f,
                  response);
    const auto volume = differentiate(law_.volumetric(jacobians[q]), jacobians[q], f.inverse());
    result.energy += weights[q] * response.energy;
    for_each_slope<dim>([&](Index i, Index s, Index e) {
      stresses(3 * q + s, i) =
          weights[q] * (response.stress(e / 3, e % 3) + modulus * effective[q] * volume.first[e]);
      swelling(3 * q + s, i) = volume.first[e];
    });
    if (parts == Parts::stresses) {
      using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
      const Eigen::Matrix3d swollen = Eigen::Map<const RowMajor>(volume.first.data());
      result.stresses.col(q) =
          entries_of(f.inverse() * (response.stress + modulus * effective[q] * swollen));
    }
    if (!with_matrix) continue;
    Matrix9 tangent = response.tangent + modulus * effective[q] * volume.second;
    if (!projects) tangent += modulus * volume.first * volume.first.transpose();
    auto& ordered = tangents_[std::size_t(q)];
    ordered.setZero();
    for_each_slope<dim>([&](Index i, Index s, Index e) {
      for_each_slope<dim>([&](Index k, Index t, Index column) {
        ordered(3 * i + s, 3 * k + t) = weights[q] * tangent(e, column);
      });
    });
  }
  result.force.resize(dim * nodes);
  Eigen::Map<NodeRows>(result.force.data(), nodes, dim).noalias() = slopes_.transpose() * stresses;
  if (!with_matrix) return;
  fill_tangent(result.matrix);
  if (projects) add_swelling(swelling, weights.asDiagonal() * basis, modulus, result.matrix);
}

/// Block (i, k) couples components of two nodes: slopes^T (tangent of i and k) slopes.
template <int dim>
void HyperelasticKernel<dim>::fill_tangent(Eigen::MatrixXd& matrix) {
  const Index nodes = slopes_.cols(), points = slopes_.rows() / 3;
  matrix.resize(dim * nodes, dim * nodes);
  stressed_.resize(3 * points, nodes);
  for (Index k = 0; k < dim; ++k)
    for (Index i = 0; i <= k; ++i) {
      for (Index q = 0; q < points; ++q)
        stressed_.middleRows<3>(3 * q).noalias() =
            tangents_[std::size_t(q)].template block<3, 3>(3 * i, 3 * k) *
            slopes_.middleRows<3>(3 * q);
      block_.noalias() = slopes_.transpose() * stressed_;
      for (Index b = 0; b < nodes; ++b)
        for (Index a = 0; a < nodes; ++a)
          matrix(dim * a + i, dim * b + k) = matrix(dim * b + k, dim * a + i) = block_(a, b);
    }
}

/// modulus sum_p c_p c_p^T, c_p = ∫ p dh/du of the orthonormal polynomials p.
template <int dim>
void HyperelasticKernel<dim>::add_swelling(const Eigen::MatrixXd& swelling,
                                           const Eigen::MatrixXd& weighted_basis, double modulus,
                                           Eigen::MatrixXd& matrix) {
  const Index nodes = slopes_.cols(), points = slopes_.rows() / 3;
  projected_.resize(dim * nodes, weighted_basis.cols());
  for (Index i = 0; i < dim; ++i) {
    for (Index q = 0; q < points; ++q)
      stressed_.row(q).noalias() =
          swelling.col(i).segment<3>(3 * q).transpose() * slopes_.middleRows<3>(3 * q);
    block_.noalias() = stressed_.topRows(points).transpose() * weighted_basis;
    for (Index a = 0; a < nodes; ++a) projected_.row(dim * a + i) = block_.row(a);
  }
  matrix.noalias() += modulus * (projected_ * projected_.transpose());
}

template <int dim>
void MassKernel<dim>::integrate(const dealii::FEValues<dim>& values, const Eigen::VectorXd&, Parts,
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

}  // namespace fingertip::fem_reference::inline elements
