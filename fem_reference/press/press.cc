#include "fem_reference/press/press.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fem_reference/job/processes.h"
#include "fem_reference/press/press_model.h"
#include "meshes/base/errors.h"
#include "meshes/press/no_equilibrium.h"

namespace fingertip::fem_reference::inline press {
namespace {

/// Steps of a press, as fractions of the first sample, of the way so far (contact grows fastest at
/// first touch), and of R - r; those of a rubber that relaxes as shares of the way from where the
/// stage began to the next sample, for the rate of strain counts as constant within a step.
struct Steps {
  double first, growth, longest, of_relaxing = ContinuumPress::usual_relaxing_step;
};
/// Where a node first touches is remembered: at nu = 0.49 steps twice as long are off by 0.15 %.
constexpr Steps stick_steps = {0.1, 0.25, 0.01};
/// Without friction only Newton's method asks for steps.
constexpr Steps frictionless_steps = {1.0, 1.0, 0.1};
/// A step that does not converge is halved this often before giving up.
constexpr int max_halvings = 6;

std::unique_ptr<PressModel> make_model(const ReferenceJob& job,
                                       const std::filesystem::path& mesh_file) {
  if (job.axisymmetric()) return std::make_unique<TipPress<2>>(job, mesh_file);
  return std::make_unique<TipPress<3>>(job, mesh_file);
}

}  // namespace

struct ContinuumPress::Implementation {
  std::unique_ptr<PressModel> model;
  std::function<bool()> stop_requested;
  Steps steps;

  Implementation(std::unique_ptr<PressModel> pressed, std::function<bool()> stop)
      : model(std::move(pressed)),
        stop_requested(std::move(stop)),
        steps(frictionless() ? frictionless_steps : stick_steps) {}

  bool frictionless() const {
    return model->job().protocol.contact == meshes::ContactMode::frictionless;
  }
  bool relaxes() const { return !model->job().rubber.relaxation.empty(); }
  bool one_step() const {
    return frictionless() && model->job().strain == Strain::linear && !relaxes();
  }

  double next_step(double target, double limit) const {
    if (one_step()) return target;
    const double now = model->place();
    const PressCourse::Leg& leg = model->course().leg(target);
    const double longest = limit * steps.longest * model->job().geometry.thickness();
    double step = std::min(longest, now > 0.0 ? limit * steps.growth * now
                                              : limit * steps.first * std::min(target, longest));
    if (leg.rate > 1.0) step /= leg.rate;
    if (leg.rate == 0.0) step = target - now;
    if (relaxes()) step = std::min(step, limit * steps.of_relaxing * (target - leg.begin));
    const double pieces = std::ceil((target - now) / step - 1e-9);
    return pieces <= 1.0 ? target : std::min(target, now + std::min(step, (target - now) / pieces));
  }
};

ContinuumPress::ContinuumPress(const ReferenceJob& job, const std::filesystem::path& mesh_file,
                               std::function<bool()> stop_requested)
    : implementation_(new Implementation(make_model(job, mesh_file), std::move(stop_requested))) {}

ContinuumPress::~ContinuumPress() = default;

MeshSummary ContinuumPress::mesh() const {
  return implementation_->model->mesh();
}

void ContinuumPress::set_longest_step(double step) {
  implementation_->steps.longest = step;
}

void ContinuumPress::set_relaxing_step(double share) {
  implementation_->steps.of_relaxing = share;
}

PressState ContinuumPress::advance(double place) {
  Implementation& self = *implementation_;
  const auto start = std::chrono::steady_clock::now();
  PressState effort;
  double limit = 1.0;  // shrinks after a failure, recovers after successes
  while (self.model->place() < place) {
    stop_if_asked(self.stop_requested);
    try {
      const double next = self.next_step(place, limit);
      self.model->step(next, next == place, effort);
      ++effort.steps;
      limit = std::min(1.0, 1.5 * limit);
    } catch (const meshes::NotConverged& error) {
      self.model->abandon();
      if (self.one_step() || limit < std::pow(0.5, max_halvings)) {
        const meshes::PressPose pose = self.model->course().at(self.model->place());
        throw meshes::NoEquilibrium("the continuum", pose.indentation, pose.lateral, error.what(),
                                    "take another first mesh (reference.refinement)");
      }
      limit /= 2;
    }
  }
  PressState state = self.model->evaluate();
  state.steps = effort.steps;
  state.newton_iterations = effort.newton_iterations;
  state.active_set_iterations = effort.active_set_iterations;
  state.cg_iterations = effort.cg_iterations;
  state.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return state;
}

bool ContinuumPress::refine(double share, const std::vector<char>& wanted) {
  return implementation_->model->refine(share, wanted);
}

std::shared_ptr<const PressSnapshot> ContinuumPress::snapshot() const {
  return implementation_->model->snapshot();
}

void ContinuumPress::write_fields(const PressSnapshot& state,
                                  const std::filesystem::path& file) const {
  implementation_->model->write_fields(state, file);
}

std::vector<SectionEdge> ContinuumPress::section(const PressSnapshot& state) const {
  return implementation_->model->section(state);
}

meshes::Vector3 ContinuumPress::bond_reaction() const {
  return implementation_->model->bond_reaction();
}

void ContinuumPress::save(const std::filesystem::path& folder) const {
  implementation_->model->save(folder);
}

void ContinuumPress::load(const std::filesystem::path& folder) {
  implementation_->model->load(folder);
}

}  // namespace fingertip::fem_reference::inline press
