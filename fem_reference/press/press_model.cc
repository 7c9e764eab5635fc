#include "fem_reference/press/press_model.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "fem_reference/elements/kinematics.h"
#include "fem_reference/job/processes.h"
#include "fem_reference/solvers/solver_choice.h"
#include "fem_reference/tip/job_mesh.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::fem_reference::inline press {
namespace {

using meshes::ContactMode;

/// Candidates for contact reach this many depths below the pole, because thin rubber rises beside
/// the contact before it meets the plane, the more the larger the strain.
constexpr double linear_bulge = 1.2, finite_bulge = 2.0;
constexpr int max_newton_iterations = 25;
/// A tangent serves again where an iteration left at most this share of the forces that were out of
/// balance before. Not in the first two: the first finds where new nodes touch.
constexpr double chord_progress = 0.05;
constexpr int max_backtracks = 6;
/// Equilibrium: out-of-balance forces over the contact forces, at a sample and on the way to it.
constexpr double balanced = 1e-7, nearly_balanced = 1e-4;
/// What touches may be this many R off a curved obstacle.
constexpr double on_surface = 1e-8;
/// Contact forces below this many G R² are not resolved to the full tolerance.
constexpr double least_force = 1e-4;

meshes::Vector3 contact_centre(const ReferenceJob& job) {
  if (job.geometry.is_dome() || job.axisymmetric()) return meshes::Vector3::Zero();
  const double tilt = job.protocol.tilt;
  return Eigen::AngleAxisd(-tilt, meshes::Vector3::UnitY()) *
         meshes::touched_first(job.geometry, tilt, job.protocol.obstacle);
}

}  // namespace

template <int dim>
TipPress<dim>::TipPress(const ReferenceJob& job, const std::filesystem::path& mesh_file,
                        std::function<bool()> stop_requested)
    : ContinuumPress(job, std::move(stop_requested)),
      sector_(sector(job)),
      touch_(meshes::first_touch(job.geometry, job.protocol.tilt, job.protocol.obstacle)),
      centre_(contact_centre(job)),
      body_(read_tip<dim>(MPI_COMM_WORLD, mesh_file, job.degree, job.protocol.tilt, job.geometry,
                          job.protocol.twists() ? 3 : dim)),
      kernel_(make_kernel<dim>(job, 1.0, 0.0)) {
  body_->number(tip_supports<dim>(body_->components()));
  prepare();
}

template <int dim>
std::unique_ptr<FieldSolver> TipPress<dim>::make_solver(const std::vector<long>& unknowns) const {
  if constexpr (dim == 3)
    if (solver_kind_ == LinearSolver::multigrid)
      return make_multigrid_solver(*body_, unknowns, job_.solver_tolerance,
                                   job_.strain == Strain::finite ? newton_forcing : 0.0);
  return job_.strain == Strain::finite ? make_eliminating_solver(*body_, unknowns)
                                       : make_condensed_solver(*body_, unknowns);
}

template <int dim>
void TipPress<dim>::prepare() {
  solver_kind_ = choose_solver(job_, double(body_->unknowns()));
  outer_nodes_ = outer_nodes(*body_);
  markers_.emplace(*body_, job_);
  const double bulge = job_.strain == Strain::finite ? finite_bulge : linear_bulge;
  const bool curved = job_.strain == Strain::finite && !job_.protocol.obstacle.is_plane();
  ContactUnknowns candidates = contact_unknowns(
      within_reach(outer_nodes_, job_.protocol, touch_, bulge * job_.protocol.samples.back()),
      curved || job_.protocol.contact != ContactMode::frictionless);
  solver_ = make_solver(candidates.unknowns);
  contact_ = std::make_unique<PlaneContact>(std::move(candidates), job_.protocol.contact, pose(0.0),
                                            job_.protocol.friction, job_.rubber.shear_modulus,
                                            job_.protocol.obstacle, job_.strain == Strain::finite);
  place_ = 0.0;
  displacement_.reinit(body_->fine.vector());
  way_ = keeps_way(job_) ? KnownWay(0, {{0.0, displacement_}}, 0.0, displacement_) : KnownWay();
  system_ = std::make_unique<LinearSystem>(*body_, solver_kind_ == LinearSolver::multigrid);
  if (job_.strain == Strain::linear) {
    linear_memory_ = LinearMemory<dim>(*body_, job_);
    kernel_ = make_kernel<dim>(job_, 1.0, 0.0);
    assemble(*body_, *kernel_, displacement_, *system_);
    solver_->set_matrix(*system_);
  } else {
    point_memory_ = PointMemory<dim>(*body_, job_);
  }
  marks_.clear();
}

