/// A study of calibrations: each fit, then presses with what it found, beside the continuum.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "meshes/table_rows.h"
#include "studies/cases/fit_measures.h"
#include "studies/cases/folders.h"
#include "studies/cases/force_errors.h"
#include "studies/cases/plan.h"
#include "studies/files/case_summary.h"
#include "studies/files/run_tables.h"
#include "studies/report/run_data.h"
#include "studies/run/fit_plan.h"
#include "studies/run/fit_setup.h"
#include "studies/run/jobs.h"
#include "studies/run/json_file.h"
#include "studies/run/press_setup.h"

namespace fingertip::studies {

namespace {

using meshes::PressResponse;
using nlohmann::ordered_json;
using reporting::force_at;
namespace fs = std::filesystem;

struct Fit {
  std::string folder;
  FitPlan plan;
  bool done = false;
};

/// One fit's press under one prediction.
struct Transfer {
  std::size_t fit = 0, prediction = 0;
  std::string folder, continuum;
  lattice::PressSetup setup;  ///< complete once the fit is done
};

class CalibrationPlan : public Plan {
 public:
  explicit CalibrationPlan(const Case& one) : case_(one) {}

  std::vector<PlannedJob> jobs() override;
  std::vector<PlannedJob> further_jobs(const fs::path& folder) override;
  ordered_json conclude(const fs::path& folder, const std::vector<JobResult>& results) override;
  std::map<std::string, double> measures(const fs::path& folder,
                                         const ordered_json& summary) const override;

 private:
  /// The case with the fit's settings, then the prediction's.
  LoadedConfig combined(const CaseVariant& fit, const CaseVariant& prediction) const;
  void plan_transfer(std::size_t fit, std::size_t prediction, std::vector<PlannedJob>& jobs);
  std::vector<PlannedJob> presses(const fs::path& folder);
  std::vector<TransferRow> rows_of(const Transfer& transfer, const fs::path& folder,
                                   const std::string& status);

