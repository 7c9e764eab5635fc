/// Marches M a + C v + K u = f + contact in time, C = tau K (Kelvin-Voigt), with the branches of a
/// rubber that relaxes. deal.II's side.
#pragma once

#include <array>
#include <memory>

#include "fem_reference/elements/memory.h"
#include "fem_reference/solvers/field_solver.h"
#include "meshes/shape/geometry.h"

namespace fingertip::fem_reference::inline motion {

/// Where the mechanical energy is [J].
struct MechanicalEnergy {
  double kinetic = 0.0;
  double elastic = 0.0;  ///< that of the branches included
};

/// The generalised-alpha method (Chung & Hulbert, J. Appl. Mech. 60, 1993, 371-375) with the
/// spectral radius at infinite frequency rho_inf = 0, so that alpha_m = -1, alpha_f = 0,
/// gamma = 3/2, beta = 1:
///
///   M (2 a' - a) + C v' + K u' + sum b_i K_b d_i' = f',
///   u' = u + dt v + dt² (-a/2 + a'),   v' = v + dt (-a/2 + 3 a'/2)
///
/// with primes at the end of a step, d_i the branches' displacements (memory.h). Of the family only
/// this member asks for balance at the end of the step and nowhere else (alpha_f = 0), which is
/// where contact is enforced: gap, reaction and forces belong to one instant. A node that the plane
/// takes along is at its speed, without ringing, after two steps, and whatever the step cannot
/// resolve dies within one. Unconditionally stable, second order in dt for smooth motion. The
/// acceleration at the end of the step is 2 a' - a = 2 (u' - u - dt v)/dt²; a' alone is of first
/// order.
///
/// Eliminating a', v' and d_i' leaves one system a step, (2 M/dt² + (1 + 3 tau/(2 dt)) K +
/// sum b_i gain_i K_b) u' = load.
template <int dim>
class GeneralisedAlpha {
 public:
  /// At rest. The kernels must be linear; `set_step` uses them again, so they must stay alive.
  /// `retardation_time` is tau [s], >= 0; the multigrid solver needs a coarse matrix.
  GeneralisedAlpha(const Body<dim>& body, ElementKernel<dim>& stiffness, ElementKernel<dim>& mass,
                   double retardation_time, bool with_coarse_matrix, LinearMemory<dim> memory = {});

  /// Start from a displacement [m] and velocity [m/s]; `acceleration` [m/s²] must balance them for
  /// the first step to be of second order.
  void set_state(const Vector& displacement, const Vector& velocity, const Vector& acceleration);

  /// The length of the next steps [s], > 0; hands the solver its matrix when it changes.
  void set_step(double step, FieldSolver& solver);
  double step() const { return step_; }
  /// Right-hand side of the next step: what inertia and damping add to outer forces [N], and in a
  /// frame that accelerates by that vector at its end [m/s²] the force of inertia, -M times it.
  Vector load(const meshes::Vector3& frame_acceleration = meshes::Vector3::Zero()) const;
  /// Ends a step at the solution of its system.
  void advance(const Vector& displacement);

  const Vector& displacement() const { return u_; }
  const Vector& velocity() const { return v_; }
  MechanicalEnergy energy() const;
  /// Power that damping and the branches take, v · C v + sum b_i/tau_i d_i · K_b d_i [W].
  double dissipation_rate() const;
  /// Rate of the body's momentum at the end of the last step [N]; of a body of revolution along its
  /// axis alone, so is momentum().
  meshes::Vector3 momentum_rate() const;
  /// [kg m/s]
  meshes::Vector3 momentum() const;
  /// -M times the acceleration of a frame, on what is free [N].
  Vector inertial_force(const meshes::Vector3& frame_acceleration) const;
  /// M a + C v + K u + sum b_i K_b d_i at the end of the last step with no constraint built in:
  /// what supports and contact exert on every unknown [N].
  Vector residual() const;
  const LinearMemory<dim>& memory() const { return memory_; }

 private:
  meshes::Vector3 sums(const Vector& field) const;

  const Body<dim>& body_;
  ElementKernel<dim>& stiffness_kernel_;
  ElementKernel<dim>& mass_kernel_;
  double retardation_time_;
  LinearMemory<dim> memory_;
  SparseMatrix stiffness_, mass_;
  std::array<Vector, dim> mass_of_;  ///< M times a displacement by 1 of one component
  std::unique_ptr<LinearSystem> effective_;
  double step_ = 0.0;
  Vector u_, v_, a_;         ///< a_ is the method's, see above
  Vector end_acceleration_;  ///< 2 a' - a of the last step
};

}  // namespace fingertip::fem_reference::inline motion
