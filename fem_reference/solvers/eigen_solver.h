/// Natural vibration of a body: K v = omega² M v. deal.II's side.
#pragma once

#include <vector>

#include "fem_reference/elements/assembly.h"

namespace fingertip::fem_reference::inline solvers {

/// One solution of K v = omega² M v.
struct Eigenpair {
  double eigenvalue = 0.0;  ///< omega² [rad²/s²]
  Vector shape;             ///< v, M-orthonormal; constrained entries are zero [kg^-1/2]
};

/// The `count` smallest eigenvalues, in increasing order, each as often as it is repeated. The
/// stiffness must be positive definite under the body's constraints. Collective over the body's
/// processes. Throws NotConverged.
///
/// Krylov-Schur with the inverse of K, factored by MUMPS (SLEPc). Constrained unknowns keep a
/// diagonal in K and have no mass, so that their eigenvalues are infinite and none is spurious.
std::vector<Eigenpair> lowest_eigenpairs(const Body<3>& body, ElementKernel<3>& stiffness,
                                         ElementKernel<3>& mass, int count);

}  // namespace fingertip::fem_reference::inline solvers
