#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "calibration/files/words.h"
#include "fem_reference/job/run_tables.h"
#include "meshes/press/markers.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/table_rows.h"
#include "studies/cli/command_line/real_time.h"
#include "studies/cli/command_line/run_verb.h"
#include "studies/cli/verbs/verbs.h"
#include "studies/files/json_entry.h"
#include "studies/files/mode_table.h"
#include "studies/files/places.h"
#include "studies/files/press_summary.h"
#include "studies/files/read_fields.h"
#include "studies/files/shown_units.h"
#include "studies/jobs/result_files.h"
#include "studies/presses/force_error.h"
#include "studies/presses/modes_job.h"
#include "studies/presses/press_job.h"
#include "studies/presses/press_notes.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/program_summary.h"
#include "studies/presses/reference_job.h"
#include "studies/presses/taxel_record.h"
#include "studies/presses/tracking.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/terminal.h"

namespace fingertip::studies::inline cli::inline verbs {

namespace {

/// The curve at the wanted depths.
std::vector<meshes::PressSample> wanted_samples(const meshes::PressResponse& response,
                                                const meshes::PressProtocol& protocol) {
  std::vector<meshes::PressSample> wanted;
  for (const double depth : protocol.samples) {
    const auto found =
        std::ranges::find_if(response.pressing(), [&](const meshes::PressSample& sample) {
          return std::abs(sample.indentation - depth) <= 1e-6 * depth;
        });
    if (found != response.pressing().end()) wanted.push_back(*found);
  }
  return wanted;
}

/// The curve at the wanted depths, and the motion of the plane that followed, if one did.
void print_response(const meshes::PressResponse& response, const meshes::PressProtocol& protocol) {
  fmt::print("{}", report::table_text(report::sample_table(wanted_samples(response, protocol),
                                                           {report::indentation()})));
  const auto moved = report::moved_along_plane(response);
  if (moved.empty()) return;
  std::vector<report::SampleColumn> over;
  for (const report::PlaneMotion& motion : report::plane_motions(moved)) over.push_back(motion.way);
  fmt::print("then along the plane at {}:\n{}", shown_units().length.text(response.depth()),
             report::table_text(report::sample_table(moved.subspan(1), over)));
}

/// "continuum, finite strain (law A), stick contact, static"
std::string heading(const fem_reference::ReferenceJob& reference) {
  const bool finite = reference.strain == fem_reference::Strain::finite;
  std::string text = finite ? fmt::format("continuum, finite strain ({})",
                                          meshes::describe(reference.rubber.energy))
                            : std::string("continuum, small strain");
  if (reference.analysis == fem_reference::Analysis::modes) return text + ", natural frequencies";
  return fmt::format("{}, {} contact, {}", text, meshes::name(reference.protocol.contact),
                     fem_reference::name(reference.analysis));
}

void print_frequencies(const std::filesystem::path& folder) {
  const auto modes = vibration_modes(meshes::read_csv(folder / "modes.csv"));
  fmt::print("{}", report::table_text(report::modes_table(modes)));
}

/// Largest force_error over normal_force, and where; relative NaN where one is not known.
struct WorstError {
  double relative = 0.0, indentation = 0.0;
};
WorstError worst_error(std::span<const meshes::PressSample> samples) {
  WorstError worst;
  for (const meshes::PressSample& sample : samples) {
    const double error = std::abs(sample.force_error / sample.normal_force);
    if (error > worst.relative || std::isnan(error)) worst = {error, sample.indentation};
    if (std::isnan(error)) break;
  }
  return worst;
}

/// How many meshes it took, and whether the error is as small as wanted.
void print_accuracy(const std::filesystem::path& folder,
                    const fem_reference::ReferenceJob& reference, const WorstError& worst) {
  if (std::isnan(worst.relative)) return;
  const bool reached = worst.relative <= reference.tolerance;
  fmt::print("estimated error of the force: at most {:.3g} % ({:.3g} % wanted{})",
             100.0 * worst.relative, 100.0 * reference.tolerance,
             reached ? "" : ", NOT REACHED at " + shown_units().length.text(worst.indentation));
  if (std::filesystem::exists(folder / "convergence.csv")) {
    std::size_t unknowns = 0;
    // Of a run that goes on, its table may be that of an earlier version.
    const meshes::CsvTable table = meshes::read_csv(folder / "convergence.csv");
    for (const auto& row : meshes::known_rows<fem_reference::ConvergenceRow>(table))
      unknowns = std::max(unknowns, row.unknowns);
    if (unknowns > 0) fmt::print("; finest mesh: {} unknowns", unknowns);
  }
  fmt::print("\n");
}

/// What the controller held: the force, or else the speed, or where one of people's own ended.
void print_control(const PressSummary& summary) {
  const TrackingEntry& tracking = summary.tracking;
  const double held = tracking.held_force, deviation = tracking.force_deviation,
               speed = tracking.speed_deviation, tilt = tracking.tilt_deg;
  const bool follows = tracking.follows_path;
  const ShownUnit& force = shown_units().force;
  std::string text = "controller:";
  if (!std::isnan(held)) {
    text += fmt::format(" contact force {} held ({} wanted", force.text(held),
                        force.text(tracking.wanted_force));
    if (!std::isnan(deviation))
      text += fmt::format(", within {} in the last {:.0f} ms", calibration::percent(deviation),
                          1e3 * held_time);
    text += "),";
  } else if (follows && !std::isnan(speed)) {
    text += fmt::format(" speed within {:.2f} %,", 100.0 * speed);
  }
  if (const auto& end = summary.end; end && !follows) {
    text += fmt::format(" {} at {} at the end ({:.3g} s),", force.text(end->normal_force),
                        shown_units().length.text(end->indentation), end->time);
  }
  // What is no more than round-off is not told by its digits.
  if (!std::isnan(tilt))
    text +=
        fmt::format(" tilt within {} degrees", tilt < 1e-9 ? "1e-9" : fmt::format("{:.2g}", tilt));
  else if (summary.census.sectors > 1)
    text += " no tilt on mirror planes (run.symmetry)";
  fmt::print("{}\n", text);
}

/// How each stage of a program went, and what the press cost; NaN: not known, or no loop [J].
void print_program(const std::vector<StageEntry>& program, double work_in, double loop_area) {
  if (!program.empty()) fmt::print("{}", report::table_text(report::stage_table(program)));
  if (!std::isnan(work_in)) fmt::print("work put in: {:.4g} mJ\n", 1e3 * work_in);
  if (!std::isnan(loop_area))
    fmt::print("work not given back (area of the loop): {:.4g} mJ\n", 1e3 * loop_area);
}

void print_press_facts(const PressSummary& summary, bool reused) {
  print_program(summary.program, summary.work_in, summary.loop_area);
  if (summary.rests()) {
    const StaticCensusEntry& census = summary.static_census;
    fmt::print("{} particles ({} of the tip), {} Newton iterations\n", census.particles,
               census.sectors == 1 ? "all" : fmt::format("1/{}", census.sectors),
               summary.effort.newton_iterations);
    return;
  }
  fmt::print("time step {:.3g} s: {}\n", summary.step.step, summary.step.explanation);
  const long parts = summary.census.sectors;
  fmt::print("real-time factor {:.2f} (simulated over wall time, threads: {}{}{})\n",
             summary.real_time_factor, summary.threads,
             parts > 1 ? fmt::format("; 1/{} of the tip computed, forces are of all", parts) : "",
             reused ? "; of the run that computed it" : "");
  if (summary.controlled()) print_control(summary);
}

/// The files that a press takes something from.
void print_sources(const LoadedConfig& loaded) {
  const Config& config = loaded.config;
  if (!config.constants_file.empty())
    fmt::print("constants of the lattice: {}\n", config.constants_file.string());
  if (!config.controller.schedule.empty() && config.press.protocol.mode == meshes::DriveMode::pid)
    fmt::print("stiffness of the contact scheduled on {}\n", config.controller.schedule.string());
}

/// The summary.json of a run, which gets what belongs to the run: what the job computes does not
/// depend on it, so it is no part of its cached result.
class ToldSummary {
 public:
  explicit ToldSummary(std::filesystem::path folder)
      : folder_(std::move(folder)), content_(parse_json(folder_ / summary_name)) {}

