#include "fem_reference/motion/generalised_alpha.h"

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "fem_reference/elements/kinematics.h"

namespace fingertip::fem_reference::inline motion {
namespace {

/// A kernel with its factor in a sum.
template <int dim>
struct Weighted {
  const ElementKernel<dim>& kernel;
  double factor;
};

/// The sum of linear kernels.
template <int dim>
class SumKernel : public ElementKernel<dim> {
 public:
  explicit SumKernel(const std::vector<Weighted<dim>>& terms) {
    for (const Weighted<dim>& term : terms) terms_.push_back({term.kernel.clone(), term.factor});
  }

  void integrate(const dealii::FEValues<dim>& values, const Eigen::VectorXd& displacement, Parts,
                 ElementSystem& result) override {
    terms_.front().kernel->integrate(values, displacement, Parts::all, result);
    result.matrix *= terms_.front().factor;
    for (std::size_t i = 1; i < terms_.size(); ++i) {
      terms_[i].kernel->integrate(values, displacement, Parts::all, part_);
      result.matrix += terms_[i].factor * part_.matrix;
    }
    result.force.noalias() = result.matrix * displacement;
    result.energy = 0.5 * displacement.dot(result.force);
  }

  std::unique_ptr<ElementKernel<dim>> clone() const override {
    auto copy = std::make_unique<SumKernel>(std::vector<Weighted<dim>>{});
    for (const Term& term : terms_) copy->terms_.push_back({term.kernel->clone(), term.factor});
    return copy;
  }

