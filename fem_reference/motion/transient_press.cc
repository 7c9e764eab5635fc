#include "fem_reference/motion/transient_press.h"

#include <deal.II/base/mpi.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/numerics/data_component_interpretation.h>
#include <deal.II/numerics/data_out.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

#include "fem_reference/contact/plane_contact.h"
#include "fem_reference/elements/kinematics.h"
#include "fem_reference/job/processes.h"
#include "fem_reference/motion/generalised_alpha.h"
#include "fem_reference/output/press_fields.h"
#include "fem_reference/press/press_course.h"
#include "fem_reference/solvers/solver_choice.h"
#include "fem_reference/tip/tip_body.h"
#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline motion {
namespace {

/// No step is longer than this share of R - r over the speed, or of the next sample's time: the
/// force's relative change in a step is largest just after first touch.
constexpr double longest_step = 1.0 / 400.0, longest_step_to_sample = 1.0 / 32.0;
/// Candidates for contact reach this many depths below the pole, because thin rubber rises beside
/// the contact.
constexpr double bulge = 1.2;
/// What makes the whole tip: the meridian, or four quarters.
template <int dim>
constexpr double copies = dim == 2 ? 1.0 : 4.0;

template <int dim>
std::unique_ptr<Body<dim>> read_body(const ReferenceJob& job,
                                     const std::filesystem::path& mesh_file,
                                     const std::filesystem::path& adapted) {
  auto body = read_tip<dim>(MPI_COMM_WORLD, mesh_file, job.degree, 0.0, job.geometry);
  if (!adapted.empty()) body->triangulation.load((adapted / "mesh").string());
  body->number(tip_supports<dim>());
  return body;
}

double radius(const SurfaceNode& node) {
  return std::hypot(node.position.x(), node.position.y());
}

}  // namespace

/// What TransientPress asks of a model, whatever its dimension.
class TransientModel {
 public:
  TransientModel(const ReferenceJob& the_job, std::function<bool()> stop)
      : job(the_job), course(job.protocol, true), stop_requested(std::move(stop)) {
    steps.push_back({});
  }
  virtual ~TransientModel() = default;

  virtual MeshSummary mesh() const = 0;
  /// One step to a place [m] of the course that takes `duration` [s].
  virtual void step_to(double place, double duration, PressState& effort) = 0;
  virtual PressState evaluate() const = 0;
  virtual double bond_force() const = 0;
  virtual void write_fields(const std::filesystem::path& file) const = 0;

  const ReferenceJob job;
  const PressCourse course;
  double place = 0.0;  ///< [m]
  const std::function<bool()> stop_requested;
  double step_factor = 1.0;
  std::vector<TransientStep> steps;
};

namespace {

template <int dim>
class TipInMotion final : public TransientModel {
 public:
  TipInMotion(const ReferenceJob& the_job, std::unique_ptr<Body<dim>> the_body,
              std::function<bool()> stop)
      : TransientModel(the_job, std::move(stop)),
        body(std::move(the_body)),
        stiffness(job.rubber, job.volumetric),
        mass(job.rubber.density),
        solver_kind(choose_solver(job, double(body->unknowns()))),
        motion(*body, stiffness, mass, job.rubber.retardation_time,
               solver_kind == LinearSolver::multigrid, LinearMemory<dim>(*body, job)),
        rubber_mass(job.rubber.density * volume(*body)) {
    ContactUnknowns candidates =
        contact_unknowns(within_reach(outer_nodes(*body), job.protocol, touch(),
                                      bulge * job.protocol.samples.back()),
                         job.protocol.contact != meshes::ContactMode::frictionless);
    solver = make_solver(candidates.unknowns);
    contact = std::make_unique<PlaneContact>(std::move(candidates), job.protocol.contact, pose(0.0),
                                             job.protocol.friction, job.rubber.shear_modulus,
                                             job.protocol.obstacle);
  }

  MeshSummary mesh() const override {
    return {std::size_t(body->triangulation.n_global_active_cells()), std::size_t(body->unknowns()),
            contact->unknowns().unknowns.size(), solver_kind};
  }

