/// A study of calibrations: each fit, then presses with what it found, beside the continuum.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "meshes/files.h"
#include "studies/cases/fit_measures.h"
#include "studies/cases/folders.h"
#include "studies/cases/force_errors.h"
#include "studies/cases/plan.h"
#include "studies/report/figure.h"
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
using reporting::csv_cell;
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
  double later_weight() const override;
  ordered_json conclude(const fs::path& folder, const std::vector<JobResult>& results) override;
  std::map<std::string, double> measures(const fs::path& folder,
                                         const ordered_json& summary) const override;

 private:
  /// The case with the fit's settings, then the prediction's.
  LoadedConfig combined(const CaseVariant& fit, const CaseVariant& prediction) const;
  void plan_transfer(std::size_t fit, std::size_t prediction, std::vector<PlannedJob>& jobs);
  std::vector<PlannedJob> presses(const fs::path& folder);
  std::string rows_of(const Transfer& transfer, const fs::path& folder, const std::string& status);

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

double CalibrationPlan::later_weight() const {
  double weight = 0.0;
  for (const Fit& fit : fits_) weight += fit.plan.later_weight();
  if (pressed_) return weight;
  for (const Transfer& transfer : transfers_)
    weight += press_weight(
        combined(case_.fits[transfer.fit], case_.predictions[transfer.prediction]).config.press);
  return weight;
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

constexpr const char* table_head =
    "fit,prediction,model,indentation [m],normal_force [N],reference_force [N],reference_error,"
    "relative_error,status\n";

std::string CalibrationPlan::rows_of(const Transfer& transfer, const fs::path& folder,
                                     const std::string& status) {
  const PressResponse response = response_in(folder / transfer.folder);
  const PressResponse continuum = response_in(folder / transfer.continuum);
  double& worst = errors_[transfer.fit][transfer.prediction];
  worst = 0.0;
  std::string rows;
  for (const double depth : transfer.setup.protocol.samples) {
    const double force = force_at(response, depth), wanted = force_at(continuum, depth);
    const double error = force / wanted - 1.0;
    worst = std::isfinite(error) ? std::max(worst, std::abs(error)) : std::nan("");
    rows += csv_cell(case_.fits[transfer.fit].name) + "," +
            csv_cell(case_.predictions[transfer.prediction].name) + "," +
            std::string(lattice::name(transfer.setup.lattice.model));
    for (const double value :
         {depth, force, wanted, estimated_force_error(continuum, depth), error})
      rows += "," + meshes::to_text(value);
    rows += "," + csv_cell(status) + "\n";
  }
  return rows;
}

ordered_json CalibrationPlan::conclude(const fs::path& folder,
                                       const std::vector<JobResult>& results) {
  errors_.assign(fits_.size(), std::vector<double>(case_.predictions.size(), std::nan("")));
  std::string rows;
  for (const Transfer& transfer : transfers_) {
    const auto job = std::ranges::find(results, transfer.folder, &JobResult::name);
    rows += rows_of(transfer, folder, job->status);
  }
  if (!rows.empty())
    meshes::write_atomically(folder / "transfer.csv",
                             [&](std::ostream& out) { out << table_head << rows; });
  ordered_json fits = ordered_json::array(), predictions = ordered_json::array(),
               worst = ordered_json::array();
  for (std::size_t f = 0; f < fits_.size(); ++f) {
    calibrations_.push_back(read_json(folder / fits_[f].folder / "calibration.json"));
    const ordered_json& calibration = calibrations_.back();
    fits.push_back({{"name", case_.fits[f].name},
                    {"folder", fits_[f].folder},
                    {"model", calibration.value("model", "")},
                    {"problem", calibration.value("problem", "moduli")}});
    ordered_json row = ordered_json::array();
    for (const double error : errors_[f]) row.push_back(number_or_null(error));
    worst.push_back(row);
  }
  for (const CaseVariant& prediction : case_.predictions)
    predictions.push_back({{"name", prediction.name}});
  const meshes::Rubber& rubber = case_.loaded.config.press.rubber;
  return {{"calibration",
           {{"fits", fits},
            {"predictions", predictions},
            {"worst_error", worst},
            {"truth",
             {{"parameters",
               {{"youngs_modulus", rubber.youngs_modulus},
                {"shear_modulus", rubber.shear_modulus},
                {"lambda", rubber.lame_lambda()},
                {"retardation_time", rubber.retardation_time}}}}}}}};
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
