#include "fem_reference/generalised_alpha.h"

#include <cmath>
#include <memory>
#include <vector>

namespace fingertip::fem_reference {
namespace {

/// stiffness_factor K + mass_factor M of an element.
class EffectiveKernel : public ElementKernel {
 public:
  EffectiveKernel(ElementKernel& stiffness, double stiffness_factor, ElementKernel& mass,
                  double mass_factor)
      : stiffness_(stiffness),
        mass_(mass),
        stiffness_factor_(stiffness_factor),
        mass_factor_(mass_factor) {}

  void integrate(const dealii::FEValues<3>& values, const Eigen::VectorXd& displacement,
                 ElementSystem& result) override {
    stiffness_.integrate(values, displacement, result);
    mass_.integrate(values, displacement, mass_part_);
    result.matrix = stiffness_factor_ * result.matrix + mass_factor_ * mass_part_.matrix;
    result.force.noalias() = result.matrix * displacement;
    result.energy = 0.5 * displacement.dot(result.force);
  }

 private:
  ElementKernel& stiffness_;
  ElementKernel& mass_;
  double stiffness_factor_, mass_factor_;
  ElementSystem mass_part_;
};

SparseMatrix assembled(const Body& body, ElementKernel& kernel) {
  LinearSystem system(body, false);
  assemble(body, kernel, body.fine.vector(), system);
  return std::move(system.matrix);
}

/// M times the unit translation along each axis. Unlike the products of the assembled matrix it
/// includes what the nodes of the supports carry along: summed, it is the body's mass.
std::array<Vector, 3> mass_of_translations(const Body& body, ElementKernel& mass) {
  const Space& space = body.fine;
  std::array<Vector, 3> result{space.vector(), space.vector(), space.vector()};
  std::vector<dealii::types::global_dof_index> indices(space.element.n_dofs_per_cell());
  dealii::Vector<double> translation(unsigned(indices.size())), force(translation);
  for_each_element(body, mass, space.vector(),
                   [&](const CellIterator& cell, const dealii::FullMatrix<double>& matrix,
                       const dealii::Vector<double>&, const ElementSystem&) {
                     cell->get_dof_indices(indices);
                     for (unsigned c = 0; c < dim; ++c) {
                       for (unsigned i = 0; i < indices.size(); ++i)
                         translation[i] =
                             space.element.system_to_component_index(i).first == c ? 1.0 : 0.0;
                       matrix.vmult(force, translation);
                       space.constraints.distribute_local_to_global(force, indices, result[c]);
                     }
                   });
  for (Vector& vector : result) vector.compress(dealii::VectorOperation::add);
  return result;
}

}  // namespace

GeneralisedAlpha::GeneralisedAlpha(const Body& body, ElementKernel& stiffness, ElementKernel& mass,
                                   double retardation_time, bool with_coarse_matrix)
    : body_(body),
      stiffness_kernel_(stiffness),
      mass_kernel_(mass),
      retardation_time_(retardation_time),
      stiffness_(assembled(body, stiffness)),
      mass_(assembled(body, mass)),
      mass_of_(mass_of_translations(body, mass)),
      effective_(std::make_unique<LinearSystem>(body, with_coarse_matrix)),
      u_(body.fine.vector()),
      v_(u_),
      a_(u_),
      end_acceleration_(u_) {}

void GeneralisedAlpha::set_state(const Vector& displacement, const Vector& velocity,
                                 const Vector& acceleration) {
  u_ = displacement;
  v_ = velocity;
  a_ = acceleration;
  end_acceleration_ = acceleration;
}

void GeneralisedAlpha::set_step(double step, FieldSolver& solver) {
  constexpr double round_off = 1e-9;  // of a length divided into equal steps
  if (std::abs(step - step_) <= round_off * step) return;
  step_ = step;
  EffectiveKernel kernel(stiffness_kernel_, 1.0 + 1.5 * retardation_time_ / step, mass_kernel_,
                         2.0 / (step * step));
  assemble(body_, kernel, body_.fine.vector(), *effective_);
  solver.set_matrix(*effective_);
}

Vector GeneralisedAlpha::load() const {
  Vector inertial = u_, viscous = u_, result = u_, part = u_;
  inertial.sadd(2.0 / (step_ * step_), 2.0 / step_, v_);
  // v' = 3 u'/(2 dt) - w with w = 3 u/(2 dt) + v/2 - dt a/4: C w moves to the right.
  viscous.sadd(1.5 / step_, 0.5, v_);
  viscous.add(-0.25 * step_, a_);
  viscous *= retardation_time_;
  mass_.vmult(result, inertial);
  stiffness_.vmult(part, viscous);
  result += part;
  return result;
}

void GeneralisedAlpha::advance(const Vector& displacement) {
  Vector travel = displacement;
  travel -= u_;
  end_acceleration_ = travel;  // 2 (u' - u - dt v)/dt²
  end_acceleration_.sadd(2.0 / (step_ * step_), -2.0 / step_, v_);
  v_ *= -0.5;
  v_.add(1.5 / step_, travel, 0.25 * step_, a_);
  a_ *= 0.5;
  a_.add(0.5, end_acceleration_);
  u_ = displacement;
}

MechanicalEnergy GeneralisedAlpha::energy() const {
  Vector force = u_;
  stiffness_.vmult(force, u_);
  const double elastic = 0.5 * (force * u_);
  mass_.vmult(force, v_);
  return {0.5 * (force * v_), elastic};
}

double GeneralisedAlpha::dissipation_rate() const {
  Vector force = u_;
  stiffness_.vmult(force, v_);
  return retardation_time_ * (force * v_);
}

meshes::Vector3 GeneralisedAlpha::momentum_rate() const {
  return sums(end_acceleration_);
}

meshes::Vector3 GeneralisedAlpha::momentum() const {
  return sums(v_);
}

Vector GeneralisedAlpha::residual() const {
  EffectiveKernel elastic(stiffness_kernel_, 1.0, mass_kernel_, 0.0);
  EffectiveKernel inertial(stiffness_kernel_, 0.0, mass_kernel_, 1.0);
  Vector retarded = u_;
  retarded.add(retardation_time_, v_);
  Vector result = unconstrained_force(body_, elastic, retarded);
  result += unconstrained_force(body_, inertial, end_acceleration_);
  return result;
}

meshes::Vector3 GeneralisedAlpha::sums(const Vector& field) const {
  return {mass_of_[0] * field, mass_of_[1] * field, mass_of_[2] * field};
}

}  // namespace fingertip::fem_reference
