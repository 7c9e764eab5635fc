/// ContactSolver for a body's system A u = f + forces on the contact unknowns; deal.II's side.
#pragma once

#include <memory>
#include <vector>

#include "fem_reference/contact/contact_solver.h"
#include "fem_reference/contact/contact_surface.h"
#include "fem_reference/elements/assembly.h"

namespace fingertip::fem_reference::inline solvers {

class FieldSolver : public ContactSolver {
 public:
  /// Takes over a (new) matrix; it must stay alive and unchanged until the next call. Throws
  /// NotConverged when it cannot be factorised.
  virtual void set_matrix(const LinearSystem& system) = 0;
  /// From the next matrix on the contact unknowns of these nodes count along axes of their own, in
  /// all that a ContactSolver is asked. The eliminating solver can.
  virtual void set_axes(const std::vector<NodeAxes>& nodes);
  /// f [N]; zero at first. Constrained entries are ignored.
  virtual void set_load(const Vector& load) = 0;
  /// Forgets what it learnt from the matrices and solutions before, as a press that is resumed has:
  /// it is to end in the same bits.
  virtual void forget() {}
  /// Displacement of all unknowns at the last `hold` [m].
  virtual Vector field() = 0;
};

/// Condenses the stiffness to the contact unknowns once, by a sparse Cholesky factorisation in
/// which they come last; every `hold` is then a small dense problem. Memory grows like n^(4/3).
/// One process only.
template <int dim>
std::unique_ptr<FieldSolver> make_condensed_solver(const Body<dim>& body,
                                                   const std::vector<long>& contact_unknowns);

/// For a matrix that changes a little and often, as at large strain. Factorises it without the held
/// unknowns, so that no stable tip without contact is needed: under the dead load of the plane's
/// forces alone a strongly compressed tip is not. The factor stays while it helps: unknowns that
/// are held since it was made are taken out by their Schur complement, and conjugate gradients,
/// starting from the solution before, make up for the change of the matrix until what was out of
/// balance after `set_load` is down to a thousandth. `noise` tells. One process only.
template <int dim>
std::unique_ptr<FieldSolver> make_eliminating_solver(const Body<dim>& body,
                                                     const std::vector<long>& contact_unknowns);

/// Conjugate gradients to the relative residual `tolerance`, or until what was out of balance after
/// `set_load` is down to the share `forcing`; preconditioned by two levels: the unknowns
/// themselves, smoothed by a Chebyshev polynomial, and linear elements on the same mesh, where
/// Trilinos ML (smoothed aggregation with the six rigid-body modes as near-null space) does one
/// V-cycle. Held unknowns are projected out of both. The preconditioner stays while contact hardly
/// changes and iterations are few, whatever becomes of the matrix. Starts from the previous
/// solution. Solids only: a meridian is soon factored.
std::unique_ptr<FieldSolver> make_multigrid_solver(const Body<3>& body,
                                                   const std::vector<long>& contact_unknowns,
                                                   double tolerance, double forcing = 0.0);
/// What of Newton's linear systems may be left, of what is out of balance: more digits than its
/// next step has would be lost.
inline constexpr double newton_forcing = 1e-3;

}  // namespace fingertip::fem_reference::inline solvers
