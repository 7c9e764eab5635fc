#include "studies/cases/planner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "lattice/press/setup_fields.h"
#include "meshes/base/files.h"
#include "meshes/press/markers.h"
#include "meshes/tables/fields_json.h"
#include "studies/cases/measures.h"
#include "studies/config/finger_defaults.h"
#include "studies/config/keys/key_table.h"
#include "studies/files/read_fields.h"
#include "studies/fits/runs/displacement_job.h"
#include "studies/fits/runs/law_job.h"
#include "studies/fits/runs/moduli_job.h"
#include "studies/presses/grasp_job.h"
#include "studies/presses/press_job.h"
#include "studies/presses/press_record.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"
#include "studies/presses/taxel_record.h"

namespace fingertip::studies::inline cases {

namespace {

namespace fs = std::filesystem;

/// Whether the run is made at this spacing at all.
bool is_wanted(const CaseRun& run, const LoadedConfig& loaded, const LoadedConfig& own) {
  if (run.when.empty()) return true;
  const meshes::Geometry& geometry = loaded.config.press.geometry;
  const double ratio = loaded.config.press.lattice.spacing / own.config.press.lattice.spacing;
  const bool allowed = loaded.config.press.lattice.spacing <= geometry.coarsest_spacing();
  return allowed && (run.when == "coarser" ? ratio > 1.0 + 1e-9 : std::abs(ratio - 1.0) >= 1e-9);
}

/// The continuum pressed as `loaded` says, in time.
fem_reference::ReferenceJob continuum_at_speed(LoadedConfig loaded) {
  fem_reference::ReferenceJob& reference = loaded.config.reference;
  reference.analysis = fem_reference::Analysis::transient;
  reference.strain = fem_reference::Strain::linear;
  reference.write_fields = false;
  return continuum_setup(loaded);
}

/// The case with the fit's settings, then the prediction's.
LoadedConfig predicted_config(const Case& study_case, const CaseRun& fit,
                              const CaseRun& prediction) {
  CaseRun both = prediction;
  both.sets.insert(both.sets.begin(), fit.sets.begin(), fit.sets.end());
  both.name = fit.name + " predicts " + prediction.name;
  return run_config(study_case, both);
}

calibration::FitFile fit_in(const JsonEntry& file) {
  if (file.contains("problem")) return struct_of<calibration::FitFile>(file);
  const auto moduli = struct_of<calibration::ModuliFile>(file);
  calibration::FitFile fit = as_fit(moduli);
  fit.unidentifiable.resize(moduli.unidentifiable.size());
  return fit;
}

void read_summary(const fs::path& place, RunResult& result) {
  const std::string& verb = result.run->verb;
  const fs::path file = place / (verb == "fit"             ? "calibration.json"
                                 : verb == "laws"          ? "laws.json"
                                 : verb == "displacements" ? "displacements.json"
                                                           : "summary.json");
  if (!fs::exists(file)) return;
  if (verb == "press") result.press = struct_of<PressSummary>(read_entry(file));
  if (verb == "grasp") result.grasp = struct_of<GraspSummary>(read_entry(file));
  if (verb == "fit") result.found = fit_in(read_entry(file));
  if (verb == "displacements")
    result.ratio = struct_of<calibration::DisplacementFitFile>(read_entry(file));
  if (verb == "laws") result.laws = struct_of<calibration::LawsFile>(read_entry(file));
}

/// Laws to material tests, the run's own law and test among them.
LawInput laws_of(const LoadedConfig& loaded, const CaseRun& run) {
  LawInput input = law_input(loaded);
  const auto known = [&](const calibration::LawChoice& law) { return name(law) == run.law; };
  if (!run.law.empty() && std::ranges::none_of(input.laws, known))
    throw ConfigError(
        {"case.material.law", run.law, "is not fitted", "name one of calibration.laws", run.place});
  std::vector<std::string> tests;
  for (const auto* list : {&input.tests.fitted, &input.tests.validation})
    for (const calibration::MaterialTest& test : *list) tests.push_back(test.name);
  if (!run.test.empty() && std::ranges::find(tests, run.test) == tests.end())
    throw ConfigError({"case.material.test", run.test, "there is no such test",
                       "the nearest one is " + nearest_word(run.test, tests), run.place});
  return input;
}

/// Whether the contact of a variant is drawn, with what its skin feels.
bool is_drawn(const CaseRun& run) {
  return run.is("variant") && run.snapshots;
}

/// Where displacements were measured the press has a sample.
void check_samples(const DisplacementFile& measured, const meshes::PressProtocol& protocol,
                   const std::string& place) {
  for (const calibration::MeasuredDisplacements& sample : measured.samples)
    if (std::ranges::find(protocol.samples, sample.indentation) == protocol.samples.end())
      throw ConfigError({"press.samples", "",
                         "displacements were measured at " + meshes::to_text(sample.indentation) +
                             " m, where no sample is",
                         "put it among the samples", place});
}

/// Continua first, then the longest, so that the workers end together.
void sort(std::vector<PlannedJob>& jobs) {
  std::ranges::stable_sort(jobs, std::greater(), [](const PlannedJob& planned) {
    return std::pair(planned.job.kind == "reference", planned.job.weight);
  });
}

}  // namespace

std::string as_folder(std::string text) {
  for (char& c : text) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.';
    if (!plain) c = '_';
  }
  if (text.starts_with('.')) text.front() = '_';
  return text;
}

