#include "studies/fits/runs/plan_job.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <functional>

#include "calibration/files/words.h"
#include "calibration/material/file_parts.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/plan_file.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/measurement_gains.h"
#include "studies/fits/runs/fit_job.h"

namespace fingertip::studies::inline fits::inline runs {

using calibration::CollinearPair;
using calibration::FreeParameter;
using calibration::rounded;
using Eigen::Index;
using Eigen::VectorXd;
using nlohmann::ordered_json;
namespace fs = std::filesystem;

namespace {

/// A value as it is expected to be measured.
struct PlannedRow {
  std::string press;
  double x = meshes::unknown, force = meshes::unknown, sigma = meshes::unknown;
};
FINGERTIP_FIELDS(PlannedRow, press, x, force, sigma);

void write_rows_of(const FitInput& input, const fs::path& file) {
  std::vector<PlannedRow> rows;
  for (const FitCurve& curve : input.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      rows.push_back({curve.name, curve.x[i], curve.y[i], curve.sigma[i]});
  meshes::write_rows(rows, file);
}

std::string interval_words(const PlannedParameter& parameter) {
  const double width = parameter.upper - parameter.value;
  const std::string unit = parameter.unit == "1" ? "" : " " + parameter.unit;
  std::string text = parameter.name + " = " + rounded(parameter.value, 4) + unit + " +- " +
                     rounded(width, 3) + unit;
  if (parameter.value != 0.0)
    text += " (" + calibration::percent(width / std::abs(parameter.value)) + ")";
  return text;
}

std::string statement_of(const PlanFile& plan, const std::vector<std::string>& labels,
                         const MeasurementGains& found, std::size_t decisive) {
  std::string text =
      "Forces that err by " + calibration::percent(plan.noise) +
      (plan.noise_force > 0.0 ? " and " + rounded(plan.noise_force, 3) + " N" : std::string()) +
      " would tell, with 95 % confidence:";
  for (std::size_t i = 0; i < plan.parameters.size(); ++i)
    text += (i == 0 ? " " : "; ") + interval_words(plan.parameters[i]);
  text += ".";
  for (const CollinearEntry& pair : plan.collinear)
    text += " " + pair.first + " and " + pair.second + " are nearly collinear (correlation " +
            rounded(pair.correlation, 3) +
            "): were one known, the interval of the other would "
            "be " +
            rounded(pair.times, 2) + " times narrower.";
  const std::string next = calibration::gain_statement(found.gains, labels, decisive);
  return next.empty() ? text : text + " " + next;
}

PlanFile file_of(const FitInput& input, const PlannedNoise& noise, const VectorXd& at,
                 const MeasurementGains& found) {
  PlanFile plan;
  plan.problem = name(input.problem);
  plan.forward = by_continuum(input) ? "continuum" : "lattice";
  plan.noise = noise.relative;
  plan.noise_force = noise.absolute;
  plan.rubber = calibration::rubber_entry(input.base.rubber);
  for (const FitCurve& curve : input.curves)
    plan.presses.push_back({curve.name, curve.condition, curve.x.size(),
                            depths_of_values(curve, at).back(), curve.y.back()});
  std::vector<std::string> labels;
  // 95 %, as a fit to such data would have it.
  const VectorXd error = found.covariance.diagonal().cwiseSqrt(),
                 width = calibration::normal_95() * error, inverse = error.cwiseInverse();
  const VectorXd lower = at - width, upper = at + width;
  const Eigen::MatrixXd correlation =
      inverse.asDiagonal() * found.covariance * inverse.asDiagonal();
  for (Index i = 0; i < at.size(); ++i) {
    const FreeParameter& free = input.options.free[std::size_t(i)];
    labels.push_back(calibration::label(free));
    auto& parameter = plan.parameters.emplace_back(
        PlannedParameter{labels.back(),
                         std::string(calibration::unit(free.parameter)),
                         at(i),
                         error(i),
                         lower(i),
                         upper(i),
                         {}});
    if (free.prior) parameter.prior = {free.prior->mean, free.prior->deviation};
    const VectorXd row = correlation.row(i).transpose();
    plan.correlation.emplace_back(row.begin(), row.end());
  }
  for (const CollinearPair& pair : calibration::nearly_collinear(found.covariance))
    plan.collinear.push_back(
        {labels[pair.first], labels[pair.second], pair.correlation, pair.times});
  plan.next = calibration::next_entries(found.gains, labels, at, lower, upper);
  plan.statement = statement_of(plan, labels, found, material_parameters(input));
  return plan;
}

void run_plan(FitInput input, const PlannedNoise& noise, const fs::path& folder,
              const JobContext& context) {
  const auto begin = std::chrono::steady_clock::now();
  std::string stage = "presses";
  double share = 0.0;
  const auto go_on = [&] { return context.report(share, stage); };
  const FitModels models(input, folder, context, go_on);
  const VectorXd at = start_of(input.options);
  const Noise stated(noise.relative, noise.absolute);
  for (std::size_t i = 0; i < input.curves.size(); ++i)
    static_cast<calibration::Curve&>(input.curves[i]) =
        as_if_measured(input, models, i, at, stated);
  const MeasurementGains found = measurement_gains(
      input, models, at, 0.0, 0.0, 0.0, folder, context, [&](double done, const std::string& name) {
        share = 0.5 + 0.5 * done;
        stage = "further measurement, " + name;
        return go_on();
      });
  PlanFile plan = file_of(input, noise, at, found);
  plan.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  meshes::write_json_file(plan, folder / plan_name);
  write_rows_of(input, folder / "planned_presses.csv");
  meshes::write_json_file({{"problem", plan.problem},
                           {"status", "finished"},
                           {"wall_time", plan.wall_time},
                           {"statement", plan.statement}},
                          folder / "summary.json");
  context.log(plan.statement);
}

}  // namespace

Job plan_job(const FitInput& input, const PlannedNoise& noise) {
  if (!(noise.relative > 0.0 || noise.absolute > 0.0))
    throw meshes::InvalidInput({"calibration.noise", "0", "a plan needs the noise of the forces",
                                "give calibration.noise or calibration.noise_force"});
  Job job = fit_job(input);
  job.kind = "plan";
  job.inputs["noise"] = {noise.relative, noise.absolute};
  job.run = std::bind_front(run_plan, input, noise);
  return job;
}

}  // namespace fingertip::studies::inline fits::inline runs
