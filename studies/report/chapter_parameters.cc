/// What a fit gives for its parameters, and which of that the data determine.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "studies/report/calibration_chapters.h"
#include "studies/report/calibration_figures.h"

namespace fingertip::studies::reporting {
namespace {

using calibration::DirectionEntry, calibration::MinimumEntry;

using Blocks = std::vector<Block>;

/// "40.1 kPa"; in the paper's units SI is the note.
std::string shown(const FitParameter& parameter, double value) {
  const std::string unit = parameter.unit.empty() ? "" : gap + parameter.unit;
  return std::isfinite(value) ? number(parameter.factor * value) + unit : "–";
}

std::string in_si(const FitParameter& parameter, double value) {
  return std::isfinite(value) && !parameter.si_unit.empty() ? si_note(value, parameter.si_unit)
                                                            : "";
}

/// An interval wider than the value on both sides tells that the data leave it open.
bool is_open(const FitParameter& one) {
  return one.upper - one.lower > 2.0 * std::abs(one.estimate);
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

Cell value_cell(const FitParameter& one, double value) {
  return plain(std::isfinite(value) ? number(one.factor * value) : "–", in_si(one, value));
}

Cell interval_cell(const FitParameter& one) {
  if (one.at_bound) return plain(interval(one, one.factor), one.bounded + " at its bound");
  if (is_open(one)) return plain(interval(one, one.factor));
  const std::string lower = in_si(one, one.lower), upper = in_si(one, one.upper);
  return plain(interval(one, one.factor),
               lower.empty() || upper.empty() ? "" : lower + " … " + upper);
}

Cell prior_cell(const FitParameter& one) {
  if (!std::isfinite(one.prior_mean)) return plain("none");
  return plain(
      number(one.factor * one.prior_mean) + " ± " + number(one.factor * one.prior_deviation, 3),
      in_si(one, one.prior_mean));
}

constexpr ParameterColumn parameter_columns[] = {
    {"Estimate", "", [](const FitParameter&) { return true; },
     [](const FitParameter& one) { return value_cell(one, one.estimate); }},
    {"95 % interval", "", [](const FitParameter&) { return true; }, interval_cell},
    {"Standard error", "of the estimate",
     [](const FitParameter& one) { return std::isfinite(one.standard_error); },
     [](const FitParameter& one) {
       return plain(is_open(one) ? "–"
                                 : percent_magnitude(one.standard_error / std::abs(one.estimate)));
     }},
    {"Truth", "", [](const FitParameter& one) { return std::isfinite(one.truth); },
     [](const FitParameter& one) {
       const double error = one.estimate / one.truth - 1.0;
       Cell cell = value_cell(one, one.truth);
       if (!std::isfinite(error)) return cell;
       cell.note +=
           (cell.note.empty() ? "" : ", ") + std::string("missed by ") + percent_magnitude(error);
       cell.grade = grade(error);
       return cell;
     }},
    {"Start", "", [](const FitParameter& one) { return std::isfinite(one.start); },
     [](const FitParameter& one) { return value_cell(one, one.start); }},
    {"Prior", "mean ± deviation",
     [](const FitParameter& one) { return std::isfinite(one.prior_mean); }, prior_cell},
    {"Bias", "of a model error", [](const FitParameter& one) { return std::isfinite(one.bias); },
     [](const FitParameter& one) {
       Cell cell = value_cell(one, one.bias);
       cell.note = std::isfinite(one.bias) ? percent(one.bias / one.estimate) : "";
       return cell;
     }},
};

Table parameter_table(const Fit& fit) {
  Table table;
  table.caption =
      "The parameters. Intervals are linearised at the estimates and know of no errors "
      "of the model itself";
  const auto any = [&](const auto& there) { return std::ranges::any_of(fit.parameters, there); };
  table.caption += any([](const FitParameter& one) { return std::isfinite(one.bias); })
                       ? " but the bias: how far the known error of the model moves the estimate."
                       : ".";
  table.graded = any([](const FitParameter& one) { return std::isfinite(one.truth); });
  table.header = {plain("Parameter")};
  for (const ParameterColumn& column : parameter_columns)
    if (any(column.there)) table.header.push_back(plain(column.title, column.note));
  for (const FitParameter& one : fit.parameters) {
    const std::string unit = one.unit.empty() ? "1" : one.unit;
    std::vector<Cell> row{plain(one.symbol + " [" + unit + "]", one.name)};
    for (const ParameterColumn& column : parameter_columns)
      if (any(column.there)) row.push_back(column.cell(one));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table correlation_table(const Fit& fit, const std::vector<std::vector<double>>& correlation) {
  Table table;
  table.caption =
      "Correlation of the estimates: near 1 or −1 the data know a combination of the two much "
      "better than either.";
  table.header = {plain("Correlation")};
  for (const FitParameter& one : fit.parameters) table.header.push_back(plain(one.symbol));
  for (std::size_t i = 0; i < correlation.size(); ++i) {
    std::vector<Cell> row{plain(fit.parameters[i].symbol)};
    for (const double value : correlation[i]) row.push_back(plain(number(value, 3)));
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Estimates apart by more than a per cent are another minimum.
bool same_place(const std::vector<double>& one, const std::vector<double>& other) {
  for (std::size_t i = 0; i < std::min(one.size(), other.size()); ++i) {
    const double size = std::fmax(std::abs(one[i]), std::abs(other[i]));
    if (std::abs(one[i] - other[i]) > 0.01 * size) return false;
  }
  return true;
}

void add_minima(Blocks& blocks, const Fit& fit) {
  const std::vector<MinimumEntry>& minima = fit.file.minima;
  if (minima.size() < 2) return;
  const MinimumEntry& least = *std::ranges::min_element(minima, {}, [](const MinimumEntry& one) {
    return std::isfinite(one.loss) ? one.loss : std::numeric_limits<double>::infinity();
  });
  const auto same = std::ranges::count_if(
      minima, [&](const MinimumEntry& one) { return same_place(one.estimates, least.estimates); });
  if (same == std::ptrdiff_t(minima.size())) {
    blocks.push_back(Paragraph{
        "Other minima.", fmt::format("All {} starts ended at the same place.", minima.size())});
    return;
  }
  Table table;
  table.caption = fmt::format(
      "Where the {} starts ended. The one of least loss is reported; one of nearly the same loss "
      "elsewhere would describe the data as well.",
      minima.size());
  table.header = {plain("Start")};
  for (const FitParameter& one : fit.parameters)
    table.header.push_back(plain(one.symbol, one.unit));
  table.header.insert(table.header.end(), {plain("Loss"), plain("Iterations")});
  for (const MinimumEntry& one : minima) {
    const std::vector<double>& estimates = one.estimates;
    std::vector<Cell> row{
        plain(std::to_string(table.rows.size() + 1), &one == &least ? "reported" : "")};
    for (std::size_t i = 0; i < fit.parameters.size(); ++i)
      row.push_back(plain(number(i < estimates.size() ? fit.parameters[i].factor * estimates[i]
                                                      : meshes::unknown)));
    row.push_back(plain(number(one.loss)));
    row.push_back(plain(count(double(one.iterations))));
    table.rows.push_back(std::move(row));
  }
  blocks.push_back(std::move(table));
}

/// A direction in words: its statement, else its components.
std::string direction_words(const Fit& fit, const DirectionEntry& entry) {
  if (!entry.statement.empty()) return entry.statement;
  std::vector<std::string> parts;
  for (const FitParameter& one : fit.parameters) {
    const double* change = entry.direction.find(one.name);
    if (change && std::abs(*change) > 5e-4)
      parts.push_back(one.symbol + " × " + number(*change, 2));
  }
  return "A change along " + (parts.empty() ? "an unnamed direction" : enumerate(parts)) +
         " is hardly seen.";
}

void add_directions(Blocks& blocks, const Fit& fit, const std::vector<DirectionEntry>& directions,
                    const std::string& lead) {
  for (const DirectionEntry& entry : directions) {
    std::string text = direction_words(fit, entry);
    const double share = entry.relative_singular_value, width = entry.interval;
    if (std::isfinite(share))
      text += fmt::format(" Singular value: {} of the largest.", percent_magnitude(share));
    if (std::isfinite(width))
      text += width <= 1.0
                  ? fmt::format(" 95 % interval along it: ±{} of the parameters.",
                                percent_magnitude(width))
                  : std::string(" 95 % interval along it: wider than the parameters themselves.");
    blocks.push_back(Paragraph{lead, text, true});
  }
}

std::string profile_caption(const Fit& fit) {
  std::string text =
      "Lines: where the least chi-square with the two parameters held exceeds the minimum by 2.30, "
      "5.99 and 9.21, the regions of 68, 95 and 99 %. Dashed: the 95 % region as the linearised "
      "fit has it; where the two part, the intervals of the table are not to be trusted. ";
  double least = 0.0;
  for (const std::vector<double>& row : fit.file.profile->increase)
    for (const double value : row) least = std::fmin(least, value);
  if (least < -0.1)
    text += fmt::format(
        "Chi-square falls by {} below the fit's somewhere on this grid: the fit is not at the "
        "least minimum. ",
        number(-least, 3));
  return text +
         "Lines end where the computed grid does; squares in their place are the grid's own "
         "points, "
         "too far apart for lines.";
}

}  // namespace

std::vector<Block> parameter_blocks(const Fit& fit) {
  std::vector<Block> blocks;
  if (fit.parameters.empty()) return blocks;
  blocks.push_back(parameter_table(fit));
  const auto correlation = fit.square(fit.file.correlation);
  if (correlation.size() > 1) blocks.push_back(correlation_table(fit, correlation));
  add_minima(blocks, fit);
  return blocks;
}

std::vector<Block> identifiability_blocks(const Fit& fit, const std::string& prefix) {
  std::vector<Block> blocks;
  if (fit.parameters.empty()) return blocks;
  add_directions(blocks, fit, fit.file.unidentifiable, "The data do not determine the answer.");
  add_directions(blocks, fit, fit.file.only_from_priors, "Only priors determine this.");
  std::vector<std::string> bounded;
  for (const FitParameter& one : fit.parameters)
    if (one.at_bound) bounded.push_back(one.bounded);
  if (!bounded.empty())
    blocks.push_back(Paragraph{
        "At a bound.",
        enumerate(bounded) + " ended at the limit set for the search; the data would go further, "
                             "and what is given as the interval is none.",
        true});
  if (fit.file.unidentifiable.empty() && fit.file.only_from_priors.empty())
    blocks.push_back(Paragraph{"", fit.parameters.size() == 1
                                       ? "The data determine the parameter."
                                       : "The data determine every direction of the parameters."});
  const auto add = [&](Figure figure, const std::string& title, const std::string& caption) {
    if (!figure.panels.empty()) blocks.push_back(FigureBlock{std::move(figure), title, caption});
  };
  add(singular_value_figure(fit, prefix), "What the data see",
      "How strongly the curves respond, in units of sigma, to a change of all parameters by "
      "their own size along one direction. A value below the dashed line is a direction "
      "along which a model error of two per cent moves the parameters by their own size.");
  if (fit.file.profile)
    add(profile_figure(fit, prefix), "Profile likelihood", profile_caption(fit));
  return blocks;
}

std::string estimate_words(const FitParameter& one) {
  std::string text = one.symbol + " = " + shown(one, one.estimate);
  if (one.at_bound) return text + " (" + one.bounded + " at its bound)";
  if (std::isfinite(one.lower) && std::isfinite(one.upper))
    text += is_open(one) ? " (" + interval(one, one.factor) + ")"
                         : fmt::format(" (95 %: {})", interval(one, one.factor));
  return text;
}

}  // namespace fingertip::studies::reporting
