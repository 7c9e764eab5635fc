/// Assembles element matrices into systems of equations.
#pragma once

#include <functional>

#include "fem_reference/body.h"
#include "fem_reference/element.h"

namespace fingertip::fem_reference {

/// K u = f, constraints of the body built in. `coarse_matrix` is the Galerkin restriction of the
/// matrix to linear elements, element by element; empty unless asked for.
struct LinearSystem {
  SparseMatrix matrix, coarse_matrix;
  Vector force;  ///< internal force; constrained entries are zero [N]
  double min_jacobian = 1.0;
  double energy = 0.0;  ///< [J]

  explicit LinearSystem(const Body& body, bool with_coarse_matrix);
};

/// Fills the system at the displacement given (owned entries; constrained ones are implied).
void assemble(const Body& body, ElementKernel& kernel, const Vector& displacement,
              LinearSystem& system);

/// Internal force of the elements at `displacement`, passed through `constraints` [N].
Vector condensed_force(const Body& body, ElementKernel& kernel, const Vector& displacement,
                       const dealii::AffineConstraints<double>& constraints);

/// Internal force of all unknowns, fixed ones included: what boundaries exert [N]. Hanging nodes
/// hand their share on.
Vector unconstrained_force(const Body& body, ElementKernel& kernel, const Vector& displacement);

/// Calls `take` with cell and element system of every locally owned cell. The matrix is ordered
/// like the cell's unknowns.
void for_each_element(
    const Body& body, ElementKernel& kernel, const Vector& displacement,
    const std::function<void(const CellIterator&, const dealii::FullMatrix<double>&,
                             const dealii::Vector<double>&, const ElementSystem&)>& take);

}  // namespace fingertip::fem_reference
