#include "tests/verification/axisymmetric/meridian_body.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace fingertip::verification {
namespace {

using Eigen::Matrix2d;

/// Quadratic shape functions on (-1, 1) and their derivatives.
std::array<std::array<double, 3>, 2> shapes(double x) {
  return {{{x * (x - 1.0) / 2.0, 1.0 - x * x, x * (x + 1.0) / 2.0}, {x - 0.5, -2.0 * x, x + 0.5}}};
}

int unknown(const std::array<int, 9>& element, int k) {
  return 2 * element[std::size_t(k / 2)] + k % 2;
}

}  // namespace

MeridianBody::MeridianBody(const Meridian& mesh, const meshes::Rubber& rubber, bool finite)
    : elements_(mesh.elements),
      shear_(rubber.shear_modulus),
      lambda_(rubber.lame_lambda()),
      finite_(finite),
      fixed_(2 * mesh.nodes.size(), 0) {
  for (int i = 0; i < mesh.along; ++i)
    for (std::size_t c = 0; c < 2; ++c) fixed_[2 * std::size_t(i * mesh.across) + c] = 1;
  for (int j = 0; j < mesh.across; ++j) fixed_[2 * std::size_t(j)] = 1;
  make_points(mesh);
  make_pattern();
}

void MeridianBody::make_points(const Meridian& mesh) {
  const double root = std::sqrt(0.6);
  const std::array<double, 3> at{-root, 0.0, root}, weights{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};
  for (const auto& element : elements_)
    for (std::size_t q = 0; q < 9; ++q) {
      const auto s = shapes(at[q / 3]), t = shapes(at[q % 3]);
      Eigen::Matrix<double, 2, 9> slope;
      Eigen::Matrix<double, 9, 1> value;
      Matrix2d jacobian = Matrix2d::Zero();
      double r = 0.0;
      for (std::size_t k = 0; k < 9; ++k) {
        const auto i = Eigen::Index(k);
        value[i] = s[0][k / 3] * t[0][k % 3];
        slope.col(i) << s[1][k / 3] * t[0][k % 3], s[0][k / 3] * t[1][k % 3];
        const Eigen::Vector2d& x = mesh.nodes[std::size_t(element[k])];
        jacobian += x * slope.col(i).transpose();
        r += value[i] * x.x();
      }
      slope = jacobian.inverse().transpose() * slope;
      Point point;
      point.weight =
          2.0 * std::numbers::pi * r * jacobian.determinant() * weights[q / 3] * weights[q % 3];
      point.gradient.setZero();
      for (Eigen::Index k = 0; k < 9; ++k) {
        point.gradient(0, 2 * k) = point.gradient(2, 2 * k + 1) = slope(0, k);
        point.gradient(1, 2 * k) = point.gradient(3, 2 * k + 1) = slope(1, k);
        point.gradient(4, 2 * k) = value[k] / r;
      }
      points_.push_back(point);
    }
}

void MeridianBody::make_pattern() {
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& element : elements_)
    for (int a = 0; a < 18; ++a)
      for (int b = 0; b < 18; ++b)
        if (unknown(element, a) >= unknown(element, b))
          entries.emplace_back(unknown(element, a), unknown(element, b), 0.0);
  const auto size = Eigen::Index(fixed_.size());
  pattern_.resize(size, size);
  pattern_.setFromTriplets(entries.begin(), entries.end());
  pattern_.makeCompressed();
  for (const auto& element : elements_) {
    std::array<int, 171> place{};
    std::size_t n = 0;
    for (int a = 0; a < 18; ++a)
      for (int b = 0; b <= a; ++b) {
        const int row = std::max(unknown(element, a), unknown(element, b));
        const int column = std::min(unknown(element, a), unknown(element, b));
        place[n++] = int(&pattern_.coeffRef(row, column) - pattern_.valuePtr());
      }
    places_.push_back(place);
  }
}

/// Stress P = dW/dF and its derivative; false where J <= 0.
bool MeridianBody::respond(const Five& h, Five& stress, FiveByFive& stiffness) const {
  Matrix2d inverse = Matrix2d::Identity();  // of F in the meridian plane
  double hoop = 1.0, pressure = 0.0;        // 1/(hoop stretch), lambda ln J
  if (finite_) {
    const Matrix2d f{{1.0 + h[0], h[1]}, {h[2], 1.0 + h[3]}};
    const double jacobian = f.determinant() * (1.0 + h[4]);
    if (!(jacobian > 0.0) || !(1.0 + h[4] > 0.0)) return false;
    inverse = f.inverse();
    hoop = 1.0 / (1.0 + h[4]);
    pressure = lambda_ * std::log(jacobian);
  }
  Five g;  // F^-T
  g << inverse(0, 0), inverse(1, 0), inverse(0, 1), inverse(1, 1), hoop;
  stiffness = lambda_ * g * g.transpose();
  stiffness.diagonal().array() += shear_;
  // F^-T_iL F^-T_kJ, index pairs (iJ, kL)
  const double shear = shear_ - pressure;
  for (int i = 0; i < 2; ++i)
    for (int J = 0; J < 2; ++J)
      for (int k = 0; k < 2; ++k)
        for (int L = 0; L < 2; ++L)
          stiffness(2 * i + J, 2 * k + L) += shear * inverse(L, i) * inverse(J, k);
  stiffness(4, 4) += shear * hoop * hoop;
  if (finite_) {
    Five f = h;
    f[0] += 1.0, f[3] += 1.0, f[4] += 1.0;
    stress = shear_ * (f - g) + pressure * g;
  } else {
    stress = stiffness * h;
  }
  return true;
}

bool MeridianBody::assemble(const Eigen::VectorXd& u, Eigen::VectorXd& force,
                            Eigen::SparseMatrix<double>* tangent) const {
  force.setZero(u.size());
  if (tangent) Eigen::Map<Eigen::VectorXd>(tangent->valuePtr(), tangent->nonZeros()).setZero();
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    Eigen::Matrix<double, 18, 1> local, push = Eigen::Matrix<double, 18, 1>::Zero();
    for (int k = 0; k < 18; ++k) local[k] = u[unknown(elements_[e], k)];
    Eigen::Matrix<double, 18, 18> matrix = Eigen::Matrix<double, 18, 18>::Zero();
    for (std::size_t q = 9 * e; q < 9 * e + 9; ++q) {
      const Point& point = points_[q];
      Five stress;
      FiveByFive stiffness;
      if (!respond(point.gradient * local, stress, stiffness)) return false;
      push.noalias() += point.weight * (point.gradient.transpose() * stress);
      if (!tangent) continue;
      const Eigen::Matrix<double, 5, 18> half = point.weight * (stiffness * point.gradient);
      matrix.noalias() += point.gradient.transpose() * half;
    }
    for (int k = 0; k < 18; ++k) force[unknown(elements_[e], k)] += push[k];
    if (!tangent) continue;
    std::size_t n = 0;
    for (int a = 0; a < 18; ++a)
      for (int b = 0; b <= a; ++b) tangent->valuePtr()[places_[e][n++]] += matrix(a, b);
  }
  return true;
}

}  // namespace fingertip::verification