const std::vector<std::string>& run_verbs() {
  static const std::vector<std::string> verbs = {"press",  "reference", "verification",
                                                 "moduli", "cubes",     "displacements"};
  return verbs;
}

Planner::Planner(const Case& study_case) : case_(study_case) {
  for (const RunKind& kind : run_kinds()) folders_.insert(kind.folder);
  folders_.insert("continuum");
  // What runs below a run would be cleared away with it.
  for (const CaseRun& run : study_case.runs)
    if (run.is("run") && !run.series.empty()) folders_.insert(as_folder(run.series));
  // The core case's models: the published one can do least.
  const auto core = std::ranges::find(study_case.runs, "published", full_name);
  if (core != study_case.runs.end() && core->is_verdict()) check_validation(study_case.loaded);
  std::vector<meshes::Violation> problems;
  for (const CaseRun& run : study_case.runs) {
    try {
      add(run);
    } catch (const ConfigError& error) {
      append(problems, error.violations());
    }
  }
  if (!problems.empty()) throw ConfigError(problems);
}

void Planner::add(const CaseRun& run) {
  if (run.is("prediction")) return;  // with each fit
  const LoadedConfig loaded = run_config(case_, run);
  if (!is_wanted(run, loaded, case_.loaded)) return;
  RunResult result{.run = &run, .beside = results_.size()};
  if (run.verb == "fit") return add_fit(loaded, std::move(result));
  try {
    if (run.verb == "press") add_press(loaded, result);
    result.folder = planned(result, job_of(loaded, result));
    if (is_drawn(run))
      for (const std::string& folder : {result.folder, result.against}) keep_skin(result, folder);
  } catch (const ConfigError& error) {
    throw at_run(error, run);
  }
  results_.push_back(std::move(result));
}

/// Its setup, and what its forces are compared with.
void Planner::add_press(const LoadedConfig& loaded, RunResult& result) {
  const CaseRun& run = *result.run;
  result.setup = press_setup(loaded);
  if (!run.displacements.empty()) {
    result.displacements.measured = measured(run);
    check_samples(*result.displacements.measured, result.setup.protocol, run.place);
    put_markers(*result.displacements.measured, result.setup.geometry, run.place,
                result.setup.protocol);
  }
  const bool at_rest = result.setup.protocol.mode == meshes::DriveMode::equilibrium;
  if (run.is("press") && at_rest)
    throw ConfigError({"press.mode", "static", "a press under a controller takes time",
                       "choose pid, or a case with variants"});
  if (run.is("variant") && run.beside.empty()) {
    fem_reference::ReferenceJob reference =
        continuum_beside(loaded, result.setup.lattice.kinematics);
    if (!result.displacements.empty()) reference.protocol.markers = result.setup.protocol.markers;
    result.against = continuum_of(reference);
  }
  if (run.is("press") && run.continuum) result.against = continuum_of(continuum_at_speed(loaded));
  for (std::size_t i = 0; i < results_.size() && !run.beside.empty(); ++i) {
    const CaseRun& other = *results_[i].run;
    if (!other.is(run.kind) || full_name(other) != run.beside) continue;
    if (run.is("run"))
      result.against = results_[i].folder;
    else
      result.beside = i;
    // One finger, two ways to write it: the other one's continuum is its own.
    if (run.is("variant")) result.against = results_[i].against;
  }
}

