/// What a fit gives for its parameters, and which of that the data determine.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/chapters/fit/calibration_figures.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

using calibration::DirectionEntry, calibration::MinimumEntry;

/// "40.1 kPa"; in the paper's units SI is the note.
std::string shown(const FitParameter& parameter, double value) {
  const std::string unit = parameter.shown_unit.empty() ? "" : gap + parameter.shown_unit;
  return std::isfinite(value) ? number(parameter.factor * value) + unit : "–";
}

std::string in_si(const FitParameter& parameter, double value) {
  return std::isfinite(value) && !parameter.si_unit.empty() ? si_note(value, parameter.si_unit)
                                                            : "";
}

bool is_open(const FitParameter& parameter) {
  return calibration::is_open(parameter.si_unit, parameter.estimate, parameter.lower,
                              parameter.upper);
}

/// Relative, of what has a size; of a travel or a force's zero as it is.
std::string standard_error(const FitParameter& parameter) {
  if (is_open(parameter)) return "–";
  const double error = parameter.standard_error;
  return error > std::abs(parameter.estimate)
             ? shown(parameter, error)
             : percent_magnitude(error / std::abs(parameter.estimate));
}

std::string interval(const FitParameter& parameter, double factor) {
  if (!std::isfinite(parameter.lower) && !std::isfinite(parameter.upper)) return "–";
  if (is_open(parameter)) return "not determined by these data";
  return number(factor * parameter.lower) + " … " + number(factor * parameter.upper);
}

Cell value_cell(const FitParameter& parameter, double value) {
  return {number(parameter.factor * value), in_si(parameter, value)};
}

Cell interval_cell(const FitParameter& parameter) {
  const std::string text = interval(parameter, parameter.factor);
  if (parameter.at_bound) return {text, parameter.bounded + " at its bound"};
  if (is_open(parameter)) return text;
  const std::string lower = in_si(parameter, parameter.lower),
                    upper = in_si(parameter, parameter.upper);
  return {text, lower.empty() || upper.empty() ? "" : lower + " … " + upper};
}

Cell prior_cell(const FitParameter& parameter) {
  if (!parameter.prior) return "none";
  return {number(parameter.factor * parameter.prior->mean) + " ± " +
              number(parameter.factor * parameter.prior->deviation, 3),
          in_si(parameter, parameter.prior->mean)};
}

Cell truth_cell(const FitParameter& parameter) {
  const double error = parameter.estimate / parameter.truth - 1.0;
  Cell cell = value_cell(parameter, parameter.truth);
  if (!std::isfinite(error)) return cell;
  cell.note +=
      (cell.note.empty() ? "" : ", ") + std::string("missed by ") + percent_magnitude(error);
  cell.grade = grade(error);
  return cell;
}

Cell bias_cell(const FitParameter& parameter) {
  return {number(parameter.factor * parameter.bias),
          if_known(parameter.bias, percent(parameter.bias / parameter.estimate))};
}

bool any_known(const Fit& fit, double FitParameter::*value) {
  return std::ranges::any_of(fit.parameters, [&](const FitParameter& parameter) {
    return std::isfinite(parameter.*value);
  });
}

Table parameter_table(const Fit& fit) {
  Table table{heads({"Parameter", "Estimate", "95 % interval", "Standard error\nof the estimate",
                     "Truth", "Start", "Prior\nmean ± deviation", "Bias\nof a model error"}),
              any_known(fit, &FitParameter::truth)};
  for (const FitParameter& p : fit.parameters)
    table.rows.push_back(
        {{p.symbol + " [" + (p.shown_unit.empty() ? "1" : p.shown_unit) + "]", p.name},
         value_cell(p, p.estimate),
         interval_cell(p),
         standard_error(p),
         truth_cell(p),
         value_cell(p, p.start),
         prior_cell(p),
         bias_cell(p)});
  if (std::ranges::none_of(fit.parameters, [](const auto& p) { return p.prior.has_value(); }))
    table.drop_column(6);
  table.drop_unknown(4);
  if (!any_known(fit, &FitParameter::standard_error)) table.drop_column(3);
  return table;
}

/// Without rows for a single parameter.
Table correlation_table(const Fit& fit) {
  const std::vector<std::vector<double>> correlation = fit.square(fit.file.correlation);
  if (correlation.size() < 2) return {};
  Table table{{"Correlation"}};
  for (const FitParameter& parameter : fit.parameters) {
    table.header.emplace_back(parameter.symbol);
    std::vector<Cell>& row = table.rows.emplace_back();
    row.emplace_back(parameter.symbol);
    for (const double value : correlation[table.rows.size() - 1])
      row.emplace_back(number(value, 3));
  }
  return table;
}

/// Estimates apart by more than a per cent are another minimum.
bool same_place(const std::vector<double>& a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    const double size = std::fmax(std::abs(a[i]), std::abs(b[i]));
    if (std::abs(a[i] - b[i]) > 0.01 * size) return false;
  }
  return true;
}

const MinimumEntry& lowest_minimum(const Fit& fit) {
  return *std::ranges::min_element(fit.file.minima, {}, [](const MinimumEntry& minimum) {
    return std::isfinite(minimum.loss) ? minimum.loss : std::numeric_limits<double>::infinity();
  });
}

/// Whether all of several starts ended at one place.
bool is_same_minimum(const Fit& fit) {
  const std::vector<MinimumEntry>& minima = fit.file.minima;
  return minima.size() > 1 && std::ranges::all_of(minima, [&](const MinimumEntry& minimum) {
           return same_place(minimum.estimates, lowest_minimum(fit).estimates);
         });
}

