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
#include "fem_reference/press/contact_edge.h"
#include "fem_reference/press/marker_field.h"
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

template <int dim>
class TipInMotion final : public TransientPress {
 public:
  TipInMotion(const ReferenceJob& job, std::unique_ptr<Body<dim>> body,
              std::function<bool()> stop_requested)
      : TransientPress(job, std::move(stop_requested)),
        body_(std::move(body)),
        stiffness_(job.rubber, job.volumetric),
        mass_(job.rubber.density),
        solver_kind_(choose_solver(job, double(body_->unknowns()))),
        motion_(*body_, stiffness_, mass_, job.rubber.retardation_time,
                solver_kind_ == LinearSolver::multigrid, LinearMemory<dim>(*body_, job)),
        markers_(*body_, job),
        rubber_mass_(job.rubber.density * volume(*body_)) {
    ContactUnknowns candidates =
        contact_unknowns(within_reach(outer_nodes(*body_), job_.protocol, touch(),
                                      bulge * job_.protocol.samples.back()),
                         job_.protocol.contact != meshes::ContactMode::frictionless);
    solver_ = make_solver(candidates.unknowns);
    contact_ = std::make_unique<PlaneContact>(std::move(candidates), job_.protocol.contact,
                                              pose(0.0), job_.protocol.friction,
                                              job_.rubber.shear_modulus, job_.protocol.obstacle);
  }

  MeshSummary mesh() const override {
    return {std::size_t(body_->triangulation.n_global_active_cells()),
            std::size_t(body_->unknowns()), contact_->unknowns().unknowns.size(), solver_kind_};
  }

  void step_to(double next, double duration, PressEffort& effort) override {
    const meshes::Vector3 before = frame_acceleration(place_), now = frame_acceleration(next);
    const Vector rest = motion_.displacement();
    const Eigen::VectorXd reaction = contact_->reactions();
    const Eigen::VectorXd displacement = contact_->committed().displacement;
    const double dissipation = motion_.dissipation_rate();
    motion_.set_step(duration, *solver_);
    solver_->set_load(motion_.load(now));
    const ContactEffort spent = contact_->solve(*solver_, pose(course_.at(next).indentation));
    motion_.advance(solver_->field());
    contact_->commit();
    ++effort.steps;
    effort.active_set_iterations += spent.rounds;
    effort.cg_iterations += spent.cg_iterations;
    // Work and dissipation by the trapezoidal rule.
    double work =
        0.5 *
        (reaction + contact_->reactions()).dot(contact_->committed().displacement - displacement);
    const meshes::Vector3 mean = 0.5 * (before + now);
    if (!mean.isZero(0.0)) {
      Vector travel = motion_.displacement();
      travel -= rest;
      work += motion_.inertial_force(mean) * travel;
    }
    place_ = next;
    record(copies<dim> * work,
           copies<dim> * 0.5 * duration * (dissipation + motion_.dissipation_rate()));
  }

  double bond_force() const override {
    const auto bond = dealii::types::boundary_id(meshes::PhysicalTag::bond);
    double force = resultant(*body_, motion_.residual(), bond).z();
    // In a frame that accelerates the bond's nodes carry what mass the free ones do not.
    const meshes::Vector3 acceleration = frame_acceleration(place_);
    if (!acceleration.isZero(0.0)) {
      const Vector carried = motion_.inertial_force(acceleration);
      force += rubber_mass_ * acceleration.z() + carried.mean_value() * double(carried.size());
    }
    return copies<dim> * force;
  }

