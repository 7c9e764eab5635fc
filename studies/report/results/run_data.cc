#include "studies/report/results/run_data.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>

#include "meshes/base/errors.h"

namespace fingertip::studies::report::inline results {
namespace {

namespace fs = std::filesystem;

/// What follows from E and G need not be in the file.
TargetEntry target_of(double E, double G) {
  TargetEntry target;
  target.youngs_modulus = E;
  target.shear_modulus = G;
  if (!(E > 0.0 && G > 0.0)) return target;
  target.poissons_ratio = E / (2.0 * G) - 1.0;
  target.bulk_modulus = E * G / (3.0 * (3.0 * G - E));
  return target;
}

ModelData read_model(const fs::path& folder, const std::string& name, const ModelEntry& entry,
                     FolderReader& reader) {
  ModelData model;
  static_cast<PressFiles&>(model) = read_press_files(folder / name, reader);
  model.name = name;
  model.status = entry.status;
  model.moduli = entry;
  model.force_error = entry.force_error;
  model.l2_error = entry.relative_l2_force_error;
  model.real_time_factor = entry.real_time_factor;
  model.calibration = reader.take<calibration::ModuliFile>(
      reader.json(folder / ("calibration_" + name) / "calibration.json"));
  model.response = reader.response(folder / name / "response.csv");
  model.contact = reader.rows<meshes::ContactPoint>(folder / name / "contact_field.csv");
  model.markers = reader.rows<meshes::MarkerRow>(folder / name / "markers.csv");
  return model;
}

/// A number of a row in another table must be one of its `count` rows.
template <typename Row>
void check_places(std::vector<Row>& rows, std::size_t Row::*place, std::size_t count,
                  const fs::path& file, FolderReader& reader) {
  if (std::ranges::all_of(rows, [&](const Row& row) { return row.*place < count; })) return;
  rows.clear();
  reader.attempt([&] {
    throw meshes::InvalidInput({file.string(), "", "names a row that is not there",
                                "the file is damaged: run again what writes it"});
  });
}

/// The order of the story: as printed, as fitted, as it should be; then whatever else was run.
std::vector<std::string> ordered_models(const meshes::Entries<ModelEntry>& models) {
  std::vector<std::string> names{"published", "central", "hookean"};
  std::erase_if(names, [&](const std::string& name) { return !models.find(name); });
  for (const auto& [name, entry] : models) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

}  // namespace

double largest_magnitude(const std::vector<double>& values) {
  double result = meshes::unknown;
  for (const double value : values) result = std::fmax(result, std::abs(value));
  return result;
}

std::string trouble(const std::string& status) {
  return status == "finished" || status == "ok" ? "" : status;
}

Series force_curve(const std::string& label, const std::string& key, const Style& style,
                   std::span<const meshes::PressSample> samples) {
  using meshes::PressSample;
  return curve(label, key, style, samples, in(shown_units().length, &PressSample::indentation),
               in(shown_units().force, &PressSample::normal_force));
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

PressFiles read_press_files(const fs::path& folder, FolderReader& reader) {
  reader.note_missing(folder);
  PressFiles press{
      .summary = reader.take<PressSummary>(reader.json(folder / "summary.json")),
      .trace = reader.rows<lattice::TraceRow>(folder / "trace.csv"),
      .boundary = reader.rows<BoundaryRow>(folder / "boundary.csv"),
      .boundary_springs = reader.rows<BoundarySpringRow>(folder / "boundary_springs.csv"),
      .snapshots = reader.rows<SnapshotRow>(folder / "snapshots.csv"),
      .snapshot_points = reader.rows<SnapshotPointRow>(folder / "snapshot_points.csv")};
  if (!press.boundary.empty())
    for (const auto place : {&BoundarySpringRow::i, &BoundarySpringRow::j})
      check_places(press.boundary_springs, place, press.boundary.size(),
                   folder / "boundary_springs.csv", reader);
  if (!press.snapshots.empty())
    check_places(press.snapshot_points, &SnapshotPointRow::snapshot, press.snapshots.size(),
                 folder / "snapshot_points.csv", reader);
  return press;
}

namespace {

/// The summary of a case; of another verb only the status.
void take_summary(RunData& run, FolderReader& reader) {
  const JsonEntry file = reader.json(run.folder / "summary.json");
  if (file.empty()) return;
  run.status = reader.attempt([&] { return text_at(file, "status"); });
  if (run.verb != "validate" ||
      (run.manifest.empty() && !file.contains("case") && !file.contains("criteria")))
    return;
  run.summary = reader.take<CaseSummary>(file);
  reader.attempt([&] {
    // A case may have nothing but series and tables of its own; what it had must not get lost.
    if (run.summary.has_results()) return;
    std::set<std::string_view> known;
    meshes::for_each_field<CaseSummary>([&](const auto& field) { known.insert(field.name); });
    for (const auto& [key, entry] : file.members())
      if (!known.contains(key)) entry.refuse("is no entry of a case");
  });
  run.depths = run.summary.depths;
  run.study = run.summary.variants.value_or(StudyEntry());
}

/// The lattice that a fit to moduli found.
ModelData fitted_model(const RunData& run, FolderReader& reader) {
  const auto summary = reader.take<ModuliSummary>(reader.json(run.folder / "summary.json"));
  ModelData model;
  model.name = run.moduli_fit.model;
  model.status = "ok";
  model.calibration = run.moduli_fit;
  model.moduli = summary.moduli;
  return model;
}

/// The rubber, wherever a file tells it first.
TargetEntry find_target(const RunData& run) {
  TargetEntry target;
  if (const auto& told = run.summary.target)
    target = target_of(told->youngs_modulus, told->shear_modulus);
  for (const ModelData& model : run.models) {
    if (std::isfinite(target.bulk_modulus)) break;
    const calibration::RubberEntry& rubber = model.calibration.target;
    target = target_of(rubber.youngs_modulus, rubber.shear_modulus);
  }
  return target;
}

/// calibration.json at the top, of a fit to moduli or to curves; whether there is one.
bool take_calibration(RunData& run, FolderReader& reader) {
  const JsonEntry file = reader.json(run.folder / "calibration.json");
  if (file.empty()) return false;
  reader.attempt([&] {
    if (!file.contains("constants") && !file.contains("problem"))
      throw meshes::InvalidInput({(run.folder / "calibration.json").string(), "",
                                  "tells neither what was fitted (problem) nor constants",
                                  "calibrate again"});
  });
  run.fitted_curves = file.contains("problem");
  if (file.contains("constants") && !run.fitted_curves)
    run.moduli_fit = reader.take<calibration::ModuliFile>(file);
  return true;
}

}  // namespace

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
  const bool fitted = take_calibration(run, reader);
  run.manifest = reader.take<Manifest>(reader.json(folder / "manifest.json"));
  run.verb = run.manifest.verb;
  if (run.verb.empty()) run.verb = fitted ? "calibrate" : "validate";
  take_summary(run, reader);
  run.parameters = reader.text(folder / "parameters.toml");
  run.response = reader.response(folder / "response.csv");
  run.modes = reader.attempt([&] { return vibration_modes(reader.csv(folder / "modes.csv")); });
  const fs::path continuum = is_continuum(folder) ? folder : folder / "reference";
  if (continuum != folder) {
    reader.note_missing(continuum);
    run.contact = reader.rows<meshes::ContactPoint>(folder / "contact_field.csv");
    run.markers = reader.rows<meshes::MarkerRow>(folder / "markers.csv");
  }
  run.taxels = reader.rows<meshes::TaxelRow>(folder / "taxels.csv");
  run.continuum = reader.take<fem_reference::RunSummary>(reader.json(continuum / "summary.json"));
  run.reference = reader.response(continuum / "response.csv");
  run.reference_job = reader.json(continuum / "job.json");
  run.verification = reader.take<fem_reference::VerificationFile>(
      reader.json(folder / "verification" / "verification.json"));
  run.convergence = reader.rows<fem_reference::ConvergenceRow>(continuum / "convergence.csv");
  run.section = reader.rows<fem_reference::SectionRow>(continuum / "section.csv");
  run.reference_contact = reader.rows<meshes::ContactPoint>(continuum / "contact_field.csv");
  run.beside = reader.response(folder / "continuum" / "response.csv");
  run.reference_markers = reader.rows<meshes::MarkerRow>(
      (run.beside.empty() ? continuum : folder / "continuum") / "markers.csv");
  run.cubes = reader.rows<CubeRow>(folder / "cubes.csv");
  run.published_study = reader.rows<PublishedStudyRow>(folder / "published_study.csv");
  run.equilibrium_study = reader.rows<EquilibriumStudyRow>(folder / "equilibrium_study.csv");
  run.variants = reader.rows<VariantRow>(folder / "variants.csv");
  run.later = reader.rows<LaterRow>(folder / "later.csv");
  for (const DrawnEntry& entry : run.study.drawn) {
    const fs::path own = folder / entry.folder, other = folder / entry.continuum;
    run.drawn.push_back({entry.name, reader.response(own / "response.csv"),
                         reader.response(other / "response.csv"),
                         reader.rows<meshes::ContactPoint>(own / "contact_field.csv"),
                         reader.rows<meshes::ContactPoint>(other / "contact_field.csv"),
                         reader.rows<meshes::TaxelRow>(own / "taxels.csv"),
                         reader.rows<meshes::TaxelRow>(other / "taxels.csv"),
                         reader.rows<meshes::MarkerRow>(own / "markers.csv"),
                         reader.rows<meshes::MarkerRow>(other / "markers.csv")});
  }
  const auto& models = run.summary.models;
  for (const std::string& name : ordered_models(models)) {
    run.models.push_back(
        reader.attempt([&] { return read_model(folder, name, *models.find(name), reader); }));
    run.models.back().name = name;
    run.models.back().force_error.resize(run.depths.size(), meshes::unknown);
  }
  if (!run.moduli_fit.empty())
    run.models.push_back(reader.attempt([&] { return fitted_model(run, reader); }));
  run.target = find_target(run);
  if (run.depths.empty() && is_continuum(folder))
    for (const meshes::PressSample& sample : run.reference.pressing())
      run.depths.push_back(sample.indentation);
  return run;
}

}  // namespace fingertip::studies::report::inline results