 private:
  struct Term {
    std::unique_ptr<ElementKernel<dim>> kernel;
    double factor;
  };
  std::vector<Term> terms_;
  ElementSystem part_;
};

template <int dim>
SparseMatrix assembled(const Body<dim>& body, ElementKernel<dim>& kernel) {
  LinearSystem system(body, false);
  assemble(body, kernel, body.fine.vector(), system);
  return std::move(system.matrix);
}

/// M times the unit displacement of each component. Unlike the products of the assembled matrix it
/// includes what the nodes of the supports carry along: summed, it is the body's mass.
template <int dim>
std::array<Vector, dim> mass_of_translations(const Body<dim>& body, ElementKernel<dim>& mass) {
  const Space<dim>& space = body.fine;
  std::array<Vector, dim> result;
  result.fill(space.vector());
  std::vector<dealii::types::global_dof_index> indices(space.element.n_dofs_per_cell());
  dealii::Vector<double> translation(unsigned(indices.size())), force(translation);
  for_each_element(body, mass, space.vector(),
                   [&](const CellIterator<dim>& cell, const dealii::FullMatrix<double>& matrix,
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

template <int dim>
GeneralisedAlpha<dim>::GeneralisedAlpha(const Body<dim>& body, ElementKernel<dim>& stiffness,
                                        ElementKernel<dim>& mass, double retardation_time,
                                        bool with_coarse_matrix, LinearMemory<dim> memory)
    : body_(body),
      stiffness_kernel_(stiffness),
      mass_kernel_(mass),
      retardation_time_(retardation_time),
      memory_(std::move(memory)),
      stiffness_(assembled(body, stiffness)),
      mass_(assembled(body, mass)),
      mass_of_(mass_of_translations(body, mass)),
      effective_(std::make_unique<LinearSystem>(body, with_coarse_matrix)),
      u_(body.fine.vector()),
      v_(u_),
      a_(u_),
      end_acceleration_(u_) {}

template <int dim>
void GeneralisedAlpha<dim>::set_state(const Vector& displacement, const Vector& velocity,
                                      const Vector& acceleration) {
  u_ = displacement;
  v_ = velocity;
  a_ = acceleration;
  end_acceleration_ = acceleration;
}

template <int dim>
void GeneralisedAlpha<dim>::set_step(double step, FieldSolver& solver) {
  constexpr double round_off = 1e-9;  // of a length divided into equal steps
  if (std::abs(step - step_) <= round_off * step) return;
  step_ = step;
  memory_.set_step(step);
  std::vector<Weighted<dim>> terms = {{stiffness_kernel_, 1.0 + 1.5 * retardation_time_ / step},
                                      {mass_kernel_, 2.0 / (step * step)}};
  if (!memory_.empty()) terms.push_back({memory_.kernel(), memory_.stiffening()});
  SumKernel<dim> kernel(terms);
  assemble(body_, kernel, body_.fine.vector(), *effective_);
  solver.set_matrix(*effective_);
}

template <int dim>
Vector GeneralisedAlpha<dim>::load(const meshes::Vector3& frame_acceleration) const {
  Vector inertial = u_, viscous = u_, result = u_, part = u_;
  inertial.sadd(2.0 / (step_ * step_), 2.0 / step_, v_);
  // v' = 3 u'/(2 dt) - w with w = 3 u/(2 dt) + v/2 - dt a/4: C w moves to the right.
  viscous.sadd(1.5 / step_, 0.5, v_);
  viscous.add(-0.25 * step_, a_);
  viscous *= retardation_time_;
  mass_.vmult(result, inertial);
  stiffness_.vmult(part, viscous);
  result += part;
  memory_.add_load(u_, result);
  if (!frame_acceleration.isZero(0.0)) result += inertial_force(frame_acceleration);
  return result;
}

template <int dim>
Vector GeneralisedAlpha<dim>::inertial_force(const meshes::Vector3& frame_acceleration) const {
  Vector force = body_.fine.vector();
  for (unsigned c = 0; c < dim; ++c)
    force.add(-frame_acceleration[Kinematics<dim>::axis[c]], mass_of_[c]);
  return force;
}

template <int dim>
void GeneralisedAlpha<dim>::advance(const Vector& displacement) {
  Vector travel = displacement;
  travel -= u_;
  end_acceleration_ = travel;  // 2 (u' - u - dt v)/dt²
  end_acceleration_.sadd(2.0 / (step_ * step_), -2.0 / step_, v_);
  v_ *= -0.5;
  v_.add(1.5 / step_, travel, 0.25 * step_, a_);
  a_ *= 0.5;
  a_.add(0.5, end_acceleration_);
  memory_.advance(u_, displacement);
  u_ = displacement;
}

template <int dim>
MechanicalEnergy GeneralisedAlpha<dim>::energy() const {
  Vector force = u_;
  stiffness_.vmult(force, u_);
  const double elastic = 0.5 * (force * u_) + memory_.energy();
  mass_.vmult(force, v_);
  return {0.5 * (force * v_), elastic};
}

template <int dim>
double GeneralisedAlpha<dim>::dissipation_rate() const {
  Vector force = u_;
  stiffness_.vmult(force, v_);
  return retardation_time_ * (force * v_) + memory_.dissipation_rate();
}

template <int dim>
meshes::Vector3 GeneralisedAlpha<dim>::momentum_rate() const {
  return sums(end_acceleration_);
}

template <int dim>
meshes::Vector3 GeneralisedAlpha<dim>::momentum() const {
  return sums(v_);
}

template <int dim>
Vector GeneralisedAlpha<dim>::residual() const {
  Vector retarded = u_;
  retarded.add(retardation_time_, v_);
  Vector result = unconstrained_force(body_, stiffness_kernel_, retarded);
  SumKernel<dim> inertial({{mass_kernel_, 1.0}});
  result += unconstrained_force(body_, inertial, end_acceleration_);
  if (!memory_.empty()) result += unconstrained_force(body_, memory_.kernel(), memory_.past());
  return result;
}

template <int dim>
meshes::Vector3 GeneralisedAlpha<dim>::sums(const Vector& field) const {
  meshes::Vector3 result = meshes::Vector3::Zero();
  for (unsigned c = Kinematics<dim>::revolved ? 1 : 0; c < dim; ++c)
    result[Kinematics<dim>::axis[c]] = mass_of_[c] * field;
  return result;
}

template class GeneralisedAlpha<2>;
template class GeneralisedAlpha<3>;

}  // namespace fingertip::fem_reference::inline motion
