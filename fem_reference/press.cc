#include "fem_reference/press.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

/// Above this many unknowns the factor outgrows a desktop's memory (4.4 GB peak at 240 000), and
/// multigrid takes over.
constexpr int largest_condensed = 300000;
/// First step and growth of the steps of a stick press, as fractions of the first sample and of
/// the present indentation: contact grows fastest at first touch.
constexpr double first_step = 0.1, step_growth = 0.25;
/// Candidates for contact reach this many depths below the pole, because thin rubber rises beside
/// the contact before it meets the plane.
constexpr double bulge = 1.2;
/// A quarter is computed.
constexpr double sectors = 4.0;

LinearSolver choose(LinearSolver wanted, const ElasticTip& tip) {
  if (wanted != LinearSolver::automatic) return wanted;
  return tip.dofs() <= largest_condensed ? LinearSolver::condensed : LinearSolver::multigrid;
}

double radius(const SurfaceNode& node) {
  return std::hypot(node.position.x(), node.position.y());
}

/// Distance to the nearest other node, averaged over the candidates next to `edge`.
double spacing_around(const std::vector<SurfaceNode>& nodes, double edge) {
  double sum = 0.0;
  int count = 0;
  for (double band = 0.05; count < 3 && band < 10.0; band *= 2) {
    sum = 0.0, count = 0;
    for (const SurfaceNode& node : nodes) {
      if (std::abs(radius(node) - edge) > band * edge) continue;
      double nearest = std::numeric_limits<double>::infinity();
      for (const SurfaceNode& other : nodes)
        if (&other != &node) nearest = std::min(nearest, (other.position - node.position).norm());
      sum += nearest, ++count;
    }
  }
  return count > 0 ? sum / count : 0.0;
}

}  // namespace

double contact_edge(const std::vector<ContactPoint>& contact, double node_spacing) {
  if (contact.empty()) return 0.0;
  const double outermost = contact.back().radius;
  const double inner = std::min(0.75 * outermost, outermost - 3 * node_spacing);
  // Least squares of p² = b - s r² over the outer part.
  double n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (const ContactPoint& point : contact) {
    if (point.radius < inner) continue;
    const double x = point.radius * point.radius, y = point.pressure * point.pressure;
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double denominator = n * sxx - sx * sx;
  if (n < 3 || !(denominator > 0.0)) return outermost;
  const double slope = (n * sxy - sx * sy) / denominator;
  if (!(slope < 0.0)) return outermost;
  const double edge = std::sqrt(std::max(0.0, (sx - sy / slope) / n));
  return std::clamp(edge, outermost - node_spacing, outermost + node_spacing);
}

ContinuumPress::ContinuumPress(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                               meshes::ContactMode contact, double depth,
                               const std::filesystem::path& mesh_file, const Options& options)
    : geometry_(geometry),
      mode_(contact),
      options_(options),
      tip_(rubber, mesh_file, options.degree),
      solver_kind_(choose(options.solver, tip_)) {
  ContactUnknowns candidates =
      fem_reference::contact_unknowns(tip_, contact, geometry.tip_radius - bulge * depth);
  solver_ = solver_kind_ == LinearSolver::condensed
                ? make_condensed_solver(tip_, candidates.unknowns)
                : make_multigrid_solver(tip_, candidates.unknowns, options.tolerance);
  contact_ = std::make_unique<PlaneContact>(std::move(candidates), geometry.tip_radius, *solver_);
  displacement_ = Eigen::VectorXd::Zero(tip_.dofs());
}

ContinuumPress::~ContinuumPress() = default;

int ContinuumPress::contact_unknowns() const {
  return int(contact_->unknowns().unknowns.size());
}

double ContinuumPress::next_step(double target) const {
  if (mode_ == meshes::ContactMode::frictionless) return target;
  const double now = contact_->indentation();
  const double longest = options_.step * geometry_.thickness();
  const double step =
      std::min(longest, now > 0.0 ? step_growth * now : first_step * std::min(target, longest));
  const double pieces = std::ceil((target - now) / step - 1e-9);
  return pieces <= 1.0 ? target : std::min(target, now + std::min(step, (target - now) / pieces));
}

PressState ContinuumPress::advance(double indentation) {
  const auto start = std::chrono::steady_clock::now();
  int steps = 0, active_set_iterations = 0, cg_iterations = 0;
  while (contact_->indentation() < indentation) {
    if (options_.stop_requested && options_.stop_requested())
      throw meshes::Interrupted("stopped on request");
    const ContactStep step = contact_->advance(next_step(indentation));
    ++steps;
    active_set_iterations += step.active_set_iterations;
    cg_iterations += step.cg_iterations;
  }
  displacement_ = solver_->field();
  check_other_nodes();
  PressState state = evaluate();
  state.steps = steps;
  state.active_set_iterations = active_set_iterations;
  state.cg_iterations = cg_iterations;
  state.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return state;
}

void ContinuumPress::check_other_nodes() const {
  const double plane = geometry_.tip_radius - contact_->indentation();
  for (const SurfaceNode& node : tip_.outer_nodes()) {
    const double height = node.position.z() + displacement_[node.dof[2]];
    if (height > plane + 1e-6 * geometry_.tip_radius)
      throw meshes::NotConverged(
          "the rubber rises through the plane far beside the contact at an indentation of " +
          std::to_string(contact_->indentation()) + " m; press less deep");
  }
}

Eigen::VectorXd ContinuumPress::plane_force() const {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(tip_.dofs());
  const std::vector<SurfaceNode>& nodes = contact_->unknowns().nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const meshes::Vector3 reaction = contact_->reaction(i);
    for (int c = 0; c < 3; ++c) force[nodes[i].dof[std::size_t(c)]] = reaction[c];
  }
  return force;
}

PressState ContinuumPress::evaluate() const {
  PressState state;
  const std::vector<SurfaceNode>& nodes = contact_->unknowns().nodes;
  double force = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!contact_->active()[i]) continue;
    const double push = -contact_->reaction(i).z();
    force += push;
    state.contact.push_back({radius(nodes[i]), push / nodes[i].area});
  }
  std::ranges::sort(state.contact, {}, &ContactPoint::radius);
  state.active_nodes = contact_->active_nodes();

  meshes::PressSample& sample = state.sample;
  sample.indentation = contact_->indentation();
  sample.normal_force = sectors * force;
  // By symmetry.
  sample.lateral_force_x = sample.lateral_force_y = 0.0;
  sample.torque_x = sample.torque_y = sample.torque_z = 0.0;
  if (state.contact.empty()) return state;
  state.node_spacing = spacing_around(nodes, state.contact.back().radius);
  sample.contact_radius = contact_edge(state.contact, state.node_spacing);
  sample.max_pressure = std::ranges::max(state.contact, {}, &ContactPoint::pressure).pressure;
  return state;
}

}  // namespace fingertip::fem_reference
