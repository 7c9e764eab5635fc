#include "fem_reference/press_model.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fem_reference/solver_choice.h"
#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::fem_reference {
namespace {

using meshes::ContactMode;

/// Candidates for contact reach this many depths below the pole, because thin rubber rises beside
/// the contact before it meets the plane, the more the larger the strain.
constexpr double linear_bulge = 1.2, finite_bulge = 2.0;
constexpr int most_newton_iterations = 25;
/// A tangent serves again where an iteration left at most this share of the forces that were out of
/// balance before. Not in the first two: the first finds where new nodes touch.
constexpr double chord_progress = 0.05;
constexpr int most_backtracks = 6;
/// Equilibrium: out-of-balance forces over the contact forces, at a sample and on the way to it.
constexpr double balanced = 1e-7, nearly_balanced = 1e-4;
/// Contact forces below this many G R² are not resolved to the full tolerance.
constexpr double least_force = 1e-4;

template <int dim>
std::unique_ptr<ElementKernel<dim>> make_kernel(const ReferenceJob& job) {
  if (job.strain == Strain::linear)
    return std::make_unique<HookeKernel<dim>>(job.rubber, job.volumetric);
  return std::make_unique<HyperelasticKernel<dim>>(HyperelasticLaw(job.law, job.rubber),
                                                   job.volumetric);
}

}  // namespace

template <int dim>
TipPress<dim>::TipPress(const ReferenceJob& job, const std::filesystem::path& mesh_file)
    : PressModel(job),
      path_(job.protocol),
      body_(read_tip<dim>(MPI_COMM_WORLD, mesh_file, job.degree, job.protocol.tilt, job.geometry)),
      kernel_(make_kernel<dim>(job)) {
  body_->number(tip_supports<dim>());
  prepare();
}

template <int dim>
std::unique_ptr<FieldSolver> TipPress<dim>::make_solver(const std::vector<long>& unknowns) const {
  if constexpr (dim == 3)
    if (solver_kind_ == LinearSolver::multigrid)
      return make_multigrid_solver(*body_, unknowns, job_.solver_tolerance);
  return job_.strain == Strain::finite ? make_eliminating_solver(*body_, unknowns)
                                       : make_condensed_solver(*body_, unknowns);
}

template <int dim>
void TipPress<dim>::prepare() {
  solver_kind_ = choose_solver(job_, double(body_->unknowns()));
  outer_nodes_ = outer_nodes(*body_);
  const double bulge = job_.strain == Strain::finite ? finite_bulge : linear_bulge;
  ContactUnknowns candidates =
      contact_unknowns(outer_nodes_, job_.protocol.contact != ContactMode::frictionless,
                       job_.geometry.pole() - bulge * job_.protocol.samples.back());
  solver_ = make_solver(candidates.unknowns);
  contact_ = std::make_unique<PlaneContact>(std::move(candidates), job_.protocol.contact, pose(0.0),
                                            job_.protocol.friction, job_.rubber.shear_modulus);
  place_ = 0.0;
  displacement_.reinit(body_->fine.vector());
  system_ = std::make_unique<LinearSystem>(*body_, solver_kind_ == LinearSolver::multigrid);
  if (job_.strain == Strain::linear) linearise(displacement_);
  marks_.clear();
}

template <int dim>
MeshSummary TipPress<dim>::mesh() const {
  return {std::size_t(body_->triangulation.n_global_active_cells()), std::size_t(body_->unknowns()),
          contact_->unknowns().unknowns.size(), solver_kind_};
}

template <int dim>
PlanePose TipPress<dim>::pose(double place) const {
  const meshes::PressPose pose = path_.at(place);
  return {job_.geometry.pole() - pose.indentation, pose.lateral};
}

template <int dim>
void TipPress<dim>::abandon() {
  contact_->abandon();
}

template <int dim>
void TipPress<dim>::step(double place, bool sampled, PressState& effort) {
  const PlanePose target = pose(place);
  const Vector before = displacement_;
  if (job_.strain == Strain::linear)
    linear_step(target, effort);
  else
    newton_step(target, sampled, effort);
  try {
    check_other_nodes(place);
  } catch (...) {
    displacement_ = before;
    throw;
  }
  contact_->commit();
  place_ = place;
}

template <int dim>
void TipPress<dim>::linear_step(const PlanePose& target, PressState& effort) {
  const ContactEffort spent = contact_->solve(*solver_, target);
  effort.active_set_iterations += spent.rounds;
  effort.cg_iterations += spent.cg_iterations;
  displacement_ = solver_->field();
}

