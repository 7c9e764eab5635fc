/// Virtual control: presses in time under their controllers, some beside the transient continuum,
/// some beside one another.
#include <algorithm>
#include <cmath>
#include <set>

#include "studies/cases/control_measures.h"
#include "studies/cases/folders.h"
#include "studies/cases/force_errors.h"
#include "studies/cases/plan.h"
#include "studies/files/case_summary.h"
#include "studies/files/json_fields.h"
#include "studies/report/run_data.h"
#include "studies/run/jobs.h"
#include "studies/run/json_file.h"
#include "studies/run/press_setup.h"

namespace fingertip::studies {

namespace {

using meshes::PressResponse;
using nlohmann::ordered_json;
using reporting::force_at;
namespace fs = std::filesystem;

struct Press {
  lattice::PressSetup setup;
  std::string folder;
  std::string continuum;  ///< folder; empty without one
};

/// The continuum pressed as `loaded` says, in time.
fem_reference::ReferenceJob continuum_at_speed(LoadedConfig loaded) {
  fem_reference::ReferenceJob& order = loaded.config.reference;
  order.analysis = fem_reference::Analysis::transient;
  order.strain = fem_reference::Strain::linear;
  order.write_fields = false;
  return continuum_job(loaded);
}

class ControlPlan : public Plan {
 public:
  explicit ControlPlan(const Case& one) : case_(one) {}

  std::vector<PlannedJob> jobs() override;
  ordered_json conclude(const fs::path& folder, const std::vector<JobResult>& results) override;
  std::map<std::string, double> measures(const fs::path& folder,
                                         const ordered_json& summary) const override;

 private:
  void add(const CasePress& press);
  RunMeasures measure(std::size_t place, const fs::path& folder) const;
  double change(std::size_t place, const fs::path& folder) const;
  double force_error(std::size_t place, const fs::path& folder) const;

  const Case& case_;
  std::vector<Press> presses_;  ///< in the order of the case's
  std::vector<PlannedJob> jobs_, continua_;
  std::map<std::string, std::string> folder_of_key_;
  std::set<std::string> folders_;
  std::vector<RunMeasures> measures_;
  std::size_t not_converged_ = 0;
  double reference_error_ = std::nan("");
};

void ControlPlan::add(const CasePress& press) {
  Press ready;
  try {
    const LoadedConfig loaded = case_.loaded.with(press.sets);
    ready.setup = press_setup(loaded);
    if (ready.setup.protocol.mode == meshes::DriveMode::equilibrium)
      throw ConfigError({{"", "press.mode", "static", "a press under a controller takes time",
                          "choose pid, or a case with variants"}});
    if (press.continuum) {
      const Job job = reference_job(continuum_at_speed(loaded));
      std::string& folder = folder_of_key_[job.key()];
      if (folder.empty()) {
        folder = "continuum/" + std::to_string(continua_.size() + 1);
        continua_.push_back({folder, job, false});
      }
      ready.continuum = folder;
    }
  } catch (const ConfigError& error) {
    throw at_variant(error, press);
  }
  const Job job = press_job(ready.setup);
  std::string& folder = folder_of_key_[job.key()];
  if (folder.empty()) {
    const std::string series = press.series.empty() ? "" : as_folder(press.series) + "/";
    folder = "presses/" + series + as_folder(press.name);
    while (!folders_.insert(folder).second) folder += "_";
    PlannedJob planned{folder, job, true};
    // Slower approaches take more steps.
    planned.job.weight *= 0.01 / ready.setup.protocol.speed;
    jobs_.push_back(std::move(planned));
  }
  ready.folder = folder;
  presses_.push_back(std::move(ready));
}

std::vector<PlannedJob> ControlPlan::jobs() {
  std::vector<Problem> problems;
  for (const CasePress& press : case_.presses) {
    try {
      add(press);
    } catch (const ConfigError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw ConfigError(problems);
  // The longest first, so that the lanes end together.
  std::ranges::stable_sort(jobs_, std::greater(),
                           [](const PlannedJob& one) { return one.job.weight; });
  std::vector<PlannedJob> all = continua_;
  all.insert(all.end(), jobs_.begin(), jobs_.end());
  return all;
}

/// Largest magnitude of the relative difference at `depths`; NaN when one of them is missing.
double largest_difference(const PressResponse& response, const PressResponse& other,
                          const std::vector<double>& depths) {
  double most = 0.0;
  for (const double depth : depths) {
    const double off = std::abs(force_at(response, depth) / force_at(other, depth) - 1.0);
    if (std::isnan(off)) return off;
    most = std::max(most, off);
  }
  return most;
}

double ControlPlan::force_error(std::size_t place, const fs::path& folder) const {
  const Press& press = presses_[place];
  if (press.continuum.empty()) return std::nan("");
  return largest_difference(response_in(folder / press.folder),
                            response_in(folder / press.continuum), press.setup.protocol.samples);
}

double ControlPlan::change(std::size_t place, const fs::path& folder) const {
  const std::string& beside = case_.presses[place].beside;
  if (beside.empty()) return std::nan("");
  const auto other = std::ranges::find(case_.presses, beside, full_name);
  const Press& wanted = presses_[std::size_t(other - case_.presses.begin())];
  return largest_difference(response_in(folder / presses_[place].folder),
                            response_in(folder / wanted.folder), wanted.setup.protocol.samples);
}

RunMeasures ControlPlan::measure(std::size_t place, const fs::path& folder) const {
  RunMeasures measures = tracking_measures(folder / presses_[place].folder);
  measures["force_error"] = force_error(place, folder);
  measures["change"] = change(place, folder);
  std::erase_if(measures, [](const auto& entry) { return std::isnan(entry.second); });
  return measures;
}

ordered_json ControlPlan::conclude(const fs::path& folder, const std::vector<JobResult>& results) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < presses_.size(); ++i) {
    const CasePress& press = case_.presses[i];
    const auto job = std::ranges::find(results, presses_[i].folder, &JobResult::name);
    if (!job->ok()) ++not_converged_;
    // What an incomplete press did so far must not pass for what it did.
    measures_.push_back(job->ok() ? measure(i, folder) : RunMeasures());
    ordered_json entry = meshes::json_of(PressEntry{press.series, press.name, presses_[i].folder,
                                                    presses_[i].continuum, press.beside,
                                                    press.snapshots, job->status});
    for (const auto& [name, value] : measures_.back()) entry[name] = value;
    list.push_back(std::move(entry));
  }
  for (const PlannedJob& continuum : continua_) {
    const PressResponse response = response_in(folder / continuum.name);
    for (const meshes::PressSample& sample : response.samples())
      reference_error_ =
          std::fmax(reference_error_, estimated_force_error(response, sample.indentation));
  }
  return {{"presses", list}};
}

std::map<std::string, double> ControlPlan::measures(const fs::path&, const ordered_json&) const {
  return take_control_measures(case_, measures_, not_converged_, reference_error_);
}

}  // namespace

std::unique_ptr<Plan> control_plan(const Case& one) {
  return std::make_unique<ControlPlan>(one);
}

}  // namespace fingertip::studies