template <int dim>
MeshSummary TipPress<dim>::mesh() const {
  return {std::size_t(body_->triangulation.n_global_active_cells()), std::size_t(body_->unknowns()),
          contact_->unknowns().unknowns.size(), solver_kind_};
}

template <int dim>
PlanePose TipPress<dim>::pose(double place) const {
  const meshes::PressPose pose = course_.at(place);
  return {touch_ - pose.indentation, pose.lateral, pose.twist};
}

template <int dim>
void TipPress<dim>::step(double place, bool sampled, PressEffort& effort) {
  const PlanePose target = pose(place);
  const Vector before = displacement_;
  prepare_step(course_.time(place - place_));
  if (job_.strain == Strain::linear)
    linear_step(target, effort);
  else
    newton_step(place, sampled, effort);
  try {
    check_other_nodes(place);
  } catch (...) {
    displacement_ = before;
    throw;
  }
  contact_->commit();
  linear_memory_.advance(before, displacement_);
  point_memory_.advance(displacement_);
  if (keeps_way(job_)) way_.pass(place, displacement_);
  place_ = place;
}

template <int dim>
Vector TipPress<dim>::foreseen(double place) {
  if (!way_.reaches(place)) return displacement_;
  Vector end = way_.known(place);
  const Eigen::VectorXd start = at_contact(way_.known(place_)), there = at_contact(end);
  // So that short steps start near where they end: what one mesh finds is rough on a finer one.
  end += way_.difference();
  ForeknownStep step{at_contact(end), {}, {}};
  for (const double between : way_.until(place)) {
    const double time = (between - place_) / (place - place_);
    step.times.push_back(time);
    step.bends.emplace_back(at_contact(way_.known(between)) - (1.0 - time) * start - time * there);
  }
  contact_->foresee(std::move(step), pose(place));
  return end;
}

template <int dim>
void TipPress<dim>::prepare_step(double duration) {
  if (!point_memory_.empty()) {
    point_memory_.start_step(duration);
    kernel_ = make_kernel<dim>(job_, 1.0, point_memory_.stiffening(), point_memory_.carried());
  }
  if (linear_memory_.empty()) return;
  if (linear_memory_.set_step(duration)) {
    kernel_ = make_kernel<dim>(job_, 1.0, linear_memory_.stiffening());
    assemble(*body_, *kernel_, body_->fine.vector(), *system_);
    solver_->set_matrix(*system_);
  }
  Vector load = body_->fine.vector();
  linear_memory_.add_load(displacement_, load);
  solver_->set_load(load);
}

template <int dim>
void TipPress<dim>::linear_step(const PlanePose& target, PressEffort& effort) {
  const ContactEffort spent = contact_->solve(*solver_, target);
  effort.active_set_iterations += spent.rounds;
  effort.cg_iterations += spent.cg_iterations;
  displacement_ = solver_->field();
}

template <int dim>
Eigen::VectorXd TipPress<dim>::at_contact(const Vector& field) const {
  const std::vector<double> values = body_->fine.gather(field, contact_->unknowns().unknowns);
  return Eigen::Map<const Eigen::VectorXd>(values.data(), Eigen::Index(values.size()));
}

template <int dim>
double TipPress<dim>::residual(const Vector& displacement, const PlanePose& target) {
  assemble_force(*body_, *kernel_, displacement, *system_);
  off_surface_ = contact_->curved() ? contact_->linearise(at_contact(displacement), target) : 0.0;
  Vector out_of_balance = system_->force;
  const Eigen::VectorXd left = contact_->out_of_balance(at_contact(system_->force));
  const std::vector<long>& unknowns = contact_->unknowns().unknowns;
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    if (!body_->fine.owned.is_element(unsigned(unknowns[i]))) continue;
    out_of_balance.begin()[body_->fine.owned.index_within_set(unsigned(unknowns[i]))] =
        left[Eigen::Index(i)];
  }
  // Round-off of the stresses, some 1e-16 G R² a node, must stay below the tolerance.
  const double floor =
      least_force * job_.rubber.shear_modulus * job_.geometry.tip_radius * job_.geometry.tip_radius;
  return out_of_balance.l2_norm() / std::max(contact_->reactions().norm(), floor);
}

