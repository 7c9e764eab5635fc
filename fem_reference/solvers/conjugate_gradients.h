/// Preconditioned conjugate gradients for a matrix that may turn out not to be positive definite.
#pragma once

#include <Eigen/Core>
#include <utility>

#include "fem_reference/elements/assembly.h"

namespace fingertip::fem_reference::inline solvers {

enum class CgEnd { converged, too_many, indefinite };

struct CgOutcome {
  CgEnd end = CgEnd::converged;
  int iterations = 0;
};

inline double product(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return a.dot(b);
}
inline double product(const Vector& a, const Vector& b) {
  return a * b;
}
inline void add(double factor, const Eigen::VectorXd& v, Eigen::VectorXd& sum) {
  sum += factor * v;
}
inline void add(double factor, const Vector& v, Vector& sum) {
  sum.add(factor, v);
}

/// Until |residual| <= `enough`, in at most `most` iterations. `residual` is that of `u`; both are
/// updated, also where this ends early. `multiply(v)` and `improve(v)` return A v and M^-1 v, both
/// symmetric.
template <class V, class Multiply, class Improve>
CgOutcome conjugate_gradients(V& u, V& residual, double enough, int most, const Multiply& multiply,
                              const Improve& improve) {
  CgOutcome outcome;
  V direction;
  double before = 0.0;
  while (product(residual, residual) > enough * enough) {
    if (outcome.iterations >= most) return {CgEnd::too_many, outcome.iterations};
    V better = improve(residual);
    const double now = product(residual, better);
    if (before > 0.0) add(now / before, direction, better);
    direction = std::move(better);
    before = now;
    const V force = multiply(direction);
    const double curvature = product(direction, force);
    if (!(curvature > 0.0)) return {CgEnd::indefinite, outcome.iterations};
    add(now / curvature, direction, u);
    add(-now / curvature, force, residual);
    ++outcome.iterations;
  }
  return outcome;
}

}  // namespace fingertip::fem_reference::inline solvers
