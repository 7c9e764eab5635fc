/// Assembles element matrices into systems of equations.
#pragma once

#include <functional>
#include <type_traits>

#include "fem_reference/elements/body.h"
#include "fem_reference/elements/element.h"

namespace fingertip::fem_reference::inline elements {

/// K u = f, constraints of the body built in. `coarse_matrix` is the Galerkin restriction of the
/// matrix to linear elements, element by element; empty unless asked for.
struct LinearSystem {
  SparseMatrix matrix, coarse_matrix;
  Vector force;  ///< internal force; constrained entries are zero [N]
  double min_jacobian = 1.0;
  double energy = 0.0;  ///< [J]

  template <int dim>
  LinearSystem(const Body<dim>& body, bool with_coarse_matrix);
};

/// Fills the system at the displacement given (owned entries; constrained ones are implied).
template <int dim>
void assemble(const Body<dim>& body, ElementKernel<dim>& kernel, const Vector& displacement,
              LinearSystem& system);

/// The same without its matrices, which stay those of the last assembly.
template <int dim>
void assemble_force(const Body<dim>& body, ElementKernel<dim>& kernel, const Vector& displacement,
                    LinearSystem& system);

/// Internal force of the elements at `displacement`, passed through `constraints` [N].
template <int dim>
Vector condensed_force(const Body<dim>& body, ElementKernel<dim>& kernel,
                       const Vector& displacement,
                       const dealii::AffineConstraints<double>& constraints);

/// Internal force of all unknowns, fixed ones included: what boundaries exert [N]. Hanging nodes
/// hand their share on.
template <int dim>
Vector unconstrained_force(const Body<dim>& body, ElementKernel<dim>& kernel,
                           const Vector& displacement);

/// What to do with a cell and its element system, matrix and force ordered like its unknowns.
template <int dim>
using ElementAction = std::type_identity_t<
    std::function<void(const CellIterator<dim>&, const dealii::FullMatrix<double>&,
                       const dealii::Vector<double>&, const ElementSystem&)>>;

/// Calls `take` for every locally owned cell, in their order whatever the number of threads that
/// integrate them. Without `Parts::all` the matrix is undefined.
template <int dim>
void for_each_element(const Body<dim>& body, ElementKernel<dim>& kernel, const Vector& displacement,
                      const ElementAction<dim>& take, Parts parts = Parts::all);

}  // namespace fingertip::fem_reference::inline elements
