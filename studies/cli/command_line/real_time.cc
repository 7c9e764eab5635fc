#include "studies/cli/command_line/real_time.h"

#include <fmt/format.h>

#include <cmath>

#include "calibration/files/words.h"
#include "lattice/press/press_deviation.h"
#include "lattice/press/setup_fields.h"
#include "meshes/tables/fields_json.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/config/asked_units.h"
#include "studies/files/read_fields.h"
#include "studies/files/shown_units.h"
#include "studies/jobs/interrupt.h"
#include "studies/presses/force_error.h"
#include "studies/presses/press_job.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline cli::inline command_line {

namespace {

namespace fs = std::filesystem;

std::string identity_of(const LoadedConfig& asked) {
  const Config& config = asked.config;
  return fmt::format("{}, threads {}{}",
                     press_job(press_setup(with_material(asked, LatticeUse::press))).key(),
                     config.press.threads, config.automatic_integrator ? ", any integrator" : "");
}

RealTimeRecord record_of(const PaceSearch& search) {
  const PaceCandidate& taken = search.taken();
  RealTimeRecord record;
  record.spacing_asked = search.asked().spacing;
  record.spacing = taken.spacing;
  record.integrator = lattice::name(taken.integrator);
  record.step = taken.step;
  record.threads = taken.threads;
  record.expected_factor = search.choice.factor;
  record.tried = search.choice.was_measured;
  for (const MeasuredPace& trial : search.measured)
    record.trials.push_back(
        {trial.candidate.spacing, trial.candidate.step, trial.candidate.threads, trial.factor});
  return record;
}

/// Where nothing keeps up the coarsest lattice is taken, unless real time is `demanded`.
RealTimeRecord searched_record(const LoadedConfig& asked, bool demanded) {
  const PaceSearch search = search_pace_here(asked, cores_for(asked), !demanded);
  if (search.choice.found || !demanded) return record_of(search);
  throw meshes::NotConverged(fmt::format(
      "--real-time: not even the coarsest lattice that this finger allows, {} m, keeps up with "
      "this press on this machine: a real-time factor of {:.2g} is expected, {:.3g} wanted; "
      "press more slowly, so that scaled masses serve with longer steps, or leave --real-time out",
      calibration::rounded(search.taken().spacing), search.choice.factor, pace_margin));
}

/// What an earlier run of the same command chose.
std::optional<RealTimeRecord> kept_record(const CommandLine& line, const std::string& asked) {
  const fs::path file = line.out / real_time_name;
  if (!line.resume || line.out.empty() || !fs::exists(file)) return {};
  auto record = struct_of<RealTimeRecord>(read_entry(file));
  if (record.asked != asked) return {};
  return record;
}

PaceCandidate candidate_of(const RealTimeRecord& record) {
  PaceCandidate taken;
  taken.spacing = record.spacing;
  taken.step = record.step;
  const auto integrator = meshes::enumerator<lattice::Integrator>(record.integrator);
  if (!integrator)
    throw meshes::InvalidInput(
        {real_time_name, record.integrator, "is no integrator", "start again without --resume"});
  taken.integrator = *integrator;
  return taken;
}

std::string spelt(double spacing, const meshes::Geometry& geometry) {
  return fmt::format("{} (tip_radius/{:.4g})", shown_units().length.text(spacing),
                     geometry.tip_radius / spacing);
}

std::string step_text(double step) {
  return step < 1e-3 * (1.0 - 1e-9) ? fmt::format("{:.3g} us", 1e6 * step)
                                    : fmt::format("{:.3g} ms", 1e3 * step);
}

}  // namespace

std::vector<std::string> as_a_person_presses() {
  return {"press.mode=pid", "press.program=[]", "press.twist=0 deg"};
}

RealTimeRun real_time_run(const CommandLine& line) {
  watch_for_interrupts();
  LoadedConfig asked = with_any_integrator(load_checked(line));
  if (line.verb == "live") asked = with_sets(asked, as_a_person_presses());
  if (line.verb == "press" && asked.config.press.protocol.mode == meshes::DriveMode::equilibrium)
    throw ConfigError({"press.mode", "static", "a press in equilibrium has no time to keep up with",
                       "choose pid or quasi-static", "--real-time"});
  const std::string identity = identity_of(asked);
  RealTimeRun run;
  if (const auto kept = kept_record(line, identity))
    run.record = *kept;
  else
    run.record = searched_record(asked, line.real_time);
  run.record.asked = identity;
  run.loaded = with_sets(asked, settings_of(candidate_of(run.record), asked));
  return run;
}

std::string RealTimeRun::note() const {
  const ShowIn units(asked_units(loaded));
  const meshes::Geometry& geometry = loaded.config.press.geometry;
  const bool as_asked = same_spacing(record.spacing, record.spacing_asked);
  return fmt::format(
      "real time: spacing {}{}, {}, steps of {}{}, threads: {}; expected real-time factor in the "
      "slowest 10 ms: {:.3g}, from {}",
      spelt(record.spacing, geometry),
      as_asked ? ", as asked" : " where " + spelt(record.spacing_asked, geometry) + " was asked",
      record.integrator, loaded.config.press.time_step ? "" : "about ", step_text(record.step),
      record.threads, record.expected_factor,
      record.tried ? "a trial with this spacing" : "trials with other spacings");
}

void RealTimeRun::write(const fs::path& folder) const {
  meshes::write_json_file(record, folder / real_time_name);
}

void RealTimeRun::estimate_force_error(const lattice::PressSetup& setup) {
  if (loaded.config.force_error == ForceErrorBy::nothing) return;
  const lattice::ForceEstimator estimator(setup);
  ForceErrorEntry entry{estimated_source(setup.lattice.model, "nobody has pressed yet").statement};
  for (int tenth = 1; tenth <= 10; ++tenth) {
    const double depth = 0.1 * tenth * setup.protocol.depth;
    const auto error = estimator.at(depth);
    if (!error || error->sum() <= std::fmax(0.0, entry.largest)) continue;
    entry.largest = error->sum();
    entry.indentation = depth;
  }
  record.force_error = entry;
}

std::string RealTimeRun::text() const {
  std::string text;
  if (!std::isnan(record.slowest_factor))
    text += fmt::format("real-time factor {:.3g} in the slowest stretch ({:.3g} expected){}\n",
                        record.slowest_factor, record.expected_factor,
                        record.slowest_factor < 1.0 ? ": NOT KEPT UP" : "");
  return text;
}

}  // namespace fingertip::studies::inline cli::inline command_line