std::shared_ptr<const DisplacementFile> Planner::measured(const CaseRun& run) {
  std::shared_ptr<const DisplacementFile>& file = measured_[run.displacements];
  if (!file) file = std::make_shared<const DisplacementFile>(read_displacements(run.displacements));
  return file;
}

/// taxels.csv stands in the folder of a job, which does not know of it.
void Planner::keep_skin(const RunResult& result, const std::string& folder) {
  const std::string skin =
      meshes::json_of<nlohmann::ordered_json>(result.setup.hardware.skin).dump();
  const auto [known, is_new] = skins_.try_emplace(folder, skin);
  if (!is_new && known->second != skin)
    throw ConfigError({"sensor.taxels", "another skin",
                       "the same press stands in this case with one skin and with another",
                       "give both the same skin", result.run->place});
}

void Planner::add_fit(const LoadedConfig& loaded, RunResult result) {
  result.folder = free_folder(*result.run);
  try {
    // Criteria judge what comes of a fit, also of one that failed its own tests.
    fits_.push_back({CalibrationStages(loaded, result.folder, CalibrationStages::Failed::kept)});
  } catch (const ConfigError& error) {
    throw at_run(error, *result.run);
  }
  results_.push_back(result);
  for (const CaseRun& prediction : case_.runs)
    if (is_asked(prediction, *result.run)) add_prediction(prediction, result);
}

/// The press itself needs the fit's material.
void Planner::add_prediction(const CaseRun& prediction, const RunResult& fit) {
  const LoadedConfig loaded = predicted_config(case_, *fit.run, prediction);
  results_.push_back(
      {.run = &prediction,
       .fit = fit.run,
       .folder = fit.folder + "/predicts/" + as_folder(prediction.name),
       .against = continuum_of(continuum_beside(loaded, loaded.config.press.lattice.kinematics)),
       .beside = results_.size()});
}

Job Planner::job_of(const LoadedConfig& loaded, RunResult& result) {
  const std::string& verb = result.run->verb;
  const Config& config = loaded.config;
  if (verb == "press") return press_job(result.setup);
  if (verb == "grasp") return grasp_job(grasp_setup(loaded));
  if (verb == "reference") return reference_job(continuum_setup(loaded));
  if (verb == "laws") return law_job(laws_of(loaded, *result.run));
  if (verb == "verification") return verification_job();
  if (verb == "displacements")
    return displacement_job(displacement_input(loaded, *measured(*result.run),
                                               "ratios/" + as_folder(result.run->name)));
  if (verb == "moduli")
    return moduli_job(config.press.rubber, fit_options(loaded, config.press.lattice.model));
  const auto constants_of = [&](const char* model) {
    LoadedConfig own =
        with_sets(loaded, {std::string("lattice.model=") + model, "lattice.constants=auto"});
    keep_spacing(own, loaded);
    return press_setup(own).lattice.constants;
  };
  return cubes_job(config.press.rubber, constants_of("central"), constants_of("hookean"),
                   config.press.lattice.spacing);
}

std::string Planner::planned(const RunResult& result, Job job) {
  std::string& folder = folder_of_key_[job.key()];
  if (!folder.empty()) return folder;
  folder = free_folder(*result.run);
  if (result.run->is("material")) folder += "/laws";  // its plates stand beside it
  // Slower approaches take more steps.
  if (result.run->is("press")) job.weight *= 0.01 / result.setup.protocol.speed;
  jobs_.push_back({folder, std::move(job), result.run->exhibit || !result.run->is("run")});
  return folder;
}

