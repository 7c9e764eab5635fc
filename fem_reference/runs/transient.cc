#include <mpi.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "fem_reference/job/processes.h"
#include "fem_reference/job/run_tables.h"
#include "fem_reference/motion/transient_press.h"
#include "fem_reference/press/mesh_history.h"
#include "fem_reference/press/press.h"
#include "fem_reference/press/press_course.h"
#include "fem_reference/runs/run_files.h"
#include "fem_reference/runs/runs.h"
#include "fem_reference/tip/job_mesh.h"
#include "meshes/base/errors.h"
#include "meshes/press/no_equilibrium.h"
#include "meshes/tables/table_rows.h"

namespace fingertip::fem_reference::inline runs {
namespace {

namespace fs = std::filesystem;
using meshes::to_text;

/// Meshes before the static error can be told, and how they grow: as in a static press.
constexpr std::size_t fewest_transient_meshes = 3;
constexpr double refined_in_motion = 0.7;
/// The transient's mesh may differ from the finest static one by this many tolerances.
constexpr double allowed_tolerances = 2.0;
constexpr std::size_t max_rows = 2000;

class TransientRun : Run {
 public:
  TransientRun(const fs::path& folder, const ReferenceJob& job, std::ostream& progress,
               const std::function<bool()>& stop_requested)
      : Run(folder, job, progress, stop_requested),
        course_(job.protocol, true),
        places_(course_.samples()) {}

  RunOutcome carry_out() {
    const RunOutcome outcome = outcome_of([&] {
      progress_.report("mesh", 0, 1, "meshing the tip");
      quality_ =
          write_mesh_once(job_.geometry, mesh_options(job_, job_.refinement), folder_ / "tip.msh");
      if (job_.estimate_error) adapt();
      press();
      if (job_.estimate_error) repeat_with_doubled_steps();
      if (!shortfall_.empty()) throw meshes::NotConverged(shortfall_);
    });
    write_tables(outcome);
    if (first_process()) fs::remove_all(folder_ / "meshes");
    return outcome;
  }

 private:
  /// Static presses on ever finer meshes, each of which is kept, until the tolerance is met.
  void adapt() {
    ReferenceJob still = job_;
    still.analysis = Analysis::static_press;
    still.protocol.contact = meshes::ContactMode::frictionless;
    still.rubber.relaxation = {};  // meshes are as good for other moduli
    still.protocol.program = {};   // and for the way back
    const auto press = ContinuumPress::on(still, folder_ / "tip.msh", stop_requested_);
    for (;;) {
      static_presses_.start_mesh(press->mesh());
      progress_.report("refine", static_presses_.meshes().size(), fewest_transient_meshes,
                       "static press on mesh " + std::to_string(static_presses_.meshes().size()) +
                           ": " + std::to_string(press->mesh().unknowns) + " unknowns");
      for (const double sample : job_.protocol.samples) static_presses_.add(press->advance(sample));
      keep_mesh(*press);
      const bool estimable = static_presses_.meshes().size() >= fewest_transient_meshes;
      if (estimable && static_presses_.worst_relative_error() <= job_.tolerance) break;
      if (!press->refine(refined_in_motion)) {
        shortfall_ =
            "the static force may be off by more than the tolerance of " + to_text(job_.tolerance) +
            " on the finest mesh that reference.max_unknowns = " + to_text(job_.max_unknowns) +
            " allows; allow more or a larger tolerance";
        break;
      }
    }
    choose_mesh();
  }

  static fs::path mesh_folder(std::size_t number) {
    return fs::path("meshes") / std::to_string(number);
  }

  void keep_mesh(const ContinuumPress& press) const {
    press.save(make_folder(mesh_folder(static_presses_.meshes().size())));
    MPI_Barrier(MPI_COMM_WORLD);
  }

  /// The coarsest that is near enough; of a meridian, which costs little, the finest: forces at a
  /// few depths may be near by chance.
  void choose_mesh() {
    const std::size_t meshes = static_presses_.meshes().size();
    for (chosen_ = job_.axisymmetric() ? meshes : 1; chosen_ < meshes; ++chosen_) {
      double worst = 0.0;
      for (std::size_t i = 0; i < job_.protocol.samples.size(); ++i)
        worst = std::max(worst, difference_to_finest(i));
      if (worst <= allowed_tolerances * job_.tolerance) return;
    }
  }

  double static_force(std::size_t mesh, std::size_t sample) const {
    return static_presses_.meshes()[mesh - 1].states.at(sample).normal_force;
  }
  /// Of the chosen mesh's static force, over the finest mesh's.
  double difference_to_finest(std::size_t sample) const {
    const std::size_t finest = static_presses_.meshes().size();
    return std::abs(static_force(chosen_, sample) / static_force(finest, sample) - 1.0);
  }
  /// Of the chosen mesh, as a fraction of the force.
  double mesh_error(std::size_t sample) const {
    const double of_finest = static_presses_.error(sample).value;
    return difference_to_finest(sample) +
           of_finest / static_force(static_presses_.meshes().size(), sample);
  }