  const Case& case_;
  std::vector<Fit> fits_;
  std::vector<Transfer> transfers_;
  std::vector<std::pair<std::string, std::string>> continua_;  ///< key and folder
  bool pressed_ = false;
  TransferErrors errors_;
  std::vector<ordered_json> calibrations_;
};

LoadedConfig CalibrationPlan::combined(const CaseVariant& fit,
                                       const CaseVariant& prediction) const {
  CaseVariant both = prediction;
  both.sets.insert(both.sets.begin(), fit.sets.begin(), fit.sets.end());
  both.name = fit.name + " predicts " + prediction.name;
  return variant_config(case_, both);
}

void CalibrationPlan::plan_transfer(std::size_t fit, std::size_t prediction,
                                    std::vector<PlannedJob>& jobs) {
  const LoadedConfig own = combined(case_.fits[fit], case_.predictions[prediction]);
  const Job job = reference_job(continuum_beside(own, own.config.press.lattice.kinematics));
  auto known = std::ranges::find(continua_, job.key(), &std::pair<std::string, std::string>::first);
  if (known == continua_.end()) {
    continua_.emplace_back(job.key(), fmt::format("continuum/{}", continua_.size() + 1));
    known = continua_.end() - 1;
    jobs.push_back({known->second, job, false});
  }
  Transfer transfer;
  transfer.fit = fit;
  transfer.prediction = prediction;
  transfer.continuum = known->second;
  transfer.folder =
      fits_[fit].folder + "/predicts/" + as_folder(case_.predictions[prediction].name);
  transfers_.push_back(std::move(transfer));
}

std::vector<PlannedJob> CalibrationPlan::jobs() {
  std::vector<PlannedJob> jobs;
  for (std::size_t f = 0; f < case_.fits.size(); ++f) {
    const CaseVariant& fit = case_.fits[f];
    const std::string folder = "fits/" + as_folder(fit.name);
    try {
      // Criteria judge what comes of a fit, also of one that failed its own tests.
      fits_.push_back({folder, FitPlan(variant_config(case_, fit), folder, FitPlan::Failed::kept)});
    } catch (const ConfigError& error) {
      throw at_variant(error, fit);
    }
    for (std::size_t p = 0; p < case_.predictions.size(); ++p)
      if (is_asked(case_.predictions[p], fit)) plan_transfer(f, p, jobs);
    for (PlannedJob& job : fits_.back().plan.next({})) jobs.push_back(std::move(job));
  }
  return jobs;
}

/// Fits stage by stage, all side by side; when none has anything left, the presses.
std::vector<PlannedJob> CalibrationPlan::further_jobs(const fs::path& folder) {
  std::vector<PlannedJob> jobs;
  for (Fit& fit : fits_) {
    if (fit.done) continue;
    const std::vector<PlannedJob> more = fit.plan.next(folder);
    fit.done = more.empty();
    jobs.insert(jobs.end(), more.begin(), more.end());
  }
  if (!jobs.empty() || pressed_) return jobs;
  pressed_ = true;
  return presses(folder);
}

std::vector<PlannedJob> CalibrationPlan::presses(const fs::path& folder) {
  std::vector<PlannedJob> jobs;
  for (Transfer& transfer : transfers_) {
    const LoadedConfig own =
        combined(case_.fits[transfer.fit], case_.predictions[transfer.prediction]);
    const fs::path material = fs::absolute(folder / fits_[transfer.fit].folder / "material.toml");
    transfer.setup = press_setup(own.with({"lattice.constants=" + material.string()}));
    jobs.push_back({transfer.folder, press_job(transfer.setup), true});
  }
  std::ranges::stable_sort(jobs, std::greater(),
                           [](const PlannedJob& one) { return one.job.weight; });
  return jobs;
}

std::vector<TransferRow> CalibrationPlan::rows_of(const Transfer& transfer, const fs::path& folder,
                                                  const std::string& status) {
  const PressResponse response = response_in(folder / transfer.folder);
  const PressResponse continuum = response_in(folder / transfer.continuum);
  double& worst = errors_[transfer.fit][transfer.prediction];
  worst = 0.0;
  std::vector<TransferRow> rows;
  for (const double depth : transfer.setup.protocol.samples) {
    const double force = force_at(response, depth), wanted = force_at(continuum, depth);
    const double error = force / wanted - 1.0;
    worst = std::isfinite(error) ? std::max(worst, std::abs(error)) : std::nan("");
    rows.push_back({case_.fits[transfer.fit].name, case_.predictions[transfer.prediction].name,
                    std::string(lattice::name(transfer.setup.lattice.model)), depth, force, wanted,
                    estimated_force_error(continuum, depth), error, status});
  }
  return rows;
}

ordered_json CalibrationPlan::conclude(const fs::path& folder,
                                       const std::vector<JobResult>& results) {
  errors_.assign(fits_.size(), std::vector<double>(case_.predictions.size(), std::nan("")));
  std::vector<TransferRow> rows;
  for (const Transfer& transfer : transfers_) {
    const auto job = std::ranges::find(results, transfer.folder, &JobResult::name);
    for (TransferRow& row : rows_of(transfer, folder, job->status)) rows.push_back(std::move(row));
  }
  if (!rows.empty()) meshes::write_rows(rows, folder / "transfer.csv");
  TransferEntry entry;
  for (std::size_t f = 0; f < fits_.size(); ++f) {
    calibrations_.push_back(read_json(folder / fits_[f].folder / "calibration.json"));
    const ordered_json& calibration = calibrations_.back();
    entry.fits.push_back({case_.fits[f].name, fits_[f].folder, calibration.value("model", ""),
                          calibration.value("problem", "moduli")});
  }
  entry.worst_error = errors_;
  for (const CaseVariant& prediction : case_.predictions)
    entry.predictions.push_back({prediction.name});
  const meshes::Rubber& rubber = case_.loaded.config.press.rubber;
  entry.truth.parameters = {{"youngs_modulus", rubber.youngs_modulus},
                            {"shear_modulus", rubber.shear_modulus},
                            {"lambda", rubber.lame_lambda()},
                            {"retardation_time", rubber.retardation_time}};
  return {{"calibration", meshes::json_of(entry)}};
}

std::map<std::string, double> CalibrationPlan::measures(const fs::path&,
                                                        const ordered_json&) const {
  return take_fit_measures(case_, errors_, calibrations_);
}

}  // namespace

std::unique_ptr<Plan> calibration_plan(const Case& one) {
  return std::make_unique<CalibrationPlan>(one);
}

}  // namespace fingertip::studies