std::string Planner::free_folder(const CaseRun& run) {
  const RunKind& kind = *std::ranges::find(run_kinds(), run.kind, &RunKind::name);
  std::string folder = kind.folder.empty() ? "" : kind.folder + "/";
  if (!run.series.empty() && !run.is("fit")) folder += as_folder(run.series) + "/";
  folder += as_folder(run.name);
  while (!folders_.insert(folder).second) folder += "_";
  return folder;
}

std::string Planner::continuum_of(const fem_reference::ReferenceJob& reference) {
  const Job job = reference_job(reference);
  const std::string key = job.key();
  const auto found = std::ranges::find(continua_, key, &Continuum::key);
  if (found != continua_.end()) return found->folder;
  const std::string folder = fmt::format("continuum/{}", continua_.size() + 1);
  continua_.push_back({folder, reference, key});
  jobs_.push_back({folder, job, false});
  return folder;
}

/// Fits go on stage by stage, all side by side; when none has anything left, the predictions.
std::vector<PlannedJob> Planner::next(const fs::path& folder) {
  std::vector<PlannedJob> jobs = std::exchange(jobs_, {});
  for (Fit& fit : fits_) {
    if (fit.done) continue;
    const std::vector<PlannedJob> more = fit.stages.next(folder);
    fit.done = more.empty();
    jobs.insert(jobs.end(), more.begin(), more.end());
  }
  if (jobs.empty() && !std::exchange(predicted_, true)) jobs = predictions(folder);
  sort(jobs);
  return jobs;
}

double Planner::later_weight() const {
  double weight = 0.0;
  for (const Fit& fit : fits_) weight += fit.stages.later_weight();
  if (predicted_) return weight;
  for (const RunResult& result : results_)
    if (result.fit != nullptr)
      weight += press_weight(predicted_config(case_, *result.fit, *result.run).config.press);
  return weight;
}

std::vector<PlannedJob> Planner::predictions(const fs::path& folder) {
  std::vector<PlannedJob> jobs;
  const RunResult* fit = nullptr;
  for (RunResult& result : results_) {
    if (result.run->is("fit")) fit = &result;
    if (result.fit == nullptr) continue;
    const fs::path material = fs::absolute(folder / fit->folder / "material.toml");
    LoadedConfig own = with_sets(predicted_config(case_, *result.fit, *result.run),
                                 {"lattice.constants=" + material.string()});
    keep_spacing(own, case_.loaded);
    result.setup = press_setup(own);
    jobs.push_back({result.folder, press_job(result.setup), true});
  }
  return jobs;
}

RunResults Planner::results(const fs::path& folder, const std::vector<JobResult>& jobs) const {
  RunResults results = results_;
  for (RunResult& result : results) {
    const auto job = std::ranges::find(jobs, result.folder, &JobResult::name);
    if (job != jobs.end()) result.status = job->status;
    const fs::path place = folder / result.folder;
    read_summary(place, result);
    if (is_drawn(*result.run)) {
      write_taxels(place, result.setup, FieldOf::lattice);
      if (!result.against.empty())
        write_taxels(folder / result.against, result.setup, FieldOf::continuum);
      result.contact = contact_errors(result.setup, place, folder / result.against);
    }
    const meshes::PressProtocol& protocol = result.setup.protocol;
    const bool verdict = result.run->is_verdict();
    if (verdict || !result.against.empty())
      result.forces = compare_forces(
          response_in(place),
          result.against.empty() ? meshes::PressResponse() : response_in(folder / result.against),
          verdict ? verdict_depths(protocol.depth) : protocol.samples);
    if (!result.displacements.empty())
      result.displacements =
          compare_displacements(result.displacements.measured, place, folder / result.against);
    const RunResult& other = results[result.beside];
    if (&other != &result)
      result.change = compare_forces(response_in(place), response_in(folder / other.folder),
                                     other.setup.protocol.samples);
    result.measures = measures_of_run(case_, result, place);
  }
  return results;
}

}  // namespace fingertip::studies::inline cases
