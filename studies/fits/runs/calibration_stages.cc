#include "studies/fits/runs/calibration_stages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/files/words.h"
#include "calibration/moduli/result_io.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/press/press_response.h"
#include "meshes/tables/fields_json.h"
#include "studies/files/json_entry.h"
#include "studies/files/read_fields.h"
#include "studies/fits/models/fit_relaxation.h"
#include "studies/fits/runs/displacement_job.h"
#include "studies/fits/runs/fit_corrections.h"
#include "studies/fits/runs/fit_job.h"
#include "studies/fits/runs/moduli_job.h"
#include "studies/fits/runs/surrogate_job.h"
#include "studies/fits/setup/configured_fit.h"
#include "studies/fits/setup/fit_setup.h"
#include "studies/jobs/cache.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline fits::inline runs {

namespace {

namespace fs = std::filesystem;
using calibration::FitFile;
using meshes::PressResponse;
using nlohmann::ordered_json;

/// Indentations at which a lattice is judged by its continuum; between them its relative error is
/// taken as linear.
constexpr std::size_t bias_samples = 8;

constexpr const char* other_contact_name = "fit_other_contact";
constexpr const char* displacements_name = "displacements";

/// Evenly chosen, the last one always.
std::vector<double> thinned(const std::vector<double>& x, std::size_t count) {
  if (x.size() <= count) return x;
  std::vector<double> chosen;
  for (std::size_t i = 1; i <= count; ++i) chosen.push_back(x[i * x.size() / count - 1]);
  return chosen;
}

/// A static run has exactly the samples it was asked for, a transient one has more.
const meshes::PressSample& sample_near(const PressResponse& response, double depth) {
  return *std::ranges::min_element(response.samples(), {}, [&](const meshes::PressSample& sample) {
    return std::abs(sample.indentation - depth);
  });
}

FitFile read_fit(const fs::path& folder) {
  const fs::path file = folder / "calibration.json";
  return struct_of<FitFile>(read_entry(file));
}

calibration::DisplacementFitFile read_ratio(const fs::path& folder) {
  return struct_of<calibration::DisplacementFitFile>(read_entry(folder / "displacements.json"));
}

/// Of displacements alone: one parameter, and no curves.
FitFile fit_of(const calibration::DisplacementFitFile& found) {
  FitFile fit;
  fit.problem = name(CalibrationProblem::experiment);
  fit.model = found.model;
  fit.forward = found.model == "continuum" ? "continuum" : "lattice";
  calibration::ParameterEntry& ratio = fit.parameters.emplace_back("poissons_ratio", "1");
  ratio.estimate = found.poissons_ratio;
  ratio.lower = found.lower;
  ratio.upper = found.upper;
  ratio.standard_error = (found.upper - found.lower) / (2.0 * calibration::normal_95());
  ratio.at_bound = found.at_bound;
  ratio.interval = "posterior";
  fit.covariance = {{std::pow(ratio.standard_error, 2)}};
  fit.correlation = {{1.0}};
  fit.converged = true;
  fit.failed = found.failed;
  fit.statement = found.statement;
  fit.displacements = found;
  return fit;
}

/// The fit of forces knows Poisson's ratio by them.
void add_displacements(const calibration::DisplacementFitFile& found, FitFile& fit) {
  fit.displacements = found;
  fit.statement = "Displacements: " + found.statement + " Forces, at that ratio: " + fit.statement;
  for (const std::string& reason : found.failed)
    fit.failed.push_back("of the displacements, " + reason);
}

void check_moduli(const LoadedConfig& loaded) {
  if (!loaded.config.calibration.data.empty())
    throw loaded.locate(
        {{"calibration.data", "", "the problem moduli fits to E and G of the rubber",
          "leave data out, or take the problem experiment"}});
  const lattice::ModelKind model = loaded.config.press.lattice.model;
  if (model == lattice::ModelKind::network)
    throw loaded.locate({{"lattice.model", "network",
                          "the network takes G and lambda from the rubber; nothing is left to fit "
                          "to moduli",
                          "calibrate central or hookean, or fit it to a curve: "
                          "calibration.problem = \"curve\""}});
  if (model == lattice::ModelKind::published)
    throw loaded.locate({{"lattice.model", "published",
                          "the published model has a rule for its constants and is not calibrated",
                          "calibrate central, hookean or network"}});
}

/// Forces are fitted, and no displacements.
LoadedConfig without_markers(LoadedConfig loaded) {
  return loaded.config.press.protocol.markers.empty() ? loaded
                                                      : with_sets(loaded, {"sensor.markers=none"});
}

}  // namespace

