/// TransientPress on deal.II's side.
#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/numerics/data_component_interpretation.h>
#include <deal.II/numerics/data_out.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "fem_reference/generalised_alpha.h"
#include "fem_reference/plane_contact.h"
#include "fem_reference/press_fields.h"
#include "fem_reference/run_progress.h"
#include "fem_reference/solver_choice.h"
#include "fem_reference/tip_body.h"
#include "fem_reference/transient.h"
#include "fem_reference/vtu_output.h"
#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

/// No step is longer than this share of R - r over the speed, or of the next sample's time: the
/// force's relative change in a step is largest just after first touch.
constexpr double longest_step = 1.0 / 400.0, longest_step_to_sample = 1.0 / 32.0;
/// Candidates for contact reach this many depths below the pole, because thin rubber rises beside
/// the contact.
constexpr double bulge = 1.2;
/// The quarter counts four times.
constexpr double sectors = 4.0;

std::unique_ptr<Body> read_body(const ReferenceJob& job, const std::filesystem::path& mesh_file,
                                const std::filesystem::path& adapted) {
  auto body = read_tip(MPI_COMM_WORLD, mesh_file, job.degree, 0.0);
  if (!adapted.empty()) body->triangulation.load((adapted / "mesh").string());
  body->number(tip_supports());
  return body;
}

double radius(const SurfaceNode& node) {
  return std::hypot(node.position.x(), node.position.y());
}

}  // namespace

struct TransientPress::Implementation {
  ReferenceJob job;
  std::function<bool()> stop_requested;
  std::unique_ptr<Body> body;
  HookeKernel stiffness;
  MassKernel mass;
  LinearSolver solver_kind;
  GeneralisedAlpha motion;
  std::unique_ptr<PlaneContact> contact;
  std::unique_ptr<FieldSolver> solver;
  double step_factor = 1.0;
  std::vector<TransientStep> steps{};

  Implementation(const ReferenceJob& the_job, std::unique_ptr<Body> the_body,
                 std::function<bool()> stop)
      : job(the_job),
        stop_requested(std::move(stop)),
        body(std::move(the_body)),
        stiffness(job.rubber, job.volumetric),
        mass(job.rubber.density),
        solver_kind(choose_solver(job.solver, double(body->unknowns()))),
        motion(*body, stiffness, mass, job.rubber.retardation_time,
               solver_kind == LinearSolver::multigrid) {
    ContactUnknowns candidates = contact_unknowns(
        outer_nodes(*body), job.protocol.contact != meshes::ContactMode::frictionless,
        job.geometry.tip_radius - bulge * job.protocol.depth);
    solver = solver_kind == LinearSolver::condensed
                 ? make_condensed_solver(*body, candidates.unknowns)
                 : make_multigrid_solver(*body, candidates.unknowns, job.solver_tolerance);
    contact = std::make_unique<PlaneContact>(std::move(candidates), job.protocol.contact, pose(0.0),
                                             job.protocol.friction, job.rubber.shear_modulus);
    steps.push_back({});
  }

  PlanePose pose(double indentation) const { return {job.geometry.tip_radius - indentation, 0.0}; }

  void step_to(double indentation, double duration, PressState& effort) {
    const Eigen::VectorXd reaction = contact->reactions();
    const Eigen::VectorXd displacement = contact->committed().displacement;
    const double dissipation = motion.dissipation_rate();
    motion.set_step(duration, *solver);
    solver->set_load(motion.load());
    const ContactEffort spent = contact->solve(*solver, pose(indentation));
    motion.advance(solver->field());
    contact->commit();
    ++effort.steps;
    effort.active_set_iterations += spent.rounds;
    effort.cg_iterations += spent.cg_iterations;
    // Work and dissipation by the trapezoidal rule.
    const double work =
        0.5 *
        (reaction + contact->reactions()).dot(contact->committed().displacement - displacement);
    record(indentation, sectors * work,
           sectors * 0.5 * duration * (dissipation + motion.dissipation_rate()));
  }

  void record(double indentation, double work, double dissipated) {
    double push = 0.0;
    for (std::size_t i = 0; i < contact->unknowns().nodes.size(); ++i)
      push -= contact->reaction(i).z();
    const MechanicalEnergy energy = motion.energy();
    const TransientStep& last = steps.back();
    TransientStep next;
    next.time = indentation / job.protocol.speed;
    next.indentation = indentation;
    next.contact_force = sectors * push;
    next.normal_force = next.contact_force + sectors * motion.momentum_rate().z();
    next.momentum = -sectors * motion.momentum().z();
    next.kinetic_energy = sectors * energy.kinetic;
    next.elastic_energy = sectors * energy.elastic;
    next.work = last.work + work;
    next.dissipated_energy = last.dissipated_energy + dissipated;
    steps.push_back(next);
  }

