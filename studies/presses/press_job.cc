#include "studies/presses/press_job.h"

#include <optional>

#include "calibration/material/moduli.h"
#include "lattice/dynamics/thread_choice.h"
#include "lattice/press/press.h"
#include "lattice/press/press_deviation.h"
#include "lattice/press/press_task.h"
#include "lattice/press/setup_fields.h"
#include "lattice/press/static_press.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "source_hash.h"
#include "studies/files/run_tables.h"
#include "studies/presses/controller_choice.h"
#include "studies/presses/force_error.h"
#include "studies/presses/journal.h"
#include "studies/presses/pace.h"
#include "studies/presses/pictures/movie.h"
#include "studies/presses/pictures/snapshot_files.h"
#include "studies/presses/press_notes.h"
#include "studies/presses/program_summary.h"
#include "studies/presses/tracking.h"

namespace fingertip::studies::inline presses {

namespace {

namespace fs = std::filesystem;

CensusEntry census_of(const lattice::PressOutcome& outcome) {
  const lattice::LatticeCensus& census = outcome.census;
  return {.sectors = outcome.sectors,
          .particles = long(census.particles),
          .expected_particles = census.expected_particles,
          .springs = long(census.springs),
          .cells = long(census.cells),
          .boundary_particles = long(census.boundary_particles),
          .ligaments = long(census.ligaments),
          .mass = census.mass,
          .added_mass = census.added_mass,
          .exact_mass = census.exact_mass};
}

/// What scaled masses are expected to change of the force, beside plain ones.
ScalingEntry scaling_of(const lattice::PressSetup& setup) {
  const lattice::ScalingChoice choice = lattice::choose_scaling(setup);
  ScalingEntry entry{choice.scaled, {}};
  for (const lattice::ForceDeviation& deviation : choice.deviations)
    entry.estimated_force_deviation.push_back({deviation.indentation, deviation.relative});
  return entry;
}

PressSummary summary_of(const lattice::PressSetup& setup, const lattice::PressOutcome& outcome,
                        const std::string& status) {
  const lattice::StepReport& step = outcome.step;
  PressSummary summary = press_summary_head(setup, status);
  summary.moduli =
      moduli_entry(calibration::homogenised_moduli(setup.lattice.constants, setup.lattice.spacing));
  summary.step = {step.step,        step.smallest,       step.omega0,
                  step.paper_bound, step.spectral_bound, step.explanation};
  summary.census = census_of(outcome);
  summary.steps = {outcome.steps.accepted, outcome.steps.rejected, outcome.steps.forced,
                   outcome.force_evaluations};
  summary.simulated_time = outcome.simulated_time;
  summary.wall_time = outcome.wall_time;
  summary.real_time_factor = outcome.real_time_factor();
  summary.slowest_real_time_factor = slowest_pace(outcome, pace_window).wall;
  summary.threads = setup.threads;
  summary.first_touch_time = outcome.first_touch_time;
  summary.momentum_defect = outcome.momentum_defect;
  if (setup.integrator == lattice::Integrator::mass_scaled) summary.scaling = scaling_of(setup);
  summary.warnings = scaling_notes(setup);
  summary.program = stage_entries(setup.protocol, outcome.trace);
  if (!summary.program.empty()) summary.work_in = outcome.work_in;
  if (setup.protocol.goes_back()) summary.loop_area = outcome.work;
  if (!summary.controlled()) return summary;
  summary.tracking = measure_tracking(outcome.trace, outcome.first_touch_time);
  // Mirror planes hold the rod of a part: no merit of the controller.
  if (outcome.sectors > 1) summary.tracking.tilt_deg = meshes::unknown;
  summary.tracking.follows_path = setup.follows_path;
  if (!outcome.trace.empty()) {
    const lattice::TraceRow& last = outcome.trace.back();
    summary.end = EndEntry{last.time, last.indentation, last.normal_force};
  }
  return summary;
}

PressSummary summary_of(const lattice::PressSetup& setup, const lattice::StaticOutcome& outcome,
                        const std::string& status) {
  PressSummary summary = press_summary_head(setup, status);
  summary.static_census = {long(outcome.sectors), long(outcome.particles), long(outcome.springs),
                           long(outcome.cells),   long(outcome.unknowns),  outcome.volume,
                           outcome.exact_volume};
  summary.effort = {outcome.steps, outcome.newton_iterations, outcome.factorisations,
                    outcome.gradients};
  summary.program = stage_entries(setup.protocol, outcome.response);
  if (setup.protocol.goes_back()) summary.loop_area = work_along(outcome.response);
  summary.smallest_jacobian = outcome.smallest_jacobian;
  summary.wall_time = outcome.wall_time;
  return summary;
}

/// Writes what a press has so far.
template <typename Outcome>
class PressWriter {
 public:
  PressWriter(const lattice::PressSetup& setup, fs::path folder)
      : setup_(&setup), estimator_(setup), folder_(std::move(folder)) {}