template <int dim>
void TipPress<dim>::linearise(const Vector& displacement) {
  assemble(*body_, *kernel_, displacement, *system_);
  solver_->set_matrix(*system_);
}

template <int dim>
double TipPress<dim>::residual(const Vector& displacement) {
  assemble_force(*body_, *kernel_, displacement, *system_);
  Vector out_of_balance = system_->force;
  const std::vector<char> held = contact_->held();
  const std::vector<long>& unknowns = contact_->unknowns().unknowns;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (!body_->fine.owned.is_element(unsigned(unknowns[i]))) continue;
    double& entry =
        out_of_balance.begin()[body_->fine.owned.index_within_set(unsigned(unknowns[i]))];
    entry = held[i] ? 0.0 : entry - contact_->reactions()[Eigen::Index(i)];
  }
  // Round-off of the stresses, some 1e-16 G R² a node, must stay below the tolerance.
  const double floor =
      least_force * job_.rubber.shear_modulus * job_.geometry.tip_radius * job_.geometry.tip_radius;
  return out_of_balance.l2_norm() / std::max(contact_->reactions().norm(), floor);
}

template <int dim>
void TipPress<dim>::newton_step(const PlanePose& target, bool sampled, PressState& effort) {
  const double wanted = sampled ? balanced : nearly_balanced;
  // An iterative solver leaves out-of-balance forces of its own.
  const double enough = solver_kind_ == LinearSolver::multigrid
                            ? std::max(wanted, 10.0 * job_.solver_tolerance)
                            : wanted;
  Vector u = displacement_;
  bool stale = true;  // the tangent
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < most_newton_iterations; ++iteration) {
    ++effort.newton_iterations;
    const bool new_tangent = std::exchange(stale, false);
    if (new_tangent) linearise(u);
    Vector load = u;  // of the system linearised at u, for the whole displacement
    system_->matrix.vmult(load, u);
    load -= system_->force;
    solver_->set_load(load);
    const std::vector<NodeStatus> before = contact_->status();
    const ContactEffort spent = contact_->solve(*solver_, target);
    effort.active_set_iterations += spent.rounds;
    effort.cg_iterations += spent.cg_iterations;
    const bool same_contact = iteration > 0 && contact_->status() == before;

    const Vector start = u, full_step = [&] {
      Vector step = solver_->field();
      step -= start;
      return step;
    }();
    double factor = 1.0, norm = 0.0;
    for (int backtracks = 0;; ++backtracks, factor /= 2) {
      if (backtracks > most_backtracks)
        throw meshes::NotConverged("Newton's method found no step that brings equilibrium nearer");
      u = start;
      u.add(factor, full_step);
      try {
        norm = residual(u);
        if (!same_contact || norm < last || norm < enough) break;
      } catch (const meshes::NotConverged&) {  // an element turned inside out
      }
      if (new_tangent) continue;
      u = start;  // try again with the tangent there
      stale = true;
      break;
    }
    if (stale) continue;
    if (factor == 1.0 && norm < enough) {
      displacement_ = u;
      return;
    }
    stale = iteration == 0 || norm > chord_progress * last;
    last = norm;
  }
  throw meshes::NotConverged("Newton's method did not converge within " +
                             std::to_string(most_newton_iterations) + " iterations");
}

template <int dim>
void TipPress<dim>::check_other_nodes(double place) const {
  std::vector<long> unknowns;
  for (const SurfaceNode& node : outer_nodes_) unknowns.push_back(node.unknown[2]);
  const std::vector<double> lift = body_->fine.gather(displacement_, unknowns);
  const meshes::PressPose at = path_.at(place);
  const double plane = pose(place).height + 1e-6 * job_.geometry.tip_radius;
  for (std::size_t i = 0; i < lift.size(); ++i)
    if (outer_nodes_[i].position.z() + lift[i] > plane)
      throw meshes::NotConverged(
          "the rubber rises through the plane far beside the contact at an indentation of " +
          meshes::to_text(at.indentation) + " m and a lateral displacement of " +
          meshes::to_text(at.lateral) + " m; press less deep or move less far");
}

template <int dim>
meshes::Vector3 TipPress<dim>::bond_reaction() const {
  return resultant(*body_, unconstrained_force(*body_, *kernel_, displacement_),
                   dealii::types::boundary_id(meshes::PhysicalTag::bond));
}

template class TipPress<2>;
template class TipPress<3>;

}  // namespace fingertip::fem_reference
