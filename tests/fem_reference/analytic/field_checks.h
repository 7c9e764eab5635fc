/// What every exact solution must satisfy, checked by means that do not know the solution: finite
/// differences, Hooke's law in its compliance form, and balance over a box.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "fem_reference/analytic/elastic_field.h"
#include "tests/expectations.h"

namespace field_checks {

using fingertip::fem_reference::analytic::ElasticField;
using fingertip::fem_reference::analytic::Matrix3;
using fingertip::fem_reference::analytic::Vector3;
using fingertip::meshes::Rubber;

/// E [Pa] and nu; G = E/(2 (1 + nu)).
inline Rubber rubber(double youngs_modulus, double poissons_ratio) {
  Rubber result;
  result.youngs_modulus = youngs_modulus;
  result.shear_modulus = youngs_modulus / (2.0 * (1.0 + poissons_ratio));
  return result;
}

/// From auxetic to nearly incompressible.
inline std::vector<Rubber> rubbers() {
  return {rubber(3922.66, 3.0 / 7.0), rubber(2.0, 0.25), rubber(1.0, 0.0), rubber(3.0, -0.4),
          rubber(5.0, 0.4999)};
}

/// An axis-parallel box.
struct Box {
  Vector3 low, high;

  Vector3 at(double x, double y, double z) const {
    return low + (high - low).cwiseProduct(Vector3(x, y, z));
  }
};

/// Reproducible points inside the box.
inline std::vector<Vector3> random_points(const Box& box, int count = 20) {
  std::mt19937 generator(1996);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<Vector3> points;
  for (int i = 0; i < count; ++i) {
    const double x = uniform(generator), y = uniform(generator), z = uniform(generator);
    points.push_back(box.at(x, y, z));
  }
  return points;
}

/// Derivative along an axis by fourth-order central differences.
template <typename Value>
Value derivative(const std::function<Value(const Vector3&)>& f, const Vector3& x, int axis,
                 double step) {
  const Vector3 h = step * Vector3::Unit(axis);
  return (8.0 * (f(x + h) - f(x - h)) - (f(x + 2.0 * h) - f(x - 2.0 * h))) / (12.0 * step);
}

inline Matrix3 numerical_gradient(const ElasticField& field, const Vector3& x, double step) {
  const std::function<Vector3(const Vector3&)> u = [&](const Vector3& p) {
    return field.displacement(p);
  };
  Matrix3 result;
  for (int j = 0; j < 3; ++j) result.col(j) = derivative(u, x, j, step);
  return result;
}

inline Vector3 numerical_divergence(const ElasticField& field, const Vector3& x, double step) {
  const std::function<Matrix3(const Vector3&)> sigma = [&](const Vector3& p) {
    return field.stress(p);
  };
  Vector3 result = Vector3::Zero();
  for (int j = 0; j < 3; ++j) result += derivative(sigma, x, j, step).col(j);
  return result;
}

/// ((1 + nu) sigma - nu tr(sigma) I)/E
inline Matrix3 strain_of(const Rubber& material, const Matrix3& stress) {
  const double nu = material.poissons_ratio();
  return ((1.0 + nu) * stress - nu * stress.trace() * Matrix3::Identity()) /
         material.youngs_modulus;
}

/// At random points of the box: gradient() is that of displacement(), stress() belongs to it by
/// Hooke's law, and -div stress() = body_force().
inline void expect_consistent_field(const ElasticField& field, const Rubber& material,
                                    const Box& box, double tolerance = 1e-8) {
  const double size = (box.high - box.low).minCoeff(), step = 2e-3 * size;
  for (const Vector3& x : random_points(box)) {
    SCOPED_TRACE(testing::Message() << "x = " << x.transpose());
    const Matrix3 gradient = numerical_gradient(field, x, step), stress = field.stress(x);
    const double strained = gradient.norm(), stressed = stress.norm();
    ASSERT_GT(strained, 0.0);
    EXPECT_LT((field.gradient(x) - gradient).norm(), tolerance * strained);
    const Matrix3 strain = (gradient + gradient.transpose()) / 2.0;
    EXPECT_LT((strain_of(material, stress) - strain).norm(), tolerance * strained);
    EXPECT_LT((stress - stress.transpose()).norm(), 1e-14 * stressed);
    const Vector3 residual = numerical_divergence(field, x, step) + field.body_force(x);
    EXPECT_LT(residual.norm(), tolerance * stressed / size);
  }
}

struct GaussPoint {
  double x, weight;
};

/// Gauss's rule with eight points on [0, 1]; roots of P_8 by Newton's method.
inline std::vector<GaussPoint> gauss_rule() {
  constexpr int n = 8;
  std::vector<GaussPoint> rule;
  for (int i = 0; i < n; ++i) {
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5)), slope = 1.0;
    for (int round = 0; round < 20; ++round) {
      slope = n * (x * std::legendre(n, x) - std::legendre(n - 1, x)) / (x * x - 1.0);
      x -= std::legendre(n, x) / slope;
    }
    rule.push_back({(1.0 + x) / 2.0, 1.0 / ((1.0 - x * x) * slope * slope)});
  }
  return rule;
}