  std::unique_ptr<TransientPress> make_press() const {
    return TransientPress::on(job_, folder_ / "tip.msh",
                              chosen_ > 0 ? folder_ / mesh_folder(chosen_) : fs::path(),
                              stop_requested_);
  }

  /// That of the static sample, in a program of the one next to its indentation.
  double mesh_error_of(std::size_t index) const {
    if (job_.protocol.program.empty()) return mesh_error(index);
    const std::vector<double>& depths = job_.protocol.samples;
    const double wanted = states_[index].indentation;
    std::size_t next = 0;
    for (std::size_t i = 1; i < depths.size(); ++i)
      if (std::abs(depths[i] - wanted) < std::abs(depths[next] - wanted)) next = i;
    return mesh_error(next);
  }

  void press() {
    const double start = progress_.wall_time();
    progress_.report("assemble", 0, 1, "mass and stiffness");
    const auto press = make_press();
    mesh_ = press->mesh();
    progress_.report("assemble", 1, 1,
                     std::to_string(mesh_.unknowns) + " unknowns, " +
                         std::string(fem_reference::name(mesh_.solver)) + " solver");
    for (std::size_t i = 0; i < places_.size(); ++i) {
      try {
        states_.push_back(press->advance(places_[i]));
        states_.back().stage = course_.stage(i);
      } catch (const meshes::NotConverged& error) {
        steps_ = press->steps();
        if (steps_.empty()) throw;
        throw meshes::NoEquilibrium(
            "the press in time", {.indentation = steps_.back().indentation},
            error.what() + (", at " + to_text(steps_.back().time) + " s"),
            "press more slowly (press.speed), or at rest (reference.mode = static)");
      } catch (...) {
        steps_ = press->steps();
        throw;
      }
      steps_ = press->steps();
      write_sample(*press, i);
    }
    press_time_ = progress_.wall_time() - start;
  }

  void write_sample(const TransientPress& press, std::size_t index) {
    if (job_.write_fields) {
      press.write_fields(make_folder("fields") / field_name(index));
      if (first_process()) {
        std::vector<double> times;
        for (const PressState& state : states_) times.push_back(state.time);
        write_field_series(times, folder_);
      }
    }
    write_tables({RunOutcome::Status::interrupted, ""});
    progress_.report("press", index + 1, places_.size(), sample_text(states_.back()));
  }

  void repeat_with_doubled_steps() {
    const auto press = make_press();
    press->set_step_factor(2.0);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const double force = press->advance(places_[i]).normal_force;
      PressState& sample = states_[i];
      sample.force_error =
          std::abs(sample.normal_force - force) + mesh_error_of(i) * std::abs(sample.normal_force);
      progress_.report("error", i + 1, places_.size(),
                       "doubled steps: F = " + to_text(force) + " N");
    }
  }

  void write_tables(const RunOutcome& outcome) const {
    if (!first_process()) return;
    write_samples(states_, job_, folder_);
    write_convergence(static_presses_, folder_);
    write_steps();
    RunSummary summary = summary_head(outcome, job_);
    summary.contact = meshes::name(job_.protocol.contact);
    summary.strain = fem_reference::name(job_.strain);
    summary.speed = job_.protocol.speed;
    add_finest(mesh_, summary);
    summary.time_steps = steps_.empty() ? 0 : steps_.size() - 1;
    summary.transient_wall_time = press_time_;
    summary.mesh = quality_;
    for (const MeshRecord& record : static_presses_.meshes())
      summary.static_meshes.push_back(mesh_entry(record.mesh, record.wall_time));
    if (chosen_ > 0) summary.static_mesh_of_transient = chosen_;
    for (const PressState& state : states_) summary.transient_samples.push_back({state});
    write_summary(std::move(summary), progress_, folder_);
  }

  void write_steps() const {
    std::vector<TransientStep> rows;
    const std::size_t stride = (steps_.size() + max_rows - 1) / max_rows;
    for (std::size_t i = 0; i < steps_.size(); i += stride) rows.push_back(steps_[i]);
    meshes::write_rows(rows, folder_ / "transient.csv");
  }

  const PressCourse course_;
  const std::vector<double> places_;  ///< of the samples on the course [m]
  meshes::MeshQuality quality_;
  MeshHistory static_presses_;
  std::size_t chosen_ = 0;  ///< number of the transient's mesh, from 1; 0: the one in the file
  std::string shortfall_;   ///< why the tolerance was not met; empty if it was
  MeshSummary mesh_;
  std::vector<PressState> states_;
  std::vector<TransientStep> steps_;
  double press_time_ = 0.0;
};

}  // namespace

RunOutcome run_transient(const fs::path& folder, const ReferenceJob& job, std::ostream& progress,
                         const std::function<bool()>& stop_requested) {
  return TransientRun(folder, job, progress, stop_requested).carry_out();
}

}  // namespace fingertip::fem_reference::inline runs