CalibrationStages::CalibrationStages(LoadedConfig loaded, std::string folder, Failed failed)
    : loaded_(without_markers(std::move(loaded))), folder_(std::move(folder)), failed_(failed) {
  if (by_moduli()) {
    check_moduli(loaded_);
    return;
  }
  SplitData split = split_data(loaded_);
  loaded_ = std::move(split.forces);
  displacements_ = std::move(split.displacements);
  has_forces_ = split.has_forces;
  if (has_forces_) set_up();
  notes_ = std::move(split.notes);
  notes_.insert(notes_.end(), setup_.notes.begin(), setup_.notes.end());
}

void CalibrationStages::set_up() {
  setup_ = fit_setup(loaded_, setup_.files);
  loaded_ = setup_.loaded;
  other_contact_ = with_other_contact(setup_);
}

std::string CalibrationStages::place(const std::string& name) const {
  return folder_.empty() || name.empty() ? folder_ + name : folder_ + "/" + name;
}

bool CalibrationStages::by_moduli() const {
  return loaded_.config.calibration.problem == CalibrationProblem::moduli;
}

std::vector<PlannedJob> CalibrationStages::next(const fs::path& run) {
  std::vector<PlannedJob> jobs;
  while (jobs.empty() && stage_ != Stage::done) {
    if (stage_ == Stage::displacements) jobs = displacement_jobs();
    if (stage_ == Stage::data) jobs = data_jobs();
    if (stage_ == Stage::fit) jobs = fits(run);
    if (stage_ == Stage::follow_up) jobs = follow_up_jobs(run);
    if (stage_ == Stage::finish) finish(run);
    stage_ = has_forces_ || stage_ >= Stage::finish ? Stage(int(stage_) + 1) : Stage::finish;
  }
  return jobs;
}

double CalibrationStages::later_weight() const {
  double weight = 0.0;
  if (stage_ == Stage::displacements && displacements_) weight += fit_weight;
  if (!has_forces_) return weight;
  if (stage_ <= Stage::fit)
    weight += by_moduli() ? moduli_weight : fit_weight * (other_contact_ ? 2.0 : 1.0);
  if (stage_ > Stage::follow_up) return weight;
  if (loaded_.config.calibration.surrogate) weight += surrogate_weight;
  if (measures_bias())
    for (const FitCurve& curve : setup_.input.curves)
      weight += reference_job(curve.continuum).weight;
  return weight;
}

std::vector<PlannedJob> CalibrationStages::displacement_jobs() {
  if (!displacements_) return {};
  return {{place(displacements_name), displacement_job(*displacements_)}};
}

/// Forces are fitted at the ratio that displacements tell, known as well as they tell it.
void CalibrationStages::take_ratio(const fs::path& run) {
  if (!displacements_) return;
  loaded_ = with_ratio(loaded_, read_ratio(run / place(displacements_name)));
  set_up();
}

std::vector<PlannedJob> CalibrationStages::data_jobs() {
  std::vector<PlannedJob> jobs;
  if (by_moduli()) return jobs;
  if (!setup_.data_from_continuum) return jobs;
  for (const FitCurve& curve : setup_.input.curves)
    jobs.push_back(
        {place("reference_" + std::to_string(jobs.size() + 1)), reference_job(curve.continuum)});
  return jobs;
}

/// Forces of the continuum become data; their deviation is its own error and what the model of a
/// curve may miss.
void CalibrationStages::take_continuum_data(const fs::path& run) {
  const double model_error = std::max(loaded_.config.calibration.model_error, 1e-6);
  for (std::size_t i = 0; i < setup_.input.curves.size(); ++i) {
    calibration::Curve& curve = setup_.input.curves[i];
    const PressResponse response =
        PressResponse::read_csv(run / place("reference_" + std::to_string(i + 1)) / "response.csv");
    for (const double depth : curve.x) {
      const meshes::PressSample sample = sample_near(response, depth);
      const double own = std::isfinite(sample.force_error) ? sample.force_error : 0.0;
      curve.y.push_back(sample.normal_force);
      curve.sigma.push_back(std::hypot(own, model_error * sample.normal_force));
    }
  }
}

std::vector<PlannedJob> CalibrationStages::fits(const fs::path& run) {
  if (by_moduli())
    return {{folder_,
             moduli_job(loaded_.config.press.rubber,
                        fit_options(loaded_, loaded_.config.press.lattice.model)),
             false}};
  take_ratio(run);
  if (setup_.data_from_continuum) take_continuum_data(run);
  // Of two contacts one may have no answer.
  const bool either = other_contact_.has_value();
  std::vector<PlannedJob> jobs = {{place(fit_name_), fit_job(setup_.input), either}};
  if (either) jobs.push_back({place(other_contact_name), fit_job(other_contact_->input), true});
  return jobs;
}

