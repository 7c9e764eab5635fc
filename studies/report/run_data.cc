#include "studies/report/run_data.h"

#include <algorithm>
#include <cmath>

#include "meshes/errors.h"

namespace fingertip::studies::reporting {
namespace {

namespace fs = std::filesystem;

/// The first finite one of several spellings.
double first_of(const JsonEntry& object, std::initializer_list<const char*> keys) {
  for (const char* key : keys) {
    const double value = number_at(object, key);
    if (std::isfinite(value)) return value;
  }
  return meshes::unknown;
}

Target read_target(const JsonEntry& object) {
  Target target;
  target.youngs_modulus = first_of(object, {"youngs_modulus", "E"});
  target.shear_modulus = first_of(object, {"shear_modulus", "G"});
  if (!(target.youngs_modulus > 0.0 && target.shear_modulus > 0.0)) return target;
  // What follows from E and G need not be in the file.
  const double E = target.youngs_modulus, G = target.shear_modulus;
  target.poissons_ratio = E / (2.0 * G) - 1.0;
  target.bulk_modulus = E * G / (3.0 * (3.0 * G - E));
  return target;
}

Moduli moduli_of(const JsonEntry& entry) {
  return {number_at(entry, "E_100"), number_at(entry, "E_110"),  number_at(entry, "E_111"),
          number_at(entry, "G"),     number_at(entry, "nu_100"), number_at(entry, "K")};
}

ModelData read_model(const fs::path& folder, const std::string& name, const JsonEntry& entry,
                     FolderReader& reader) {
  ModelData model;
  model.name = name;
  model.status = text_at(entry, "status");
  model.moduli = moduli_of(entry);
  model.force_error = numbers_at(entry, "force_error");
  model.l2_error = number_at(entry, "relative_l2_force_error");
  model.real_time_factor = number_at(entry, "real_time_factor");
  reader.note_missing(folder / name);
  model.summary = reader.json(folder / name / "summary.json");
  model.calibration = reader.json(folder / ("calibration_" + name) / "calibration.json");
  model.response = reader.response(folder / name / "response.csv");
  model.trace = reader.csv(folder / name / "trace.csv");
  model.boundary = reader.csv(folder / name / "boundary.csv");
  model.boundary_springs = reader.csv(folder / name / "boundary_springs.csv");
  model.snapshots = reader.csv(folder / name / "snapshots.csv");
  model.snapshot_points = reader.csv(folder / name / "snapshot_points.csv");
  return model;
}

/// The order of the story: as printed, as fitted, as it should be; then whatever else was run.
std::vector<std::string> ordered_models(const JsonEntry& models) {
  std::vector<std::string> names{"published", "central", "hookean"};
  std::erase_if(names, [&](const std::string& name) { return !models.contains(name); });
  for (const auto& [name, entry] : models.members()) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

std::vector<Criterion> read_criteria(const JsonEntry& summary) {
  std::vector<Criterion> criteria;
  for (const JsonEntry& entry : array_at(summary, "criteria"))
    criteria.push_back({text_at(entry, "name"), number_at(entry, "value"),
                        number_at(entry, "limit"), entry.at("passed").flag()});
  return criteria;
}

}  // namespace

double largest_magnitude(const std::vector<double>& values) {
  double result = meshes::unknown;
  for (const double one : values) result = std::fmax(result, std::abs(one));
  return result;
}

double force_at(const meshes::PressResponse& response, double depth) {
  if (response.empty() || depth > response.depth() * (1.0 + 1e-6)) return meshes::unknown;
  return response.normal_force_at(std::min(depth, response.depth()));
}

double ModelData::last_force_error() const {
  double last = meshes::unknown;
  for (double error : force_error) {
    if (std::isfinite(error)) last = error;
  }
  return last;
}

const ModelData* RunData::model(const std::string& name) const {
  for (const ModelData& candidate : models) {
    if (candidate.name == name) return &candidate;
  }
  return nullptr;
}

namespace {

/// What summary.json itself tells.
void take_summary(RunData& run, FolderReader& reader) {
  const JsonEntry& summary = run.summary;
  const auto attempt = [&](auto& target, const auto& read) {
    target = reader.attempt([&] { return read(); });
  };
  attempt(run.case_name, [&] { return text_at(summary, "case"); });
  attempt(run.title, [&] { return text_at(summary, "title"); });
  attempt(run.description, [&] { return text_at(summary, "description"); });
  attempt(run.status, [&] { return text_at(summary, "status"); });
  attempt(run.depths, [&] { return numbers_at(summary, "depths"); });
  attempt(run.criteria, [&] { return read_criteria(summary); });
  attempt(run.study, [&] { return object_at(summary, "variants"); });
  attempt(run.calibration, [&] { return object_at(summary, "calibration"); });
  attempt(run.presses, [&] { return array_at(summary, "presses"); });
  attempt(run.grasps, [&] { return array_at(summary, "grasps"); });
}

/// The lattice that a fit to moduli found.
ModelData fitted_model(const RunData& run) {
  const JsonEntry moduli = object_at(run.summary, "moduli");
  ModelData model;
  model.name = text_at(run.own_calibration, "model");
  model.status = "ok";
  model.calibration = run.own_calibration;
  model.moduli = moduli_of(moduli);
  return model;
}

/// The rubber, wherever a file tells it first.
Target find_target(const RunData& run) {
  Target target = read_target(object_at(run.summary, "target"));
  // Presses of the continuum name their reference otherwise.
  if (std::isnan(target.bulk_modulus) && !run.summary.at("reference").is_text())
    target = read_target(object_at(run.summary, "reference"));
  for (const ModelData& model : run.models) {
    if (std::isfinite(target.bulk_modulus)) break;
    target = read_target(object_at(model.calibration, "target"));
  }
  return target;
}

}  // namespace

bool is_moduli_fit(const RunData& run) {
  return run.own_calibration.contains("constants") && !run.own_calibration.contains("problem");
}

bool is_continuum(const fs::path& folder) {
  return fs::exists(folder / "job.json");
}

RunData read_run(const fs::path& folder, FolderReader& reader) {
  RunData run;
  run.folder = folder;
  const auto has = [&](const char* name) { return fs::exists(fs::symlink_status(folder / name)); };
  if (!has("summary.json") && !has("calibration.json") && !has("finished.json")) {
    throw meshes::InvalidInput(
        {folder.string(), "", "holds no summary.json, which every run that came to a result has",
         fs::exists(folder / "sweep.json") ? "of a sweep, name a folder in its points/"
                                           : "name the folder of a run, or run it to its end"});
  }
  reader.note_missing(folder);
  run.own_calibration = reader.json(folder / "calibration.json");
  if (!run.own_calibration.empty())
    reader.attempt([&] {
      if (!run.own_calibration.contains("constants") && !run.own_calibration.contains("problem"))
        throw meshes::InvalidInput({(folder / "calibration.json").string(), "",
                                    "tells neither what was fitted (problem) nor constants",
                                    "calibrate again"});
    });
  run.summary = reader.json(folder / "summary.json");
  run.manifest = reader.json(folder / "manifest.json");
  run.verb = reader.attempt([&] { return text_at(run.manifest, "verb"); });
  if (run.verb.empty()) run.verb = run.own_calibration.empty() ? "validate" : "calibrate";
  take_summary(run, reader);
  run.parameters = reader.text(folder / "parameters.toml");
  run.response = reader.response(folder / "response.csv");
  run.contact = reader.csv(folder / "contact.csv");
  run.modes = reader.csv(folder / "modes.csv");
  const fs::path continuum = is_continuum(folder) ? folder : folder / "reference";
  if (continuum != folder) reader.note_missing(continuum);
  run.reference_summary = reader.json(continuum / "summary.json");
  run.reference = reader.response(continuum / "response.csv");
  run.reference_job = reader.json(continuum / "job.json");
  run.verification = reader.json(folder / "verification" / "verification.json");
  run.convergence = reader.csv(continuum / "convergence.csv");
  run.section = reader.csv(continuum / "section.csv");
  run.pressure = reader.csv(continuum / "pressure.csv");
  run.cubes = reader.csv(folder / "cubes.csv");
  run.published_study = reader.csv(folder / "published_study.csv");
  run.equilibrium_study = reader.csv(folder / "equilibrium_study.csv");
  run.variants = reader.csv(folder / "variants.csv");
  const JsonEntry models = reader.attempt([&] { return object_at(run.summary, "models"); });
  for (const std::string& name : ordered_models(models)) {
    run.models.push_back(
        reader.attempt([&] { return read_model(folder, name, models.at(name), reader); }));
    run.models.back().name = name;
    run.models.back().force_error.resize(run.depths.size(), meshes::unknown);
  }
  if (is_moduli_fit(run)) run.models.push_back(reader.attempt([&] { return fitted_model(run); }));
  run.target = reader.attempt([&] { return find_target(run); });
  if (run.depths.empty() && is_continuum(folder))
    for (const meshes::PressSample& sample : run.reference.pressing())
      run.depths.push_back(sample.indentation);
  return run;
}

}  // namespace fingertip::studies::reporting