  PressState evaluate() const override {
    PressState state;
    state.indentation = steps_.back().indentation;
    state.time = steps_.back().time;
    state.normal_force = steps_.back().normal_force;
    state.lateral_force_x = state.lateral_force_y = 0.0;  // by symmetry
    state.lateral_displacement = 0.0;
    state.torque_x = state.torque_y = state.torque_z = 0.0;
    state.energy = steps_.back().elastic_energy;
    state.active_nodes = contact_->active_nodes();
    const std::vector<SurfaceNode>& nodes = contact_->unknowns().nodes;
    const std::vector<meshes::Vector3> rest(nodes.size(), meshes::Vector3::Zero());
    std::vector<double> squares;
    if constexpr (dim == 2) squares = mean_squares(*body_, nodes, nullptr);
    PushedNodes pushed{
        .nodes = pushed_nodes(*contact_, rest, seen_areas(*body_, nodes, nullptr), squares),
        .sectors = int(copies<dim>),
        .meridian = dim == 2};
    double outermost = 0.0;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (contact_->status()[i] == NodeStatus::open || nodes[i].area == 0.0 ||
          radius(nodes[i]) < outermost)
        continue;
      outermost = radius(nodes[i]);
      pushed.spacing = dim == 2 ? nodes[i].area / circumference(dealii::Point<2>(outermost, 0.0))
                                : std::sqrt(nodes[i].area);
    }
    measure_contact(state, pushed);
    state.markers = markers_.rows(motion_.displacement());
    return state;
  }

  void write_fields(const std::filesystem::path& file) const override {
    using namespace dealii::DataComponentInterpretation;
    const Space<dim>& space = body_->fine;
    const Vector u = space.ghosted(motion_.displacement());
    const Vector v = space.ghosted(motion_.velocity());
    const std::vector<DataComponentInterpretation> vector(dim, component_is_part_of_vector);
    // With Kelvin-Voigt damping the stress is that of u + tau v.
    Vector strained = motion_.displacement();
    strained.add(job_.rubber.retardation_time, motion_.velocity());
    const StressField<dim> stress(*body_, job_, strained, {motion_.memory().past(), {}});
    const ContactField<dim> touch(*body_, *contact_, outer_area(*body_, nullptr));
    FieldOutput<dim> out;
    out.add_data_vector(space.dofs, u, std::vector<std::string>(dim, "displacement"), vector);
    out.add_data_vector(space.dofs, v, std::vector<std::string>(dim, "velocity"), vector);
    stress.add_to(out);
    touch.add_to(out);
    out.build_patches(body_->mapping, unsigned(job_.degree),
                      dealii::DataOut<dim>::curved_inner_cells);
    out.write(file, job_.field_sectors);
  }

 private:
  std::unique_ptr<FieldSolver> make_solver(const std::vector<long>& unknowns) const {
    if constexpr (dim == 3)
      if (solver_kind_ == LinearSolver::multigrid)
        return make_multigrid_solver(*body_, unknowns, job_.solver_tolerance);
    return make_condensed_solver(*body_, unknowns);
  }

  /// Of the rod, whose axis the press follows.
  meshes::Vector3 frame_acceleration(double at) const {
    return course_.acceleration(at) * meshes::Vector3::UnitZ();
  }
  double touch() const { return meshes::first_touch(job_.geometry, 0.0, job_.protocol.obstacle); }
  PlanePose pose(double indentation) const { return {touch() - indentation, 0.0}; }

  void record(double work, double dissipated) {
    double push = 0.0;
    for (std::size_t i = 0; i < contact_->unknowns().nodes.size(); ++i)
      push -= contact_->reaction(i).z();
    const MechanicalEnergy energy = motion_.energy();
    const TransientStep& last = steps_.back();
    TransientStep next;
    next.time = course_.time(place_);
    next.indentation = course_.at(place_).indentation;
    next.contact_force = copies<dim> * push;
    // In a frame that accelerates by b the momentum of space changes by mass times b more.
    next.normal_force =
        next.contact_force +
        copies<dim> * (motion_.momentum_rate().z() + rubber_mass_ * course_.acceleration(place_));
    next.momentum = -copies<dim> * motion_.momentum().z();
    next.kinetic_energy = copies<dim> * energy.kinetic;
    next.elastic_energy = copies<dim> * energy.elastic;
    next.work = last.work + work;
    next.dissipated_energy = last.dissipated_energy + dissipated;
    steps_.push_back(next);
  }

  std::unique_ptr<Body<dim>> body_;
  HookeKernel<dim> stiffness_;
  MassKernel<dim> mass_;
  LinearSolver solver_kind_;
  GeneralisedAlpha<dim> motion_;
  MarkerField<dim> markers_;
  double rubber_mass_;  ///< of what is meshed [kg]
  std::unique_ptr<PlaneContact> contact_;
  std::unique_ptr<FieldSolver> solver_;
};

}  // namespace

std::unique_ptr<TransientPress> TransientPress::on(const ReferenceJob& job,
                                                   const std::filesystem::path& mesh_file,
                                                   const std::filesystem::path& adapted,
                                                   std::function<bool()> stop_requested) {
  if (job.axisymmetric())
    return std::make_unique<TipInMotion<2>>(job, read_body<2>(job, mesh_file, adapted),
                                            std::move(stop_requested));
  return std::make_unique<TipInMotion<3>>(job, read_body<3>(job, mesh_file, adapted),
                                          std::move(stop_requested));
}

PressState TransientPress::advance(double place) {
  const auto start = std::chrono::steady_clock::now();
  const double first = place_, way = place - first;
  const PressCourse::Leg& leg = course_.leg(place);
  double longest = longest_step * job_.geometry.thickness() / std::max(1.0, leg.rate);
  if (leg.rate > 0.0)
    longest = std::min(longest, longest_step_to_sample * (place - leg.begin));
  else  // what shook has died
    longest = std::max(longest, longest_step_to_sample * (first - leg.begin));
  const int count = std::max(1, int(std::ceil(way / (step_factor_ * longest) - 1e-9)));
  const double duration = way / count / job_.protocol.speed;
  PressEffort effort;
  for (int i = 1; i <= count; ++i) {
    stop_if_asked(stop_requested_);
    step_to(i == count ? place : first + way * i / count, duration, effort);
  }
  PressState state = evaluate();
  static_cast<PressEffort&>(state) = effort;
  state.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return state;
}

}  // namespace fingertip::fem_reference::inline motion