namespace {

/// How many times likelier the data are with a contact that they tell by themselves.
constexpr double far_likelier = 150.0;

bool fits_far_better(const FitFile& fit, const FitFile& than) {
  if (!fit.failed.empty() && than.failed.empty()) return false;
  return fit.errors && than.errors &&
         fit.errors->log_evidence > than.errors->log_evidence + std::log(far_likelier);
}

std::string contact_words(const std::string& taken, const std::string& why) {
  return fmt::format(" Whether the rubber sticks is not told (press.contact): {} is taken, {}.",
                     taken, why);
}

}  // namespace

/// Where the contact is not known: the one that is taken without word, or the other one where only
/// that has an answer, or meets the data far better.
void CalibrationStages::choose_contact(const fs::path& run) {
  if (!other_contact_) return;
  const auto status = [&](const FitSetup& fit, const std::string& name) {
    return marked_status(fit_job(fit.input), run / place(name));
  };
  const std::string own = status(setup_, fit_name_),
                    other = status(*other_contact_, other_contact_name);
  const std::string name = contact_name(setup_), rival = contact_name(*other_contact_);
  std::string why;
  if (own == finished && other == finished) {
    const FitFile taken = read_fit(run / place(fit_name_)),
                  better = read_fit(run / place(other_contact_name));
    const bool told = fits_far_better(taken, better);
    if (!told && !fits_far_better(better, taken)) return;
    const double times = std::abs(better.errors->log_evidence - taken.errors->log_evidence);
    why = fmt::format(
        "with which the data are {} times likelier",
        times > std::log(1e6) ? "over a million" : fmt::format("{:.2g}", std::exp(times)));
    if (told) {
      other_contact_.reset();
      contact_note_ = contact_words(name, why);
      return;
    }
  } else if (own == finished) {
    return;
  } else if (other == finished) {
    why = fmt::format("since {} contact has no answer ({})", name,
                      own.substr(0, own.find('\n')).substr(own.find(": ") + 2));
  } else {
    throw meshes::NotConverged(
        fmt::format("press.contact is not told; {}: {}; {}: {}", name, own, rival, other));
  }
  setup_ = *std::move(other_contact_);
  other_contact_.reset();
  loaded_ = setup_.loaded;
  fit_name_ = other_contact_name;
  contact_note_ = contact_words(rival, why);
}

/// Of a lattice that answered for measured forces: the continuum at the estimates tells its error.
bool CalibrationStages::measures_bias() const {
  return loaded_.config.calibration.problem == CalibrationProblem::experiment &&
         loaded_.config.calibration.bias && !by_continuum(setup_.input) &&
         setup_.input.branches.empty() &&
         std::ranges::all_of(parameters_of(setup_.input), calibration::is_of_the_rubber);
}

PlannedJob CalibrationStages::bias(const fs::path& run, std::size_t curve) const {
  fem_reference::ReferenceJob reference = setup_.input.curves[curve].continuum;
  const calibration::Material found = material(run);
  reference.rubber.youngs_modulus = found.rubber.youngs_modulus;
  reference.rubber.shear_modulus = found.rubber.shear_modulus;
  reference.press_to(thinned(reference.protocol.samples, bias_samples));
  return {place("bias_" + std::to_string(curve + 1)), reference_job(reference), false};
}

std::vector<PlannedJob> CalibrationStages::follow_up_jobs(const fs::path& run) {
  choose_contact(run);
  std::vector<PlannedJob> jobs;
  if (!usable(run)) return jobs;
  if (loaded_.config.calibration.surrogate) jobs.push_back(surrogate(run));
  if (measures_bias())
    for (std::size_t i = 0; i < setup_.input.curves.size(); ++i) jobs.push_back(bias(run, i));
  return jobs;
}

/// The press of the configuration with what was found.
PlannedJob CalibrationStages::surrogate(const fs::path& run) const {
  const calibration::Material found = material(run);
  lattice::PressSetup setup =
      press_setup(with_sets(in_equilibrium(loaded_), {"press.mode=static"}));
  setup.rubber = found.rubber;
  setup.rubber.relaxation = {};  // its forces are those after long times
  setup.lattice.constants = found.constants;
  setup.lattice.ligament_stiffness = found.ligament_stiffness;
  setup.lattice.contact_stiffness = found.contact_stiffness;
  ForceUncertainty uncertainty;
  uncertainty.model_error = loaded_.config.calibration.model_error;
  const bool by_press = !by_moduli() && has_presses(setup_.input) &&
                        setup_.input.problem != CalibrationProblem::damping;
  if (by_press) {
    const FitFile fit = read_fit(run / place(fit_name_));
    uncertainty.parameters = parameters_of(setup_.input);
    const auto count = Eigen::Index(uncertainty.parameters.size());
    uncertainty.covariance.resize(count, count);
    for (Eigen::Index i = 0; i < count; ++i)
      uncertainty.covariance.row(i) =
          Eigen::RowVectorXd::Map(fit.covariance[std::size_t(i)].data(), count);
    uncertainty.covariance *= std::pow(fit.birge_ratio, 2);  // as wide as the intervals
  }
  return {place("surrogate"), surrogate_job(setup, uncertainty), false};
}

