#include "fem_reference/press.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "fem_reference/press_model.h"
#include "fem_reference/run_progress.h"
#include "meshes/errors.h"

namespace fingertip::fem_reference {
namespace {

/// First step and growth of the steps of a press whose path matters, as fractions of the first
/// sample and of the way so far: contact grows fastest at first touch.
constexpr double first_step = 0.1, step_growth = 0.25;
/// A step that does not converge is halved this often before giving up.
constexpr int most_halvings = 6;

std::unique_ptr<PressModel> make_model(const ReferenceJob& job,
                                       const std::filesystem::path& mesh_file) {
  if (job.axisymmetric()) return std::make_unique<TipPress<2>>(job, mesh_file);
  return std::make_unique<TipPress<3>>(job, mesh_file);
}

}  // namespace

bool has_two_symmetry_planes(const ReferenceJob& job) {
  return job.protocol.tilt == 0.0 && job.protocol.lateral == 0.0;
}

meshes::Sector sector(const ReferenceJob& job) {
  if (job.axisymmetric()) return meshes::Sector::meridian;
  return has_two_symmetry_planes(job) ? meshes::Sector::quarter : meshes::Sector::half;
}

struct ContinuumPress::Implementation {
  std::unique_ptr<PressModel> model;
  std::function<bool()> stop_requested;
  double longest_step = 0.01;

  /// A frictionless small-strain press does not depend on its path.
  bool path_matters() const {
    return model->job().protocol.contact != meshes::ContactMode::frictionless ||
           model->job().strain == Strain::finite;
  }

  double next_step(double target, double limit) const {
    if (!path_matters()) return target;
    const double now = model->place();
    const double longest = limit * longest_step * model->job().geometry.thickness();
    const double step =
        std::min(longest, now > 0.0 ? limit * step_growth * now
                                    : limit * first_step * std::min(target, longest));
    const double pieces = std::ceil((target - now) / step - 1e-9);
    return pieces <= 1.0 ? target : std::min(target, now + std::min(step, (target - now) / pieces));
  }
};

ContinuumPress::ContinuumPress(const ReferenceJob& job, const std::filesystem::path& mesh_file,
                               std::function<bool()> stop_requested)
    : implementation_(new Implementation{make_model(job, mesh_file), std::move(stop_requested)}) {}

ContinuumPress::~ContinuumPress() = default;

MeshSummary ContinuumPress::mesh() const {
  return implementation_->model->mesh();
}

void ContinuumPress::set_longest_step(double step) {
  implementation_->longest_step = step;
}

PressState ContinuumPress::advance(double place) {
  Implementation& self = *implementation_;
  const auto start = std::chrono::steady_clock::now();
  PressState effort;
  double limit = 1.0;  // shrinks after a failure, recovers after successes
  while (self.model->place() < place) {
    stop_if_asked(self.stop_requested);
    try {
      self.model->step(self.next_step(place, limit), effort);
      ++effort.steps;
      limit = std::min(1.0, 1.5 * limit);
    } catch (const meshes::NotConverged&) {
      self.model->abandon();
      if (!self.path_matters() || limit < std::pow(0.5, most_halvings)) throw;
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

}  // namespace fingertip::fem_reference
