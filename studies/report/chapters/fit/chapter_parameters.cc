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
  const std::string unit = parameter.unit.empty() ? "" : gap + parameter.unit;
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

/// A column that is there when some parameter has something to put into it.
struct ParameterColumn {
  const char *title, *note;
  bool (*there)(const FitParameter&);
  Cell (*cell)(const FitParameter&);
};

Cell value_cell(const FitParameter& parameter, double value) {
  return plain(std::isfinite(value) ? number(parameter.factor * value) : "–",
               in_si(parameter, value));
}

Cell interval_cell(const FitParameter& parameter) {
  if (parameter.at_bound)
    return plain(interval(parameter, parameter.factor), parameter.bounded + " at its bound");
  if (is_open(parameter)) return plain(interval(parameter, parameter.factor));
  const std::string lower = in_si(parameter, parameter.lower),
                    upper = in_si(parameter, parameter.upper);
  return plain(interval(parameter, parameter.factor),
               lower.empty() || upper.empty() ? "" : lower + " … " + upper);
}

Cell prior_cell(const FitParameter& parameter) {
  if (!std::isfinite(parameter.prior_mean)) return plain("none");
  return plain(number(parameter.factor * parameter.prior_mean) + " ± " +
                   number(parameter.factor * parameter.prior_deviation, 3),
               in_si(parameter, parameter.prior_mean));
}

constexpr ParameterColumn parameter_columns[] = {
    {"Estimate", "", [](const FitParameter&) { return true; },
     [](const FitParameter& parameter) { return value_cell(parameter, parameter.estimate); }},
    {"95 % interval", "", [](const FitParameter&) { return true; }, interval_cell},
    {"Standard error", "of the estimate",
     [](const FitParameter& parameter) { return std::isfinite(parameter.standard_error); },
     [](const FitParameter& parameter) { return plain(standard_error(parameter)); }},
    {"Truth", "", [](const FitParameter& parameter) { return std::isfinite(parameter.truth); },
     [](const FitParameter& parameter) {
       const double error = parameter.estimate / parameter.truth - 1.0;
       Cell cell = value_cell(parameter, parameter.truth);
       if (!std::isfinite(error)) return cell;
       cell.note +=
           (cell.note.empty() ? "" : ", ") + std::string("missed by ") + percent_magnitude(error);
       cell.grade = grade(error);
       return cell;
     }},
    {"Start", "", [](const FitParameter& parameter) { return std::isfinite(parameter.start); },
     [](const FitParameter& parameter) { return value_cell(parameter, parameter.start); }},
    {"Prior", "mean ± deviation",
     [](const FitParameter& parameter) { return std::isfinite(parameter.prior_mean); }, prior_cell},
    {"Bias", "of a model error",
     [](const FitParameter& parameter) { return std::isfinite(parameter.bias); },
     [](const FitParameter& parameter) {
       Cell cell = value_cell(parameter, parameter.bias);
       cell.note = if_known(parameter.bias, percent(parameter.bias / parameter.estimate));
       return cell;
     }},
};

bool any_parameter(const Fit& fit, bool (*there)(const FitParameter&)) {
  return std::ranges::any_of(fit.parameters, there);
}

Table parameter_table(const Fit& fit) {
  Table table;
  table.graded = any_parameter(
      fit, [](const FitParameter& parameter) { return std::isfinite(parameter.truth); });
  table.header = {plain("Parameter")};
  for (const ParameterColumn& column : parameter_columns)
    if (any_parameter(fit, column.there)) table.header.push_back(plain(column.title, column.note));
  for (const FitParameter& parameter : fit.parameters) {
    const std::string unit = parameter.unit.empty() ? "1" : parameter.unit;
    std::vector<Cell> row{plain(parameter.symbol + " [" + unit + "]", parameter.name)};
    for (const ParameterColumn& column : parameter_columns)
      if (any_parameter(fit, column.there)) row.push_back(column.cell(parameter));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Without rows for a single parameter.
Table correlation_table(const Fit& fit) {
  const std::vector<std::vector<double>> correlation = fit.square(fit.file.correlation);
  Table table;
  if (correlation.size() < 2) return table;
  table.header = {plain("Correlation")};
  for (const FitParameter& parameter : fit.parameters)
    table.header.push_back(plain(parameter.symbol));
  for (std::size_t i = 0; i < correlation.size(); ++i) {
    std::vector<Cell> row{plain(fit.parameters[i].symbol)};
    for (const double value : correlation[i]) row.push_back(plain(number(value, 3)));
    table.rows.push_back(std::move(row));
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

const MinimumEntry& least_minimum(const Fit& fit) {
  return *std::ranges::min_element(fit.file.minima, {}, [](const MinimumEntry& minimum) {
    return std::isfinite(minimum.loss) ? minimum.loss : std::numeric_limits<double>::infinity();
  });
}

/// Whether all of several starts ended at one place.
bool is_same_minimum(const Fit& fit) {
  const std::vector<MinimumEntry>& minima = fit.file.minima;
  return minima.size() > 1 && std::ranges::all_of(minima, [&](const MinimumEntry& minimum) {
           return same_place(minimum.estimates, least_minimum(fit).estimates);
         });
}

/// Without rows where there is but one minimum.
Table minima_table(const Fit& fit) {
  Table table;
  if (fit.file.minima.size() < 2 || is_same_minimum(fit)) return table;
  table.header = {plain("Start")};
  for (const FitParameter& parameter : fit.parameters)
    table.header.push_back(plain(parameter.symbol, parameter.unit));
  table.header.insert(table.header.end(), {plain("Loss"), plain("Iterations")});
  for (const MinimumEntry& minimum : fit.file.minima) {
    const std::vector<double>& estimates = minimum.estimates;
    std::vector<Cell> row{plain(std::to_string(table.rows.size() + 1),
                                &minimum == &least_minimum(fit) ? "reported" : "")};
    for (std::size_t i = 0; i < fit.parameters.size(); ++i)
      row.push_back(plain(number(i < estimates.size() ? fit.parameters[i].factor * estimates[i]
                                                      : meshes::unknown)));
    row.push_back(plain(number(minimum.loss)));
    row.push_back(plain(count(double(minimum.iterations))));
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
    Words& row = words.emplace_back();
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
  std::vector<std::string> parts;
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty() && value != "–") parts.push_back(name + value);
  };
  add("indentation up to ",
      std::isfinite(validity.largest_strain_measure)
          ? percent_magnitude(validity.largest_strain_measure) + " of the thickness"
          : "");
  add("model ", validity.model);
  add("kinematics ", validity.kinematics);
  if (std::isfinite(validity.spacing)) add("spacing ", length(validity.spacing));
  add("Poisson's ratio ", number(validity.poissons_ratio));
  return enumerate(parts);
}

}  // namespace

Chapter parameter_chapter(const Fit& fit, const std::string& prefix) {
  ChapterData chapter("fit_parameters");
  chapter.id = prefix + "-parameters";
  chapter["name"] = fit.name;
  chapter["starts"] = std::to_string(fit.file.minima.size());
  chapter["bias"] = any_parameter(
      fit, [](const FitParameter& parameter) { return std::isfinite(parameter.bias); });
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