/// Without rows where there is but one minimum.
Table minima_table(const Fit& fit) {
  if (fit.file.minima.size() < 2 || is_same_minimum(fit)) return {};
  Table table{{"Start"}};
  for (const FitParameter& parameter : fit.parameters)
    table.header.emplace_back(parameter.symbol, parameter.shown_unit);
  table.header.insert(table.header.end(), {"Loss", "Iterations"});
  for (const MinimumEntry& minimum : fit.file.minima) {
    const std::vector<double>& estimates = minimum.estimates;
    std::vector<Cell> row{{std::to_string(table.rows.size() + 1),
                           &minimum == &lowest_minimum(fit) ? "reported" : ""}};
    for (std::size_t i = 0; i < fit.parameters.size(); ++i)
      row.emplace_back(i < estimates.size() ? number(fit.parameters[i].factor * estimates[i])
                                            : "–");
    row.insert(row.end(), {number(minimum.loss), count(double(minimum.iterations))});
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// "E × 0.71 and κ × 0.7", the components of a direction.
std::string components(const Fit& fit, const DirectionEntry& entry) {
  std::vector<std::string> parts;
  for (const FitParameter& parameter : fit.parameters) {
    const double* change = entry.direction.find(parameter.name);
    if (change && std::abs(*change) > 5e-4)
      parts.push_back(parameter.symbol + " × " + number(*change, 2));
  }
  return enumerate(parts);
}

/// The directions that the data leave `open`, or that only priors close.
void add_directions(WordList& words, const Fit& fit, const std::vector<DirectionEntry>& directions,
                    bool open) {
  for (const DirectionEntry& entry : directions) {
    const double share = entry.relative_singular_value, width = entry.interval;
    TemplateData& row = words.emplace_back();
    row["open"] = open;
    row["statement"] = as_shown(entry.statement);
    row["direction"] = components(fit, entry);
    row["share"] = if_known(share, percent_magnitude(share));
    row["width"] = width <= 1.0 ? percent_magnitude(width) : "";
    row["wide"] = std::isfinite(width) && width > 1.0;
  }
}

/// How far chi-square falls below the fit's on the grid of the profile; "" when it does not.
std::string fall_of_chi_square(const Fit& fit) {
  double least = 0.0;
  if (fit.file.profile)
    for (const std::vector<double>& row : fit.file.profile->increase)
      for (const double value : row) least = std::fmin(least, value);
  return least < -0.1 ? number(-least, 3) : "";
}

/// "indentation up to 20 % of the thickness, model central and …"; empty when nothing is told.
std::string checked_for(const Fit& fit) {
  const calibration::ValidityEntry& validity = fit.file.validity;
  const double strain = validity.largest_strain_measure, nu = validity.poissons_ratio;
  std::vector<std::string> parts = {
      if_known(strain, "indentation up to " + percent_magnitude(strain) + " of the thickness"),
      validity.model.empty() ? "" : "model " + validity.model,
      validity.kinematics.empty() ? "" : "kinematics " + validity.kinematics,
      if_known(validity.spacing, "spacing " + length(validity.spacing)),
      if_known(nu, "Poisson's ratio " + number(nu))};
  std::erase(parts, "");
  return enumerate(parts);
}

}  // namespace

Chapter parameter_chapter(const Fit& fit, const std::string& prefix) {
  ChapterData chapter("fit_parameters");
  chapter.id = prefix + "-parameters";
  chapter["name"] = fit.name;
  chapter["starts"] = std::to_string(fit.file.minima.size());
  chapter["bias"] = any_known(fit, &FitParameter::bias);
  chapter["same_minimum"] = !fit.parameters.empty() && is_same_minimum(fit);
  chapter["checked"] = checked_for(fit);
  if (!fit.parameters.empty()) {
    chapter.tables["parameters"] = parameter_table(fit);
    chapter.tables["correlation"] = correlation_table(fit);
    chapter.tables["minima"] = minima_table(fit);
  }
  return written(std::move(chapter));
}

Chapter identifiability_chapter(const Fit& fit, const std::string& prefix) {
  if (fit.parameters.empty()) return {};
  ChapterData chapter("fit_identifiability");
  chapter.id = prefix + "-identifiability";
  chapter["name"] = fit.name;
  chapter["prefix"] = prefix;
  WordList directions;
  add_directions(directions, fit, fit.file.unidentifiable, true);
  add_directions(directions, fit, fit.file.only_from_priors, false);
  chapter["directions"] = std::move(directions);
  std::vector<std::string> bounded;
  for (const FitParameter& parameter : fit.parameters)
    if (parameter.at_bound) bounded.push_back(parameter.bounded);
  chapter["bounded"] = enumerate(bounded);
  chapter["one"] = fit.parameters.size() == 1;
  chapter["below"] = fall_of_chi_square(fit);
  chapter.figures = {singular_value_figure(fit, prefix)};
  if (fit.file.profile) chapter.figures.push_back(profile_figure(fit, prefix));
  return written(std::move(chapter));
}

std::string estimate_words(const FitParameter& parameter) {
  std::string text = parameter.symbol + " = " + shown(parameter, parameter.estimate);
  if (parameter.at_bound) return text + " (" + parameter.bounded + " at its bound)";
  if (std::isfinite(parameter.lower) && std::isfinite(parameter.upper))
    text += is_open(parameter) ? " (" + interval(parameter, parameter.factor) + ")"
                               : fmt::format(" (95 %: {})", interval(parameter, parameter.factor));
  return text;
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