/// Integral over [0, 1]² of f(s, t).
inline double integral_over_square(const std::function<double(double, double)>& f) {
  double sum = 0.0;
  const auto rule = gauss_rule();
  for (const auto& [s, ws] : rule)
    for (const auto& [t, wt] : rule) sum += ws * wt * f(s, t);
  return sum;
}

/// Integral of f(x, n) over the six faces of the box, n the outward normal.
inline double surface_integral(const Box& box,
                               const std::function<double(const Vector3&, const Vector3&)>& f) {
  const Vector3 size = box.high - box.low;
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.0, 1.0}) {
      const Vector3 normal = (2.0 * side - 1.0) * Vector3::Unit(axis);
      sum += size.prod() / size[axis] * integral_over_square([&](double s, double t) {
               Vector3 place;
               place[axis] = side;
               place[(axis + 1) % 3] = s;
               place[(axis + 2) % 3] = t;
               return f(box.at(place.x(), place.y(), place.z()), normal);
             });
    }
  return sum;
}

inline double volume_integral(const Box& box, const std::function<double(const Vector3&)>& f) {
  double sum = 0.0;
  for (const auto& [s, weight] : gauss_rule())
    sum += weight *
           integral_over_square([&, z = s](double x, double y) { return f(box.at(x, y, z)); });
  return (box.high - box.low).prod() * sum;
}

/// A unit translation along an axis (0, 1, 2), or a unit rotation about an axis through `centre`.
inline Vector3 rigid_motion(int mode, const Vector3& x, const Vector3& centre) {
  return mode < 3 ? Vector3(Vector3::Unit(mode)) : Vector3::Unit(mode - 3).cross(x - centre);
}

/// Over the box: surface tractions and body force do no work on a rigid motion, and on u twice the
/// strain energy (Clapeyron).
inline void expect_balanced(const ElasticField& field, const Rubber& material, const Box& box,
                            double tolerance = 1e-8) {
  const Vector3 centre = box.at(0.3, 0.4, 0.6);
  const double size = (box.high - box.low).maxCoeff();
  const double force = surface_integral(
      box, [&](const Vector3& x, const Vector3& n) { return field.traction(x, n).norm(); });
  for (int mode = 0; mode < 6; ++mode) {
    const double outside = surface_integral(box, [&](const Vector3& x, const Vector3& n) {
      return field.traction(x, n).dot(rigid_motion(mode, x, centre));
    });
    const double inside = volume_integral(box, [&](const Vector3& x) {
      return field.body_force(x).dot(rigid_motion(mode, x, centre));
    });
    EXPECT_LT(std::abs(outside + inside), tolerance * force * (mode < 3 ? 1.0 : size)) << mode;
  }
  const double work = surface_integral(box,
                                       [&](const Vector3& x, const Vector3& n) {
                                         return field.traction(x, n).dot(field.displacement(x));
                                       }) +
                      volume_integral(box, [&](const Vector3& x) {
                        return field.body_force(x).dot(field.displacement(x));
                      });
  const double energy = volume_integral(box, [&](const Vector3& x) {
    return field.stress(x).cwiseProduct(strain_of(material, field.stress(x))).sum();
  });
  EXPECT_GT(energy, 0.0);
  EXPECT_NEAR(work, energy, tolerance * energy);
}

}  // namespace field_checks