  PressSummary press() const {
    return struct_of<PressSummary>(JsonEntry(content_, folder_ / summary_name));
  }
  /// The run's notes where scripts look.
  void put_warnings(const std::vector<std::string>& notes) {
    put("warnings", notes.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(notes));
  }
  /// Null takes the entry away.
  void put(const char* entry, const nlohmann::ordered_json& value) {
    content_.erase(entry);
    if (!value.is_null()) content_[entry] = value;
    rewrite_result(folder_, summary_name, content_);
  }

 private:
  static constexpr const char* summary_name = "summary.json";
  std::filesystem::path folder_;
  nlohmann::ordered_json content_;
};

/// What a skin felt, that its footprint is too fine, and where markers went.
void print_sensors(const std::filesystem::path& folder, const std::vector<meshes::TaxelRow>& felt,
                   const std::string& finer) {
  if (!felt.empty()) fmt::print("{}\n", taxel_words(felt));
  if (const std::string words = marker_words(folder); !words.empty()) fmt::print("{}\n", words);
  if (!finer.empty()) fmt::print(stderr, "fingertip: note: {}\n", finer);
}

/// Of the run of a press; empty of one without markers.
std::vector<meshes::MarkerRow> markers_in(const std::filesystem::path& folder) {
  const std::filesystem::path table = folder / "markers.csv";
  return std::filesystem::exists(table) ? meshes::read_rows<meshes::MarkerRow>(table)
                                        : std::vector<meshes::MarkerRow>();
}

struct ContinuumPress {
  meshes::PressResponse response = {};
  std::vector<meshes::MarkerRow> markers = {};
};

/// The continuum's press for the error of a lattice's; empty where it failed, and `source` is then
/// the estimate.
ContinuumPress press_continuum(Session& session, lattice::ModelKind model, ErrorSource& source) {
  PlannedJob planned{"continuum", reference_job(*source.continuum), false};
  // A run of seconds starts again: one that goes on in the middle of a sample differs by round-off.
  if (source.continuum->axisymmetric()) planned.job.resumable = false;
  ContinuumPress press;
  const std::string failure = failure_of([&] {
    session.run(planned);
    const std::filesystem::path folder = session.path_of(planned);
    press.response = meshes::PressResponse::read_csv(folder / "response.csv");
    press.markers = markers_in(folder);
  });
  if (!failure.empty()) source = estimated_source(model, "the continuum failed: " + failure);
  return press;
}

/// Gives a press that is done the error of its forces, as `run.error` says: the column force_error
/// of its response.csv, force_error in its summary.json; and that of its markers. Nothing where
/// none is wanted.
std::optional<ForceErrorEntry> find_force_error(ErrorSource source,
                                                const lattice::PressSetup& setup, Session& session,
                                                ToldSummary& told,
                                                meshes::PressResponse& response) {
  const std::filesystem::path& folder = session.folder().path();
  const ContinuumPress continuum =
      source.continuum ? press_continuum(session, setup.lattice.model, source) : ContinuumPress();
  // Also where neither is wanted: the job has its estimate, and a resumed folder what was found.
  const lattice::ForceEstimator estimator(setup);
  response = source.estimated
                 ? with_estimated_error(response, estimator)
                 : with_pressure_error(with_force_error(response, continuum.response), estimator);
  response.write_csv(folder / "response.csv");
  mark_rewritten(folder, "response.csv");
  if (const auto markers = markers_in(folder); !markers.empty()) {
    meshes::write_rows(source.estimated ? with_estimated_error(markers, response, estimator)
                                        : with_marker_error(markers, response, continuum.markers,
                                                            continuum.response),
                       folder / "markers.csv");
    mark_rewritten(folder, "markers.csv");
  }
  if (source.statement.empty()) {
    told.put("force_error", {});
    return {};
  }
  ForceErrorEntry entry{source.statement};
  std::vector<meshes::PressSample> known = wanted_samples(response, setup.protocol);
  std::erase_if(known, [](const meshes::PressSample& sample) {
    return !std::isfinite(sample.force_error / sample.normal_force);
  });
  if (const WorstError worst = worst_error(known); worst.relative > 0.0) {
    entry.largest = worst.relative;
    entry.indentation = worst.indentation;
  }
  told.put("force_error", meshes::json_of<nlohmann::ordered_json>(entry));
  return entry;
}

}  // namespace

int run_press(const CommandLine& line) {
  std::optional<RealTimeRun> real_time;
  if (line.real_time) real_time = real_time_run(line);
  LoadedConfig loaded =
      with_material(real_time ? real_time->loaded : load_checked(line), LatticeUse::press);
  const lattice::PressSetup setup = press_setup(loaded);
  for (const auto& notes : {law_notes(setup), scaling_notes(setup)})
    loaded.notes.insert(loaded.notes.end(), notes.begin(), notes.end());
  const std::vector<std::string> warnings = loaded.notes;
  if (real_time) loaded.notes.push_back(real_time->note());
  if (loaded.config.automatic_integrator) loaded.notes.push_back(integrator_note(setup));
  if (const auto note = duration_note(setup, cores_for(loaded))) loaded.notes.push_back(*note);
  if (line.movie > 0 && setup.protocol.mode == meshes::DriveMode::equilibrium) {
    throw ConfigError({"press.mode", "static", "a press without time has no movie",
                       "choose pid or quasi-static", "--movie"});
  }
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const std::filesystem::path& folder = session.folder().path();
    const ErrorSource source = source_at_hand(loaded, session.cache());
    if (source.continuum) session.expect_later(reference_job(*source.continuum).weight);
    Job job = press_job(setup, line.movie);
    if (real_time) {
      real_time->write(folder);
      job.repeatable = false;  // it is this machine's time that is asked for
    }
    const JobResult result = session.run({"", std::move(job), false});
    ToldSummary told(folder);
    told.put_warnings(warnings);
    const PressSummary summary = told.press();
    auto response = meshes::PressResponse::read_csv(folder / "response.csv");
    session.expect_later(0.0);
    const auto error = find_force_error(source, setup, session, told, response);
    const auto felt = write_contact_files(folder, setup, FieldOf::lattice);
    const std::string finer = footprint_note(felt, setup.hardware.skin.footprint);
    if (!finer.empty()) {
      std::vector<std::string> all = warnings;
      all.push_back(finer);
      told.put_warnings(all);
    }
    if (!line.quiet) {
      fmt::print("{} lattice, {} contact, {} press\n", lattice::name(setup.lattice.model),
                 meshes::name(setup.protocol.contact), meshes::name(setup.protocol.mode));
      print_response(response, setup.protocol);
      if (error) fmt::print("{}\n", error_words(*error));
      if (const std::string beyond = error ? beyond_tolerance(loaded, *error) : ""; !beyond.empty())
        fmt::print("{}\n", beyond);
      print_sensors(folder, felt, finer);
      print_press_facts(summary, result.reused);
      print_sources(loaded);
    }
    if (real_time) {
      real_time->record.slowest_factor = summary.slowest_real_time_factor;
      real_time->record.whole_factor = summary.real_time_factor;
      real_time->record.step = summary.step.step;
      real_time->record.force_error = error;
      real_time->write(folder);
      told.put("real_time", meshes::json_of<nlohmann::ordered_json>(real_time->record));
    }
    if (line.quiet) return 0;
    if (real_time) fmt::print("{}", real_time->text());
    if (line.movie > 0)
      fmt::print("movie for ParaView: {}\n", (folder / "movie/movie.pvd").string());
    print_folder(session, result);
    return 0;
  });
}