  PressState evaluate() const {
    PressState state;
    meshes::PressSample& sample = state.sample;
    sample.indentation = steps.back().indentation;
    sample.time = steps.back().time;
    sample.normal_force = steps.back().normal_force;
    sample.lateral_force_x = sample.lateral_force_y = 0.0;  // by symmetry
    sample.lateral_displacement = 0.0;
    sample.torque_x = sample.torque_y = sample.torque_z = 0.0;
    state.energy = steps.back().elastic_energy;
    state.active_nodes = contact->active_nodes();
    double outermost = 0.0;
    for (std::size_t i = 0; i < contact->status().size(); ++i) {
      if (contact->status()[i] == NodeStatus::open) continue;
      const SurfaceNode& node = contact->unknowns().nodes[i];
      state.contact.push_back({radius(node), -contact->reaction(i).z() / node.area});
      if (radius(node) < outermost) continue;
      outermost = radius(node);
      state.node_spacing = std::sqrt(node.area);
    }
    std::ranges::sort(state.contact, {}, &ContactPoint::radius);
    sample.contact_radius = contact_edge(state.contact, state.node_spacing);
    sample.max_pressure =
        state.contact.empty()
            ? 0.0
            : std::ranges::max(state.contact, {}, &ContactPoint::pressure).pressure;
    return state;
  }
};

TransientPress::TransientPress(const ReferenceJob& job, const std::filesystem::path& mesh_file,
                               const std::filesystem::path& adapted,
                               std::function<bool()> stop_requested)
    : implementation_(std::make_unique<Implementation>(job, read_body(job, mesh_file, adapted),
                                                       std::move(stop_requested))) {}

TransientPress::~TransientPress() = default;

MeshSummary TransientPress::mesh() const {
  const Implementation& self = *implementation_;
  return {std::size_t(self.body->triangulation.n_global_active_cells()),
          std::size_t(self.body->unknowns()), self.contact->unknowns().unknowns.size(),
          self.solver_kind};
}

void TransientPress::set_step_factor(double factor) {
  implementation_->step_factor = factor;
}

PressState TransientPress::advance(double indentation) {
  Implementation& self = *implementation_;
  const auto start = std::chrono::steady_clock::now();
  const double first = self.steps.back().indentation, way = indentation - first;
  const double longest = self.step_factor * std::min(longest_step * self.job.geometry.thickness(),
                                                     longest_step_to_sample * indentation);
  const int count = std::max(1, int(std::ceil(way / longest - 1e-9)));
  const double duration = way / count / self.job.protocol.speed;
  PressState effort;
  for (int i = 1; i <= count; ++i) {
    stop_if_asked(self.stop_requested);
    self.step_to(i == count ? indentation : first + way * i / count, duration, effort);
  }
  PressState state = self.evaluate();
  state.steps = effort.steps;
  state.active_set_iterations = effort.active_set_iterations;
  state.cg_iterations = effort.cg_iterations;
  state.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return state;
}

double TransientPress::bond_force() const {
  const Implementation& self = *implementation_;
  return sectors * resultant(*self.body, self.motion.residual(),
                             dealii::types::boundary_id(meshes::PhysicalTag::bond))
                       .z();
}

const std::vector<TransientStep>& TransientPress::steps() const {
  return implementation_->steps;
}

void TransientPress::write_fields(const std::filesystem::path& file) const {
  using namespace dealii::DataComponentInterpretation;
  const Implementation& self = *implementation_;
  const Space& space = self.body->fine;
  const Vector u = space.ghosted(self.motion.displacement());
  const Vector v = space.ghosted(self.motion.velocity());
  const std::vector<DataComponentInterpretation> vector(dim, component_is_part_of_vector);
  // With Kelvin-Voigt damping the stress is that of u + tau v.
  Vector strained = self.motion.displacement();
  strained.add(self.job.rubber.retardation_time, self.motion.velocity());
  const StressField stress(*self.body, self.job, strained);
  const ContactField contact(*self.body, *self.contact, outer_area(*self.body, nullptr));
  dealii::DataOut<dim> out;
  out.add_data_vector(space.dofs, u, std::vector<std::string>(dim, "displacement"), vector);
  out.add_data_vector(space.dofs, v, std::vector<std::string>(dim, "velocity"), vector);
  stress.add_to(out);
  contact.add_to(out);
  out.build_patches(self.body->mapping, unsigned(self.job.degree),
                    dealii::DataOut<dim>::curved_inner_cells);
  write_vtu(out, file);
}

}  // namespace fingertip::fem_reference
