#include "studies/report/calibration_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "studies/report/format.h"

namespace fingertip::studies::reporting {
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

FitParameter read_parameter(const JsonEntry& entry, const JsonEntry& truth) {
  FitParameter parameter;
  parameter.name = parameter.symbol = text_at(entry, "name");
  for (const ParameterName& known : known_parameters)
    if (known.name == parameter.name) parameter.symbol = known.symbol;
  parameter.si_unit = parameter.unit = without_one(text_at(entry, "unit"));
  if (const ShownUnit* known = shown_units().of(parameter.si_unit)) {
    parameter.unit = known->name;
    parameter.factor = known->factor;
  } else if (parameter.si_unit == "s") {
    parameter.unit = "ms";
    parameter.factor = 1e3;
  }
  const JsonEntry prior = object_at(entry, "prior");
  parameter.estimate = number_at(entry, "estimate");
  parameter.standard_error = number_at(entry, "standard_error");
  parameter.lower = number_at(entry, "lower");
  parameter.upper = number_at(entry, "upper");
  parameter.start = number_at(entry, "start");
  parameter.bias = number_at(entry, "bias");
  parameter.prior_mean = number_at(prior, "mean");
  parameter.prior_deviation = number_at(prior, "deviation");
  parameter.truth = number_at(truth, parameter.name);
  parameter.at_bound = entry.at("at_bound").flag();
  parameter.bounded = text_at(entry, "bound_of") == "poissons_ratio" ? "ν" : parameter.symbol;
  return parameter;
}

/// A curve may name its own quantities where those of the fit differ.
FitCurve read_curve(const JsonEntry& entry, const JsonEntry& file) {
  const auto own = [&](const char* key) {
    const std::string text = text_at(entry, key);
    return quantity(text.empty() ? text_at(file, key) : text);
  };
  FitCurve curve;
  curve.name = text_at(entry, "name");
  curve.condition = text_at(entry, "condition");
  curve.x_quantity = own("x_quantity");
  curve.y_quantity = own("y_quantity");
  curve.points = number_at(entry, "points");
  curve.worst = number_at(entry, "worst_relative_residual");
  curve.rms = number_at(entry, "rms_relative_residual");
  const JsonEntry structure = object_at(entry, "structure");
  curve.structure = text_at(structure, "statement");
  curve.structure_probability = number_at(structure, "probability");
  curve.left_out_error = number_at(object_at(entry, "left_out"), "worst_relative_error");
  return curve;
}

/// Appends the rows of fit_data.csv to the curves they belong to; unknown names become curves.
void add_points(Fit& fit, const CsvTable& table) {
  const auto name = table.texts("curve");
  const auto x = table.numbers("x"), measured = table.numbers("measured"),
             sigma = table.numbers_if_any("sigma"), fitted = table.numbers("fitted"),
             left_out = table.numbers_if_any("left_out");
  for (std::size_t i = 0; i < name.size(); ++i) {
    auto curve = std::ranges::find(fit.curves, name[i], &FitCurve::name);
    if (curve == fit.curves.end()) {
      fit.curves.push_back(read_curve(nlohmann::json{{"name", name[i]}}, fit.file));
      curve = fit.curves.end() - 1;
    }
    curve->x.push_back(x[i]);
    curve->measured.push_back(measured[i]);
    curve->sigma.push_back(sigma[i]);
    curve->fitted.push_back(fitted[i]);
    curve->left_out.push_back(left_out[i]);
  }
}

Fit read_fit(const fs::path& folder, const JsonEntry& truth, FolderReader& reader) {
  Fit fit;
  fit.file = reader.json(folder / "calibration.json");
  fit.model = text_at(fit.file, "model");
  fit.problem = text_at(fit.file, "problem");
  for (const JsonEntry& entry : array_at(fit.file, "parameters"))
    fit.parameters.push_back(read_parameter(entry, truth));
  for (const JsonEntry& entry : array_at(fit.file, "curves"))
    fit.curves.push_back(read_curve(entry, fit.file));
  add_points(fit, reader.csv(folder / "fit_data.csv"));
  fit.surrogate = reader.csv(folder / "surrogate.csv");
  fit.surrogate_notes = reader.json(folder / "surrogate.json");
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
  const JsonEntry truth = object_at(object_at(run.calibration, "truth"), "parameters");
  const auto add = [&](const std::string& name, const std::string& folder) {
    data.fits.push_back(
        reader.attempt([&] { return read_fit(run.folder / folder, truth, reader); }));
    data.fits.back().name = name;
    data.fits.back().folder = folder;
  };
  for (const JsonEntry& entry : array_at(run.calibration, "fits")) {
    const std::string name = text_at(entry, "name"), folder = text_at(entry, "folder");
    if (name.empty()) continue;
    add(name, folder.empty() ? "fits/" + name : folder);
    Fit& fit = data.fits.back();
    if (fit.model.empty()) fit.model = text_at(entry, "model");
    if (fit.problem.empty()) fit.problem = text_at(entry, "problem");
  }
  if (data.fits.empty())
    for (const std::string& name : sub_folders(run.folder / "fits")) add(name, "fits/" + name);
  if (data.fits.empty() && !text_at(run.own_calibration, "problem").empty()) add("", "");
}

std::vector<PredictedForce> read_transfer(const CsvTable& table) {
  const auto fit = table.texts("fit"), prediction = table.texts("prediction"),
             model = table.texts("model"), status = table.texts("status");
  const auto depth = table.numbers("indentation [m]"), force = table.numbers("normal_force [N]"),
             reference = table.numbers("reference_force [N]"),
             reference_error = table.numbers("reference_error"),
             error = table.numbers("relative_error");
  std::vector<PredictedForce> rows;
  for (std::size_t i = 0; i < fit.size(); ++i)
    rows.push_back({fit[i], prediction[i], model[i], status[i], depth[i], force[i], reference[i],
                    reference_error[i], error[i]});
  return rows;
}

void name_predictions(CalibrationData& data) {
  for (const PredictedForce& row : data.transfer) {
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
  for (const PredictedForce& row : data.transfer)
    if (row.fit == fit && row.prediction == prediction) errors.push_back(row.error);
  return largest_magnitude(errors);
}

/// summary.json counts where transfer.csv has nothing.
void find_worst_errors(CalibrationData& data, const JsonEntry& summary) {
  std::vector<std::vector<double>> told;
  for (const JsonEntry& row : array_at(summary, "worst_error")) told.push_back(row.numbers());
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

bool FitCurve::has_sigma() const {
  return std::ranges::any_of(sigma, [](double value) { return value > 0.0; });
}

std::vector<std::vector<double>> Fit::matrix(const std::string& key) const {
  std::vector<std::vector<double>> rows;
  for (const JsonEntry& row : array_at(file, key)) rows.push_back(row.numbers());
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
  data.study = !run.calibration.empty();
  read_fits(data, run, reader);
  for (const JsonEntry& entry : array_at(run.calibration, "predictions"))
    if (const std::string name = text_at(entry, "name"); !name.empty())
      data.predictions.push_back(name);
  data.transfer =
      reader.attempt([&] { return read_transfer(reader.csv(run.folder / "transfer.csv")); });
  name_predictions(data);
  find_worst_errors(data, run.calibration);
  return data;
}

}  // namespace fingertip::studies::reporting