template <int dim>
void TipPress<dim>::newton_step(double place, bool sampled, PressEffort& effort) {
  const PlanePose target = pose(place);
  const double wanted = sampled ? balanced : nearly_balanced;
  // An iterative solver leaves out-of-balance forces of its own.
  const double enough = solver_kind_ == LinearSolver::multigrid
                            ? std::max(wanted, 10.0 * job_.solver_tolerance)
                            : wanted;
  Vector u = foreseen(place);
  bool stale = true;  // the tangent
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_newton_iterations; ++iteration) {
    stop_if_asked(stop_requested_);
    ++effort.newton_iterations;
    const bool new_tangent = std::exchange(stale, false);
    if (new_tangent) assemble(*body_, *kernel_, u, *system_);
    if (contact_->curved()) {
      contact_->linearise(at_contact(u), target);
      solver_->set_axes(contact_->axes());
    }
    if (new_tangent || contact_->curved()) solver_->set_matrix(*system_);
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
      if (backtracks > max_backtracks)
        throw meshes::NotConverged("Newton's method found no step that brings equilibrium nearer");
      u = start;
      u.add(factor, full_step);
      try {
        norm = residual(u, target);
        if (!same_contact || norm < last || norm < enough) break;
      } catch (const meshes::NotConverged&) {  // an element turned inside out
      }
      if (new_tangent) continue;
      u = start;  // try again with the tangent there
      stale = true;
      break;
    }
    if (stale) continue;
    const bool touching = off_surface_ < on_surface * job_.geometry.tip_radius;
    if (factor == 1.0 && norm < enough && touching) {
      displacement_ = u;
      return;
    }
    stale = iteration == 0 || norm > chord_progress * last;
    last = norm;
  }
  throw meshes::NotConverged("Newton's method did not converge within " +
                             std::to_string(max_newton_iterations) + " iterations");
}

template <int dim>
std::vector<meshes::Vector3> TipPress<dim>::displacements(
    const std::vector<SurfaceNode>& nodes) const {
  std::vector<meshes::Vector3> result(nodes.size(), meshes::Vector3::Zero());
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<long> unknowns;
    for (const SurfaceNode& node : nodes) unknowns.push_back(node.unknown[c]);
    const std::vector<double> values = body_->fine.gather(displacement_, unknowns);
    for (std::size_t i = 0; i < nodes.size(); ++i) result[i][Eigen::Index(c)] = values[i];
  }
  return result;
}

template <int dim>
void TipPress<dim>::check_other_nodes(double place) const {
  const PlanePose plane = pose(place);
  const meshes::PressPose at = course_.at(place);
  const double deep = -1e-6 * job_.geometry.tip_radius;
  const std::vector<meshes::Vector3> moved = displacements(outer_nodes_);
  std::set<long> candidates;
  for (const SurfaceNode& node : contact_->unknowns().nodes) candidates.insert(node.unknown[2]);
  for (std::size_t i = 0; i < moved.size(); ++i)
    if (!candidates.contains(outer_nodes_[i].unknown[2]) &&
        contact_->gap(outer_nodes_[i].position, moved[i], plane) < deep)
      throw meshes::NotConverged(
          "the rubber rises through the " + std::string(name(job_.protocol.obstacle.shape)) +
          " far beside the contact at an indentation of " + meshes::to_text(at.indentation) +
          " m and a lateral displacement of " + meshes::to_text(at.lateral) +
          " m; press less deep or move less far");
}

template <int dim>
meshes::Vector3 TipPress<dim>::bond_reaction() const {
  const PointStresses kept = point_memory_.past();
  const auto kernel = make_kernel<dim>(job_, 1.0, 0.0, point_memory_.empty() ? nullptr : &kept);
  Vector force = unconstrained_force(*body_, *kernel, displacement_);
  if (!linear_memory_.empty())
    force += unconstrained_force(*body_, linear_memory_.kernel(), linear_memory_.past());
  return resultant(*body_, force, dealii::types::boundary_id(meshes::PhysicalTag::bond));
}

template class TipPress<2>;
template class TipPress<3>;

std::unique_ptr<ContinuumPress> ContinuumPress::on(const ReferenceJob& job,
                                                   const std::filesystem::path& mesh_file,
                                                   std::function<bool()> stop_requested) {
  if (job.axisymmetric())
    return std::make_unique<TipPress<2>>(job, mesh_file, std::move(stop_requested));
  return std::make_unique<TipPress<3>>(job, mesh_file, std::move(stop_requested));
}

}  // namespace fingertip::fem_reference::inline press
