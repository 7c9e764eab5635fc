#include "calibration/contact_laws/tetrahedral_body.h"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "meshes/shape/geometry.h"
#include "meshes/volume_mesh/boundary_parts.h"

namespace fingertip::calibration::inline contact_laws {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;
using Matrix12 = Eigen::Matrix<double, 12, 12>;

/// Edges at the pole over those elsewhere, and how fast they grow away from it.
constexpr double fine = 0.4, growth = 0.4;
/// Distance of the mesh from the finger's surface over the shortest edges.
constexpr double surface_distance = 0.05;
/// Of Newton's method: unbalanced force over the plane's.
constexpr double balanced = 1e-8;
constexpr int max_iterations = 60;
/// Of the plane, over the indentation.
constexpr double smallest_step = 1e-2;

struct TetrahedronAtRest {
  std::array<int, 4> corners{};
  Matrix3d inverse;  ///< of the edges from the first corner
  double volume = 0.0;
};

std::vector<TetrahedronAtRest> at_rest(const meshes::Tetrahedra& mesh) {
  std::vector<TetrahedronAtRest> all;
  for (const auto& corners : mesh.tetrahedra) {
    const auto at = [&](std::size_t c) { return mesh.vertices[std::size_t(corners[c])]; };
    Matrix3d edges;
    for (int c = 0; c < 3; ++c) edges.col(c) = at(std::size_t(c) + 1) - at(0);
    all.push_back({corners, edges.inverse(), edges.determinant() / 6.0});
  }
  return all;
}

/// The whole energy and its derivatives, of the free vertices.
class PressedTetrahedra {
 public:
  PressedTetrahedra(const TetrahedralBody& body, const TetrahedralPress& press)
      : elements_(at_rest(body.mesh)),
        mu_(0.5 / (1.0 + press.poissons_ratio)),
        lambda_(press.poissons_ratio / (1.0 + press.poissons_ratio) /
                (1.0 - 2.0 * press.poissons_ratio)),
        contact_(press.contact_stiffness),
        places(3 * body.mesh.vertices.size()) {
    for (std::size_t v = 0; v < body.mesh.vertices.size(); ++v) {
      places.segment<3>(3 * Eigen::Index(v)) = body.mesh.vertices[v];
      number_.push_back(body.held[v] ? -1 : free_++);
    }
  }

  /// Of the body's energy alone and the plane's; infinite where a tetrahedron is inside out.
  double energy(const VectorXd& x, double plane) const {
    double sum = 0.0;
    for (const TetrahedronAtRest& element : elements_) {
      const Matrix3d F = gradient_of(element, x);
      if (F.determinant() <= 0.0) return std::numeric_limits<double>::infinity();
      const Matrix3d strain = 0.5 * (F.transpose() * F - Matrix3d::Identity());
      sum += element.volume *
             (mu_ * strain.squaredNorm() + 0.5 * lambda_ * strain.trace() * strain.trace());
    }
    for (Eigen::Index v = 0; v < x.size() / 3; ++v) {
      const double depth = behind(x, v, plane);
      sum += 0.5 * contact_ * depth * depth;
    }
    return sum;
  }

  /// Gradient, and where asked for the Hessian, of the free coordinates.
  VectorXd gradient(const VectorXd& x, double plane, Sparse* hessian) const {
    VectorXd gradient = VectorXd::Zero(3 * free_);
    std::vector<Eigen::Triplet<double>> triplets;
    if (hessian) triplets.reserve(elements_.size() * 144);
    for (const TetrahedronAtRest& element : elements_) add(element, x, gradient, hessian, triplets);
    for (Eigen::Index v = 0; v < x.size() / 3; ++v) {
      const double depth = behind(x, v, plane);
      const int n = number_[std::size_t(v)];
      if (depth <= 0.0 || n < 0) continue;
      gradient[3 * n + 2] += contact_ * depth;
      triplets.emplace_back(3 * n + 2, 3 * n + 2, contact_);
    }
    if (hessian) {
      hessian->resize(3 * free_, 3 * free_);
      hessian->setFromTriplets(triplets.begin(), triplets.end());
    }
    return gradient;
  }

  double force(const VectorXd& x, double plane) const {
    double sum = 0.0;
    for (Eigen::Index v = 0; v < x.size() / 3; ++v) sum += contact_ * behind(x, v, plane);
    return sum;
  }

  /// Moves the free vertices.
  VectorXd moved(const VectorXd& x, const VectorXd& step, double share) const {
    VectorXd to = x;
    for (std::size_t v = 0; v < number_.size(); ++v)
      if (number_[v] >= 0)
        to.segment<3>(3 * Eigen::Index(v)) += share * step.segment<3>(3 * number_[v]);
    return to;
  }

 private:
  std::vector<TetrahedronAtRest> elements_;
  double mu_, lambda_, contact_;
  std::vector<int> number_;  ///< of a free vertex
  int free_ = 0;

  double behind(const VectorXd& x, Eigen::Index v, double plane) const {
    return number_[std::size_t(v)] < 0 ? 0.0 : std::max(x[3 * v + 2] - plane, 0.0);
  }

  static Matrix3d gradient_of(const TetrahedronAtRest& element, const VectorXd& x) {
    Matrix3d edges;
    for (int c = 0; c < 3; ++c)
      edges.col(c) = x.segment<3>(3 * element.corners[std::size_t(c) + 1]) -
                     x.segment<3>(3 * element.corners[0]);
    return edges * element.inverse;
  }

