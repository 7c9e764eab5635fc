#include "fem_reference/solvers/solver_choice.h"

#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/base/errors.h"

namespace fingertip::fem_reference::inline solvers {
namespace {

/// Above this many unknowns the factor outgrows a desktop's memory (4.4 GB peak at 240 000; at
/// large strain 3.9 GB at 275 000), and multigrid takes over, which is as fast there.
constexpr double largest_condensed = 300000, largest_eliminated = 250000;

/// Of 1000 unknowns [s]: refined, numbered and looked at afterwards; factored by sparse Cholesky;
/// by the iterations of the contact on a matrix that is factored; one of Newton's systems by
/// Cholesky, whose factor serves several; by multigrid, and one of Newton's systems by it. Two of
/// them grow with the powers below.
constexpr double mesh_time = 0.03, factor_time = 0.0072, factor_power = 1.33, contact_time = 0.004,
                 newton_time = 0.0075, newton_power = 1.1, multigrid_time = 0.18,
                 newton_multigrid_time = 0.025;
/// Newton's systems of one sample at large strain: in one step; in those on the way of the first
/// mesh, on which nodes touch and stick; in the small ones in which they slide.
constexpr double newton_steps = 4.0, newton_steps_on_the_way = 10.0, newton_steps_sliding = 40.0;
/// Of the unknowns, from one mesh to the next where half of the error is refined: 1.05 to 1.4 for a
/// solid, whose first mesh its shape makes fine; else 1.4 to 3.
constexpr double usual_growth_of_solid = 1.2, usual_growth = 2.0;
constexpr double base_memory = 2e8, memory_per_unknown = 1.75e4,
                 multigrid_memory_per_unknown = 4e3;  // [byte]

}  // namespace

LinearSolver choose_solver(const ReferenceJob& job, double unknowns) {
  const LinearSolver wanted = job.solver;
  int processes = 1;
  MPI_Comm_size(MPI_COMM_WORLD, &processes);
  if (job.axisymmetric()) {
    if (processes > 1)
      throw meshes::InvalidInput({"reference.symmetry", std::string(name(job.symmetry)),
                                  "a meridian is solved on one process",
                                  "start one process, or choose reference.symmetry = \"none\""});
    return LinearSolver::condensed;
  }
  const bool curved = job.strain == Strain::finite && !job.protocol.obstacle.is_plane();
  if (curved && (processes > 1 || wanted == LinearSolver::multigrid))
    throw meshes::InvalidInput({"obstacle.shape", std::string(name(job.protocol.obstacle.shape)),
                                "at large strain the contact with what is curved needs the direct "
                                "solver, on one process",
                                "choose reference.solver = \"condensed\" and --ranks 1"});
  if (curved) return LinearSolver::condensed;
  if (wanted == LinearSolver::condensed && processes > 1)
    throw meshes::InvalidInput({"reference.solver", "condensed",
                                "the condensed solver runs on one process",
                                "choose multigrid or automatic, or --ranks 1"});
  if (wanted != LinearSolver::automatic) return wanted;
  const double most = job.strain == Strain::finite ? largest_eliminated : largest_condensed;
  return processes == 1 && unknowns <= most ? LinearSolver::condensed : LinearSolver::multigrid;
}

SolutionCost solution_cost(const ReferenceJob& job, double unknowns, bool first_mesh) {
  using meshes::ContactMode;
  const ContactMode contact = job.protocol.contact;
  const bool finds_the_way = contact == ContactMode::stick && (first_mesh || !job.estimate_error);
  const double steps = contact == ContactMode::coulomb ? newton_steps_sliding
                       : finds_the_way                 ? newton_steps_on_the_way
                                                       : newton_steps;
  const double thousands = 1e-3 * unknowns, mesh = mesh_time * thousands;
  const bool finite = job.strain == Strain::finite;
  if (choose_solver(job, unknowns) == LinearSolver::multigrid)
    return {mesh, (finite ? steps * newton_multigrid_time : multigrid_time) * thousands,
            base_memory + multigrid_memory_per_unknown * unknowns};
  const double memory = base_memory + memory_per_unknown * unknowns;
  if (finite) return {mesh, steps * newton_time * std::pow(thousands, newton_power), memory};
  return {mesh + factor_time * std::pow(thousands, factor_power), contact_time * thousands, memory};
}

double expected_unknowns(const ReferenceJob& job, double cells, double corners) {
  const double inner = job.degree - 1;  // nodes within an edge
  if (job.axisymmetric())
    return 2.0 * (corners + inner * (corners + cells - 1.0) + inner * inner * cells);
  return 3.0 * (corners + inner * (2.0 * corners + cells - 1.0) +
                inner * inner * (corners + 2.0 * cells) + inner * inner * inner * cells);
}

PressWork::PressWork(const ReferenceJob& job, std::size_t samples, std::size_t fewest_meshes)
    : job_(job), samples_(samples), fewest_meshes_(job.estimate_error ? fewest_meshes : 1) {}

void PressWork::begin(double unknowns) {
  unknowns_ = unknowns;
}

void PressWork::resume(double unknowns, std::size_t meshes, std::size_t samples_done) {
  unknowns_ = unknowns;
  assembled_ = true;
  number_ = meshes;
  pressed_ = samples_done;
}

void PressWork::assembled(double unknowns) {
  unknowns_ = unknowns;
  assembled_ = true;
  work_done_ += cost().mesh;
}

void PressWork::pressed() {
  ++pressed_;
  work_done_ += cost().sample;
}

SolutionCost PressWork::cost() const {
  return solution_cost(job_, unknowns_, number_ == 1);
}

double PressWork::growth() const {
  return job_.geometry.solid ? usual_growth_of_solid : usual_growth;
}

void PressWork::refine() {
  unknowns_ *= growth();
  assembled_ = false;
  ++number_;
  pressed_ = 0;
}

Expected PressWork::expected(double wall_time, std::size_t wanted) const {
  SolutionCost cost = this->cost();
  double work = double(wanted - std::min(pressed_, wanted)) * cost.sample;
  if (!assembled_) work += cost.mesh;
  double unknowns = unknowns_, memory = cost.memory;
  for (std::size_t number = number_; number < fewest_meshes_; ++number) {
    cost = solution_cost(job_, unknowns *= growth(), false);
    work += cost.mesh + double(samples_) * cost.sample;
    memory = std::max(memory, cost.memory);
  }
  return {(work_done_ > 0.0 ? wall_time / work_done_ : 1.0) * work, memory};
}

}  // namespace fingertip::fem_reference::inline solvers
