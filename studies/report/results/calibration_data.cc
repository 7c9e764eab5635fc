#include "studies/report/results/calibration_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "calibration/statistics/curve_checks.h"
#include "studies/report/figure/format.h"

namespace fingertip::studies::report::inline results {
namespace {

namespace fs = std::filesystem;

struct ParameterName {
  std::string_view name, symbol;
};
constexpr std::array<ParameterName, 8> known_parameters{{{"youngs_modulus", "E"},
                                                         {"shear_modulus", "G"},
                                                         {"lame_shear", "G"},
                                                         {"kappa", "κ"},
                                                         {"lambda", "λ"},
                                                         {"bond", "bond factor"},
                                                         {"contact", "contact factor"},
                                                         {"retardation_time", "τ"}}};

/// "1" is no unit to print.
std::string without_one(const std::string& unit) {
  return unit == "1" || unit == "-" ? "" : unit;
}

using calibration::CurveEntry;
using calibration::FitDataRow;
using calibration::FitFile;
using calibration::ParameterEntry;
using Truth = meshes::Entries<double>;

FitParameter read_parameter(const ParameterEntry& entry, const Truth& truth) {
  FitParameter parameter{entry};
  parameter.symbol = entry.name;
  for (const ParameterName& known : known_parameters)
    if (known.name == entry.name) parameter.symbol = known.symbol;
  parameter.si_unit = parameter.shown_unit = without_one(entry.unit);
  if (const ShownUnit* known = shown_units().of(parameter.si_unit)) {
    parameter.shown_unit = known->name;
    parameter.factor = known->factor;
  } else if (parameter.si_unit == "s") {
    parameter.shown_unit = "ms";
    parameter.factor = 1e3;
  }
  if (const double* known = truth.find(entry.name)) parameter.truth = *known;
  parameter.bounded = entry.bound_of == "poissons_ratio" ? "ν" : parameter.symbol;
  return parameter;
}

/// A curve may name its own quantities where those of the fit differ.
FitCurve read_curve(const CurveEntry& entry, const FitFile& file) {
  return {entry.name,
          as_shown(entry.condition),
          quantity(entry.x_quantity.empty() ? file.x_quantity : entry.x_quantity),
          quantity(entry.y_quantity.empty() ? file.y_quantity : entry.y_quantity),
          entry,
          {}};
}

/// Appends the rows of fit_data.csv to the curves they belong to; unknown names become curves.
void add_points(Fit& fit, const std::vector<FitDataRow>& rows) {
  for (const FitDataRow& row : rows) {
    auto curve = std::ranges::find(fit.curves, row.curve, &FitCurve::name);
    if (curve == fit.curves.end()) {
      CurveEntry entry;
      entry.name = row.curve;
      curve = fit.curves.insert(curve, read_curve(entry, fit.file));
    }
    curve->rows.push_back(row);
  }
}

Fit read_fit(const fs::path& folder, const Truth& truth, FolderReader& reader) {
  Fit fit;
  const JsonEntry file = reader.json(folder / "calibration.json");
  if (file.contains("problem"))
    fit.file = reader.take<FitFile>(file);
  else if (!file.empty())
    fit.file = as_fit(reader.take<calibration::ModuliFile>(file));
  fit.model = fit.file.model;
  fit.problem = fit.file.problem;
  for (const ParameterEntry& entry : fit.file.parameters)
    fit.parameters.push_back(read_parameter(entry, truth));
  for (const CurveEntry& entry : fit.file.curves) fit.curves.push_back(read_curve(entry, fit.file));
  add_points(fit, reader.rows<FitDataRow>(folder / "fit_data.csv"));
  fit.surrogate = reader.rows<calibration::SurrogateRow>(folder / "surrogate.csv");
  fit.surrogate_notes =
      reader.take<calibration::SurrogateFile>(reader.json(folder / "surrogate.json"));
  return fit;
}

std::vector<std::string> sub_folders(const fs::path& folder) {
  std::vector<std::string> names;
  if (!fs::is_directory(folder)) return names;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (fs::exists(entry.path() / "calibration.json"))
      names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

void read_fits(CalibrationData& data, const RunData& run, FolderReader& reader) {
  const TransferEntry study = run.summary.calibration.value_or(TransferEntry());
  const Truth& truth = study.truth.parameters;
  const auto add = [&](const std::string& name, const std::string& folder) {
    data.fits.push_back(
        reader.attempt([&] { return read_fit(run.folder / folder, truth, reader); }));
    data.fits.back().name = name;
    data.fits.back().folder = folder;
  };
  for (const FitEntry& entry : study.fits) {
    const std::string &name = entry.name, &folder = entry.folder;
    if (name.empty()) continue;
    add(name, folder.empty() ? "fits/" + name : folder);
    Fit& fit = data.fits.back();
    if (fit.model.empty()) fit.model = entry.model;
    if (fit.problem.empty()) fit.problem = entry.problem;
  }
  if (data.fits.empty())
    for (const std::string& name : sub_folders(run.folder / "fits")) add(name, "fits/" + name);
  if (data.fits.empty() && run.fitted_curves) add("", "");
}

void name_predictions(CalibrationData& data) {
  for (const TransferRow& row : data.transfer) {
    if (std::ranges::find(data.predictions, row.prediction) == data.predictions.end())
      data.predictions.push_back(row.prediction);
    // A fit whose folder is gone still has its predictions.
    if (std::ranges::find(data.fits, row.fit, &Fit::name) == data.fits.end()) {
      data.fits.emplace_back();
      data.fits.back().name = row.fit;
      data.fits.back().model = row.model;
    }
  }
}

double worst_of(const CalibrationData& data, const std::string& fit,
                const std::string& prediction) {
  std::vector<double> errors;
  for (const TransferRow& row : data.transfer)
    if (row.fit == fit && row.prediction == prediction) errors.push_back(row.relative_error);
  return largest_magnitude(errors);
}

/// summary.json counts where transfer.csv has nothing.
void find_worst_errors(CalibrationData& data, const std::vector<std::vector<double>>& told) {
  for (std::size_t i = 0; i < data.fits.size(); ++i) {
    std::vector<double> worst;
    for (std::size_t j = 0; j < data.predictions.size(); ++j) {
      worst.push_back(worst_of(data, data.fits[i].name, data.predictions[j]));
      if (std::isnan(worst.back()) && i < told.size() && j < told[i].size())
        worst.back() = std::abs(told[i][j]);
    }
    data.worst_error.push_back(std::move(worst));
  }
}

}  // namespace

Quantity quantity(const std::string& text) {
  Quantity result;
  const std::size_t open = text.rfind('['), close = text.rfind(']');
  const bool bracketed = open != std::string::npos && close == text.size() - 1 && open < close;
  result.name = bracketed ? text.substr(0, open) : text;
  while (result.name.ends_with(' ')) result.name.pop_back();
  if (bracketed) result.si_unit = without_one(text.substr(open + 1, close - open - 1));
  result.unit = result.si_unit;
  if (const ShownUnit* known = shown_units().of(result.si_unit))
    result.unit = known->name, result.factor = known->factor;
  return result;
}

bool FitCurve::knows(double FitDataRow::*value) const {
  return std::ranges::any_of(rows, [&](const auto& row) { return std::isfinite(row.*value); });
}

bool FitCurve::has_sigma() const {
  return std::ranges::any_of(rows, [](const auto& row) { return row.sigma > 0.0; });
}

bool FitCurve::has_model_error() const {
  // Written to all digits: equal where there is none.
  return std::ranges::any_of(rows, [](const auto& row) { return row.total_sigma > row.sigma; });
}

double FitCurve::relative_rms() const {
  Eigen::VectorXd measured(rows.size()), fitted(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    measured[Eigen::Index(i)] = rows[i].measured;
    fitted[Eigen::Index(i)] = rows[i].fitted;
  }
  return calibration::relative_rms(measured - fitted, measured);
}

double FitCurve::left_out_error() const {
  return entry.left_out ? entry.left_out->worst_relative_error : meshes::unknown;
}

std::vector<std::vector<double>> Fit::square(const std::vector<std::vector<double>>& rows) const {
  const bool square =
      rows.size() == parameters.size() &&
      std::ranges::all_of(rows, [&](const auto& row) { return row.size() == parameters.size(); });
  return square ? rows : std::vector<std::vector<double>>();
}

std::size_t Fit::index(const std::string& parameter) const {
  return std::size_t(std::ranges::find(parameters, parameter, &FitParameter::name) -
                     parameters.begin());
}

CalibrationData read_calibration(const RunData& run, FolderReader& reader) {
  CalibrationData data;
  const TransferEntry study = run.summary.calibration.value_or(TransferEntry());
  data.study = run.summary.calibration.has_value();
  read_fits(data, run, reader);
  for (const PredictionEntry& entry : study.predictions)
    if (!entry.name.empty()) data.predictions.push_back(entry.name);
  data.transfer = reader.rows<TransferRow>(run.folder / "transfer.csv");
  name_predictions(data);
  find_worst_errors(data, study.worst_error);
  return data;
}

}  // namespace fingertip::studies::report::inline results