  void add(const TetrahedronAtRest& element, const VectorXd& x, VectorXd& gradient,
           const Sparse* hessian, std::vector<Eigen::Triplet<double>>& triplets) const {
    const Matrix3d F = gradient_of(element, x);
    const Matrix3d strain = 0.5 * (F.transpose() * F - Matrix3d::Identity());
    const Matrix3d S = 2.0 * mu_ * strain + lambda_ * strain.trace() * Matrix3d::Identity();
    Eigen::Matrix<double, 3, 4> slope;  // of the corners' shape functions
    slope.rightCols<3>() = element.inverse.transpose();
    slope.col(0) = -slope.rightCols<3>().rowwise().sum();
    const Eigen::Matrix<double, 3, 4> forces = element.volume * F * S * slope;
    const Matrix3d left = F * F.transpose();
    for (std::size_t a = 0; a < 4; ++a) {
      const int row = number_[std::size_t(element.corners[a])];
      if (row < 0) continue;
      gradient.segment<3>(3 * row) += forces.col(Eigen::Index(a));
      if (!hessian) continue;
      const Vector3d ga = slope.col(Eigen::Index(a)), fa = F * ga;
      for (std::size_t b = 0; b < 4; ++b) {
        const int column = number_[std::size_t(element.corners[b])];
        if (column < 0) continue;
        const Vector3d gb = slope.col(Eigen::Index(b)), fb = F * gb;
        // d(F S g_a)/dx_b, S from the strain's symmetric change.
        const Matrix3d block = element.volume * (ga.dot(S * gb) * Matrix3d::Identity() +
                                                 mu_ * (ga.dot(gb) * left + fb * fa.transpose()) +
                                                 lambda_ * fa * fb.transpose());
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k)
            triplets.emplace_back(3 * row + i, 3 * column + k, block(i, k));
      }
    }
  }

 public:
  VectorXd places;  ///< at rest
};

/// Minimises the energy: Newton's method, with a shift where the Hessian is not positive. Empty
/// where it finds none.
std::optional<VectorXd> equilibrium(const PressedTetrahedra& body, VectorXd x, double plane) {
  Eigen::SimplicialLLT<Sparse> solver;
  Sparse hessian;
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    const VectorXd gradient = body.gradient(x, plane, &hessian);
    if (gradient.lpNorm<1>() <= balanced * body.force(x, plane)) return x;
    const double stiff = hessian.diagonal().mean();
    Sparse shifted = hessian;
    for (double shift = 0.0;; shift = shift == 0.0 ? 1e-3 : 4.0 * shift) {
      if (shift > 10.0) return {};
      if (shift > 0.0) {
        shifted = hessian;
        shifted.diagonal().array() += shift * stiff;
      }
      if (iteration == 0 && shift == 0.0) solver.analyzePattern(shifted);
      solver.factorize(shifted);
      if (solver.info() == Eigen::Success) break;
    }
    const VectorXd step = -solver.solve(gradient);
    const double before = body.energy(x, plane), slope = gradient.dot(step);
    double share = 1.0;
    for (;; share *= 0.5) {
      const double after = body.energy(body.moved(x, step, share), plane);
      if (after <= before + 1e-4 * share * slope + 1e-13 * std::abs(before)) break;
      if (share < 1e-6) return {};
    }
    x = body.moved(x, step, share);
  }
  return {};
}

}  // namespace

double TetrahedralBody::volume() const {
  double sum = 0.0;
  for (const TetrahedronAtRest& element : at_rest(mesh)) sum += element.volume;
  return sum;
}

double TetrahedralBody::top() const {
  double top = -std::numeric_limits<double>::infinity();
  for (const Vector3d& vertex : mesh.vertices) top = std::max(top, vertex.z());
  return top;
}

TetrahedralBody tetrahedral_body(const meshes::Geometry& geometry, double size) {
  const auto parts = meshes::boundary_parts(geometry);
  TetrahedralBody body;
  const meshes::Vector3 pole(0.0, 0.0, meshes::shape_of(geometry)->pole());
  body.mesh = meshes::tetrahedra_within(
      parts->surface(meshes::Sector::full),
      [&](const meshes::Vector3& w) {
        return std::min(size, fine * size + growth * (w - pole).norm());
      },
      surface_distance * fine * size);
  body.held.assign(body.mesh.vertices.size(), false);
  for (const meshes::Tetrahedra::Facet& facet : body.mesh.facets)
    if (parts->tag(facet.part) == meshes::PhysicalTag::bond)
      for (const int corner : facet.corners) body.held[std::size_t(corner)] = true;
  return body;
}

std::vector<double> forces_of(const TetrahedralBody& body, const TetrahedralPress& press,
                              const std::vector<double>& indentations) {
  const PressedTetrahedra pressed(body, press);
  VectorXd x = pressed.places;
  const double top = body.top();
  std::vector<double> forces;
  double at = 0.0;
  for (const double indentation : indentations) {
    double step = indentation - at;
    while (at < indentation) {
      const double to = std::min(indentation, at + step);
      const auto found = equilibrium(pressed, x, top - to);
      if (found) {
        x = *found;
        at = to;
      } else {
        step *= 0.5;
        if (step < smallest_step * indentation) return forces;
      }
    }
    forces.push_back(pressed.force(x, top - indentation));
  }
  return forces;
}

}  // namespace fingertip::calibration::inline contact_laws