int run_modes(const CommandLine& line) {
  LoadedConfig loaded = at_pace(load_config(line.config));
  // Whatever the press is: nothing moves here, so what only static presses know is welcome.
  loaded.config.press.protocol.mode = meshes::DriveMode::equilibrium;
  loaded.config.press.protocol.contact = meshes::ContactMode::stick;
  check_all(loaded);
  loaded = with_material(loaded, LatticeUse::modes);
  const lattice::PressSetup setup = press_setup(loaded);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const JobResult result =
        session.run({"", modes_job(setup, loaded.config.lattice_modes), false});
    ToldSummary(session.folder().path()).put_warnings(loaded.notes);
    if (line.quiet) return 0;
    fmt::print("{} lattice, natural frequencies\n", lattice::name(setup.lattice.model));
    print_frequencies(session.folder().path());
    print_folder(session, result);
    return 0;
  });
}

int run_reference(const CommandLine& line) {
  const LoadedConfig loaded = with_material(load_config(line.config), LatticeUse::none);
  check_all(loaded);
  const fem_reference::ReferenceJob reference = continuum_setup(loaded);
  return run_in_folder(line, loaded, {}, [&](Session& session) {
    const JobResult result = session.run({"", reference_job(reference), false});
    const std::filesystem::path& folder = session.folder().path();
    const bool press = reference.analysis != fem_reference::Analysis::modes;
    const auto response =
        press ? meshes::PressResponse::read_csv(folder / "response.csv") : meshes::PressResponse();
    const auto felt = write_contact_files(folder, loaded.config.press, FieldOf::continuum);
    const std::string finer = footprint_note(felt, loaded.config.press.hardware.skin.footprint);
    const WorstError worst = worst_error(response.samples());
    const bool reached = !reference.estimate_error || !(worst.relative > reference.tolerance);
    if (!line.quiet) {
      fmt::print("{}\n", heading(reference));
      if (press) {
        print_response(response, reference.protocol);
        print_program(stage_entries(reference.protocol, response), meshes::unknown,
                      reference.protocol.goes_back() ? work_along(response) : meshes::unknown);
        print_sensors(folder, felt, finer);
        if (reference.estimate_error) print_accuracy(folder, reference, worst);
      } else {
        print_frequencies(folder);
      }
      print_folder(session, result);
    }
    std::vector<std::string> warnings;
    if (!finer.empty()) warnings.push_back(finer);
    if (!reached) warnings.push_back("force_error over normal_force exceeds reference.tolerance");
    if (!warnings.empty()) ToldSummary(folder).put_warnings(warnings);
    if (reached) return 0;
    fmt::print(stderr,
               "fingertip: not converged: the force may be off by more than reference.tolerance = "
               "{:.3g}; the run is kept, with its error bars{}\n",
               reference.tolerance,
               reference.analysis == fem_reference::Analysis::transient
                   ? ". In time the error is that of the steps, too, and most at small depths: ask "
                     "for deeper samples or a larger tolerance"
                   : "");
    return 3;
  });
}

}  // namespace fingertip::studies::inline cli::inline verbs