  void step_to(double next, double duration, PressState& effort) override {
    const meshes::Vector3 before = frame_acceleration(place), now = frame_acceleration(next);
    const Vector rest = motion.displacement();
    const Eigen::VectorXd reaction = contact->reactions();
    const Eigen::VectorXd displacement = contact->committed().displacement;
    const double dissipation = motion.dissipation_rate();
    motion.set_step(duration, *solver);
    solver->set_load(motion.load(now));
    const ContactEffort spent = contact->solve(*solver, pose(course.at(next).indentation));
    motion.advance(solver->field());
    contact->commit();
    ++effort.steps;
    effort.active_set_iterations += spent.rounds;
    effort.cg_iterations += spent.cg_iterations;
    // Work and dissipation by the trapezoidal rule.
    double work =
        0.5 *
        (reaction + contact->reactions()).dot(contact->committed().displacement - displacement);
    const meshes::Vector3 mean = 0.5 * (before + now);
    if (!mean.isZero(0.0)) {
      Vector travel = motion.displacement();
      travel -= rest;
      work += motion.inertial_force(mean) * travel;
    }
    place = next;
    record(copies<dim> * work,
           copies<dim> * 0.5 * duration * (dissipation + motion.dissipation_rate()));
  }

  double bond_force() const override {
    const auto bond = dealii::types::boundary_id(meshes::PhysicalTag::bond);
    double force = resultant(*body, motion.residual(), bond).z();
    // In a frame that accelerates the bond's nodes carry what mass the free ones do not.
    const meshes::Vector3 acceleration = frame_acceleration(place);
    if (!acceleration.isZero(0.0)) {
      const Vector carried = motion.inertial_force(acceleration);
      force += rubber_mass * acceleration.z() + carried.mean_value() * double(carried.size());
    }
    return copies<dim> * force;
  }

  PressState evaluate() const override {
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
      const SurfaceNode& node = contact->unknowns().nodes[i];
      if (contact->status()[i] == NodeStatus::open || node.area == 0.0) continue;
      state.contact.push_back({radius(node), -contact->reaction(i).z() / node.area});
      if (radius(node) < outermost) continue;
      outermost = radius(node);
      state.node_spacing = dim == 2 ? node.area / circumference(dealii::Point<2>(radius(node), 0.0))
                                    : std::sqrt(node.area);
    }
    std::ranges::sort(state.contact, {}, &ContactPoint::radius);
    sample.contact_radius = contact_edge(state.contact, state.node_spacing, dim == 2 ? 1 : 4);
    sample.max_pressure =
        state.contact.empty()
            ? 0.0
            : std::ranges::max(state.contact, {}, &ContactPoint::pressure).pressure;
    return state;
  }

  void write_fields(const std::filesystem::path& file) const override {
    using namespace dealii::DataComponentInterpretation;
    const Space<dim>& space = body->fine;
    const Vector u = space.ghosted(motion.displacement());
    const Vector v = space.ghosted(motion.velocity());
    const std::vector<DataComponentInterpretation> vector(dim, component_is_part_of_vector);
    // With Kelvin-Voigt damping the stress is that of u + tau v.
    Vector strained = motion.displacement();
    strained.add(job.rubber.retardation_time, motion.velocity());
    const StressField<dim> stress(*body, job, strained, {motion.memory().past(), {}});
    const ContactField<dim> touch(*body, *contact, outer_area(*body, nullptr));
    FieldOutput<dim> out;
    out.add_data_vector(space.dofs, u, std::vector<std::string>(dim, "displacement"), vector);
    out.add_data_vector(space.dofs, v, std::vector<std::string>(dim, "velocity"), vector);
    stress.add_to(out);
    touch.add_to(out);
    out.build_patches(body->mapping, unsigned(job.degree),
                      dealii::DataOut<dim>::curved_inner_cells);
    out.write(file, job.field_sectors);
  }

 private:
  std::unique_ptr<FieldSolver> make_solver(const std::vector<long>& unknowns) const {
    if constexpr (dim == 3)
      if (solver_kind == LinearSolver::multigrid)
        return make_multigrid_solver(*body, unknowns, job.solver_tolerance);
    return make_condensed_solver(*body, unknowns);
  }