calibration::Material CalibrationStages::material(const fs::path& run) const {
  return calibration::read_material_toml(by_moduli() ? run / folder_ / "material.toml"
                                                     : run / place(fit_name_) / estimates_name);
}

bool CalibrationStages::usable(const fs::path& run) const {
  if (by_moduli()) return true;
  const fs::path estimates = run / place(fit_name_) / estimates_name;
  return fs::exists(estimates) &&
         (failed_ == Failed::kept || calibration::read_material_toml(estimates).rejected.empty());
}

void CalibrationStages::add_biases(FitFile& fit, const fs::path& run) const {
  std::vector<Eigen::VectorXd> errors;
  for (std::size_t i = 0; i < setup_.input.curves.size(); ++i) {
    const fs::path folder = run / place("bias_" + std::to_string(i + 1));
    errors.push_back(lattice_error(setup_.input.curves[i], fit.residuals[i],
                                   PressResponse::read_csv(folder / "response.csv")));
  }
  add_bias(calibration::stacked(errors), fit);
}

/// The fit to moduli knows neither the finger nor what of the rubber is only a default.
void CalibrationStages::complete_moduli(const fs::path& file) const {
  calibration::Material found = calibration::read_material_toml(file);
  if (loaded_.config.press.geometry.is_dome()) found.geometry = loaded_.config.press.geometry;
  found.density_known = loaded_.entries.at("rubber.density").given;
  found.retardation_time_known = loaded_.entries.at("rubber.retardation_time").given;
  calibration::write_material_toml(found, file);
}

/// A card that failed after its fit: written as asked, with the reason, or not at all.
void CalibrationStages::keep_rejected(const FitFile& fit, const fs::path& card) const {
  if (failed_ != Failed::kept) {
    fs::remove(card);
    return;
  }
  calibration::Material found = calibration::read_material_toml(card);
  found.rejected = calibration::in_one(fit.failed);
  calibration::write_material_toml(found, card);
}

void CalibrationStages::finish_displacements(const fs::path& run) const {
  const fs::path target = run / folder_, from = run / place(displacements_name);
  for (const char* const file : {"displacements.json", "displacements.csv", "distances.json"})
    fs::copy_file(from / file, target / file, fs::copy_options::overwrite_existing);
  if (has_forces_) return;
  const FitFile fit = fit_of(read_ratio(from));
  meshes::write_json_file({{"problem", fit.problem},
                           {"model", fit.model},
                           {"status", "finished"},
                           {"failed", fit.failed},
                           {"statement", fit.statement}},
                          target / "summary.json");
  meshes::write_json_file(fit, target / "calibration.json");
}

void CalibrationStages::finish(const fs::path& run) const {
  const fs::path target = run / folder_;
  if (displacements_) finish_displacements(run);
  if (!has_forces_) return;
  const auto copy = [&](const std::string& from, const char* file, const char* as) {
    fs::copy_file(run / place(from) / file, target / as, fs::copy_options::overwrite_existing);
  };
  const bool use = usable(run);
  if (by_moduli()) {
    complete_moduli(target / "material.toml");
  } else {
    copy(fit_name_, "fit_data.csv", "fit_data.csv");
    if (use)
      copy(fit_name_, estimates_name, "material.toml");
    else
      fs::remove(target / "material.toml");  // of an earlier attempt
    FitFile fit = read_fit(run / place(fit_name_));
    if (use && measures_bias()) add_biases(fit, run);
    const fs::path other = run / place(other_contact_name);
    if (other_contact_ && fs::exists(other / "calibration.json"))
      add_other_contact(read_fit(other), contact_name(setup_), contact_name(*other_contact_), fit);
    fit.statement += contact_note_;
    refuse_what_is_open(fit);
    if (displacements_) add_displacements(read_ratio(run / place(displacements_name)), fit);
    if (!fit.failed.empty() && use) keep_rejected(fit, target / "material.toml");
    ordered_json summary = parse_json(run / place(fit_name_) / "summary.json");
    summary["statement"] = fit.statement;
    summary["failed"] = fit.failed;
    meshes::write_json_file(summary, target / "summary.json");
    meshes::write_json_file(fit, target / "calibration.json");
  }
  if (use && loaded_.config.calibration.surrogate)
    for (const char* file : {"surrogate.csv", "surrogate.json"}) copy("surrogate", file, file);
}

}  // namespace fingertip::studies::inline fits::inline runs