  void operator()(const Outcome& outcome, const std::string& status) {
    with_estimated_error(outcome.response, estimator_).write_csv(folder_ / "response.csv");
    // Long, and the same between samples.
    if (contact_points_ != outcome.contact.size())
      meshes::write_rows(outcome.contact, folder_ / "contact_field.csv");
    contact_points_ = outcome.contact.size();
    if (markers_ != outcome.markers.size())
      meshes::write_rows(with_estimated_error(outcome.markers, outcome.response, estimator_),
                         folder_ / "markers.csv");
    markers_ = outcome.markers.size();
    if constexpr (requires { outcome.trace; })
      meshes::write_rows(outcome.trace, folder_ / "trace.csv");
    meshes::write_json_file(summary_of(*setup_, outcome, status), folder_ / "summary.json");
  }

 private:
  const lattice::PressSetup* setup_;
  lattice::ForceEstimator estimator_;
  fs::path folder_;
  std::size_t contact_points_ = 0, markers_ = 0;  ///< rows written
};

void run_press_job(lattice::PressSetup setup, int movie_pictures, const fs::path& folder,
                   const JobContext& context) {
  setup.threads = setup.threads > 0
                      ? context.threads
                      : lattice::fastest_threads(lattice::moving_particles(setup), context.threads);
  std::optional<Movie> movie;
  if (movie_pictures > 0) movie.emplace(folder / "movie", setup.geometry);
  const auto show = [&](const lattice::BoundaryView& view, const lattice::FingerPicture& picture) {
    movie->add(view, picture);
  };
  Journal<lattice::PressOutcome> journal(folder, context, "pressing",
                                         PressWriter<lattice::PressOutcome>(setup, folder));
  const lattice::PressOutcome outcome = journal.run([&](const lattice::PressObserver& observe) {
    return lattice::run_press(setup, observe, {movie_pictures, show});
  });
  write_shapes(outcome, folder);
  context.log("step " + meshes::to_text(outcome.step.step) + " s: " + outcome.step.explanation);
}

void run_static_job(lattice::PressSetup setup, const fs::path& folder, const JobContext& context) {
  setup.threads = context.threads;
  Journal<lattice::StaticOutcome> journal(folder, context, "pressing",
                                          PressWriter<lattice::StaticOutcome>(setup, folder),
                                          std::chrono::milliseconds::zero());
  const lattice::StaticOutcome outcome = journal.run([&](const lattice::StaticObserver& observe) {
    return lattice::run_static_press(setup, observe, true);
  });
  write_shapes(outcome, folder);
}

}  // namespace

Job press_job(const lattice::PressSetup& setup, int movie_pictures) {
  Job job;
  job.kind = "press";
  job.inputs = inputs_of(setup);
  job.source_hash = source_hash::lattice;
  job.weight = press_weight(setup);
  if (setup.protocol.mode == meshes::DriveMode::equilibrium) {
    job.run = [setup](const fs::path& folder, const JobContext& context) {
      run_static_job(setup, folder, context);
    };
    return job;
  }
  if (movie_pictures > 0) job.inputs["movie"] = movie_pictures;
  job.repeatable = repeatable(setup);
  job.run = [setup, movie_pictures](const fs::path& folder, const JobContext& context) {
    run_press_job(setup, movie_pictures, folder, context);
  };
  return job;
}

}  // namespace fingertip::studies::inline presses