  /// Of the rod, whose axis the press follows.
  meshes::Vector3 frame_acceleration(double at) const {
    return course.acceleration(at) * meshes::Vector3::UnitZ();
  }
  double touch() const { return meshes::first_touch(job.geometry, 0.0, job.protocol.obstacle); }
  PlanePose pose(double indentation) const { return {touch() - indentation, 0.0}; }

  void record(double work, double dissipated) {
    double push = 0.0;
    for (std::size_t i = 0; i < contact->unknowns().nodes.size(); ++i)
      push -= contact->reaction(i).z();
    const MechanicalEnergy energy = motion.energy();
    const TransientStep& last = steps.back();
    TransientStep next;
    next.time = course.time(place);
    next.indentation = course.at(place).indentation;
    next.contact_force = copies<dim> * push;
    // In a frame that accelerates by b the momentum of space changes by mass times b more.
    next.normal_force =
        next.contact_force +
        copies<dim> * (motion.momentum_rate().z() + rubber_mass * course.acceleration(place));
    next.momentum = -copies<dim> * motion.momentum().z();
    next.kinetic_energy = copies<dim> * energy.kinetic;
    next.elastic_energy = copies<dim> * energy.elastic;
    next.work = last.work + work;
    next.dissipated_energy = last.dissipated_energy + dissipated;
    steps.push_back(next);
  }

  std::unique_ptr<Body<dim>> body;
  HookeKernel<dim> stiffness;
  MassKernel<dim> mass;
  LinearSolver solver_kind;
  GeneralisedAlpha<dim> motion;
  double rubber_mass;  ///< of what is meshed [kg]
  std::unique_ptr<PlaneContact> contact;
  std::unique_ptr<FieldSolver> solver;
};

std::unique_ptr<TransientModel> make_model(const ReferenceJob& job,
                                           const std::filesystem::path& mesh_file,
                                           const std::filesystem::path& adapted,
                                           std::function<bool()> stop) {
  if (job.axisymmetric())
    return std::make_unique<TipInMotion<2>>(job, read_body<2>(job, mesh_file, adapted),
                                            std::move(stop));
  return std::make_unique<TipInMotion<3>>(job, read_body<3>(job, mesh_file, adapted),
                                          std::move(stop));
}

}  // namespace

TransientPress::TransientPress(const ReferenceJob& job, const std::filesystem::path& mesh_file,
                               const std::filesystem::path& adapted,
                               std::function<bool()> stop_requested)
    : model_(make_model(job, mesh_file, adapted, std::move(stop_requested))) {}

TransientPress::~TransientPress() = default;

MeshSummary TransientPress::mesh() const {
  return model_->mesh();
}

void TransientPress::set_step_factor(double factor) {
  model_->step_factor = factor;
}

PressState TransientPress::advance(double place) {
  TransientModel& self = *model_;
  const auto start = std::chrono::steady_clock::now();
  const double first = self.place, way = place - first;
  const PressCourse::Leg& leg = self.course.leg(place);
  double longest = longest_step * self.job.geometry.thickness() / std::max(1.0, leg.rate);
  if (leg.rate > 0.0)
    longest = std::min(longest, longest_step_to_sample * (place - leg.begin));
  else  // what shook has died
    longest = std::max(longest, longest_step_to_sample * (first - leg.begin));
  const int count = std::max(1, int(std::ceil(way / (self.step_factor * longest) - 1e-9)));
  const double duration = way / count / self.job.protocol.speed;
  PressState effort;
  for (int i = 1; i <= count; ++i) {
    stop_if_asked(self.stop_requested);
    self.step_to(i == count ? place : first + way * i / count, duration, effort);
  }
  PressState state = self.evaluate();
  state.steps = effort.steps;
  state.active_set_iterations = effort.active_set_iterations;
  state.cg_iterations = effort.cg_iterations;
  state.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return state;
}

double TransientPress::bond_force() const {
  return model_->bond_force();
}

const std::vector<TransientStep>& TransientPress::steps() const {
  return model_->steps;
}

void TransientPress::write_fields(const std::filesystem::path& file) const {
  model_->write_fields(file);
}

}  // namespace fingertip::fem_reference::inline motion
