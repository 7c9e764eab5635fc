/// What a rubber that relaxes (meshes::Relaxation) remembers of its past, on a mesh. deal.II's
/// side.
///
/// A branch's stress h_i obeys h_i' + h_i/tau_i = s', s the stress after long times, and adds
/// b_i h_i to it. Over a step in which s changes at a constant rate,
/// h_i' = decay_i h_i + gain_i (s' - s), primes at its end (meshes::PronyRecursion): exact for such
/// a step, of second order for others. So a step is one of an elastic body, s' enlarged by sum b_i
/// gain_i, under a stress that is known at its start, sum b_i (decay_i h_i - gain_i s).
///
/// With `Relaxation::bulk` s is the whole stress, else the part that moduli of shear make: of
/// lambda = -2G/3 and G at small strain, of W less m/2 h(J)² at large strain. It scales with them,
/// so a step's material is the rubber's law with other moduli.
#pragma once

#include <memory>
#include <vector>

#include "fem_reference/elements/assembly.h"
#include "fem_reference/elements/element.h"
#include "fem_reference/job/job.h"

namespace fingertip::fem_reference::inline elements {

/// The job's law with `lasting` times its moduli after long times plus `relaxing` times those of
/// them that relax. At large strain under stresses that are `carried`, which must stay alive.
template <int dim>
std::unique_ptr<ElementKernel<dim>> make_kernel(const ReferenceJob& job, double lasting,
                                                double relaxing,
                                                const PointStresses* carried = nullptr);

/// The recursion of all branches over steps of one length.
class RelaxationStep {
 public:
  RelaxationStep() = default;
  explicit RelaxationStep(meshes::Relaxation relaxation) : relaxation_(std::move(relaxation)) {}

  bool empty() const { return relaxation_.empty(); }
  std::size_t size() const { return relaxation_.branches.size(); }
  /// The length of the next steps [s], > 0. False when it is the last one's but for round-off.
  bool set(double duration);
  double decay(std::size_t i) const { return recursions_[i].decay; }
  double gain(std::size_t i) const { return recursions_[i].gain; }
  double relative_modulus(std::size_t i) const { return relaxation_.relative_modulus(i); }
  double time(std::size_t i) const { return relaxation_.branches[i].time; }
  /// sum b_i gain_i; 0 before a step is set.
  double stiffening() const;

 private:
  meshes::Relaxation relaxation_;
  double duration_ = 0.0;
  std::vector<meshes::PronyRecursion> recursions_;
};

/// Small strain: h_i is the stress that the relaxing moduli make of a displacement d_i, d_i' +
/// d_i/tau_i = u'. With K_b their stiffness the body's force is K u + sum b_i K_b d_i.
template <int dim>
class LinearMemory {
 public:
  /// Of a rubber that does not relax: nothing is remembered, every sum below is zero.
  LinearMemory() = default;
  /// At rest. The body must stay alive and keep its mesh.
  LinearMemory(const Body<dim>& body, const ReferenceJob& job);

  bool empty() const { return step_.empty(); }
  /// The length of the next steps [s]; false when nothing changes.
  bool set_step(double duration) { return step_.set(duration); }
  /// What K_b enters a step's stiffness with, sum b_i gain_i.
  double stiffening() const { return step_.stiffening(); }
  /// Of K_b; not of an empty memory.
  ElementKernel<dim>& kernel() const { return *kernel_; }
  /// Adds to the load of a step from u what is remembered, K_b sum b_i (gain_i u - decay_i d_i)
  /// [N].
  void add_load(const Vector& u, Vector& load) const;
  /// Ends a step.
  void advance(const Vector& from, const Vector& to);

  /// sum b_i d_i [m]; empty vector of an empty memory.
  Vector past() const;
  /// K_b times a displacement [N]; zero of an empty memory.
  Vector relaxing_force(const Vector& displacement) const;
  double energy() const;            ///< in the branches, sum b_i/2 d_i · K_b d_i [J]
  double dissipation_rate() const;  ///< sum b_i/tau_i d_i · K_b d_i [W]
  std::vector<Vector>& branches() { return branches_; }  ///< d_i [m]
  const std::vector<Vector>& branches() const { return branches_; }

 private:
  Vector sum_of(const auto& factor) const;

  RelaxationStep step_;
  std::unique_ptr<ElementKernel<dim>> kernel_;
  std::unique_ptr<LinearSystem> system_;  ///< K_b
  std::vector<Vector> branches_;
};

/// Large strain (Holzapfel & Simo, Int. J. Solids Struct. 33, 1996, 3019-3034, with a stress after
/// long times for each branch): h_i are second Piola-Kirchhoff stresses at the quadrature points,
/// so a rigid turn of the body leaves them alone.
template <int dim>
class PointMemory {
 public:
  PointMemory() = default;
  PointMemory(const Body<dim>& body, const ReferenceJob& job);

  bool empty() const { return step_.empty(); }
  /// Prepares a step of that length [s] from the present state.
  void start_step(double duration);
  double stiffening() const { return step_.stiffening(); }
  /// sum b_i (decay_i h_i - gain_i s) of the step; null of an empty memory.
  const PointStresses* carried() const { return empty() ? nullptr : &carried_; }
  /// Ends the step at a displacement.
  void advance(const Vector& displacement);

  /// sum b_i h_i.
  PointStresses past() const;
  /// s and every h_i, to save and restore them.
  std::vector<PointStresses*> stresses();
  std::vector<const PointStresses*> stresses() const;

 private:
  const Body<dim>* body_ = nullptr;
  RelaxationStep step_;
  std::unique_ptr<ElementKernel<dim>> kernel_;  ///< of s
  PointStresses stress_, carried_;
  std::vector<PointStresses> branches_;
};

}  // namespace fingertip::fem_reference::inline elements
