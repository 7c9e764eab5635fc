/// What files of presses tell besides the curve that is fitted: noise, loop, holds, repeats, the
/// machine, and what is like the misfit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

using calibration::LoadingHistory;
using calibration::Repeats;
using calibration::RigEntry;
using calibration::ScoreTest;

/// A number where it has no unit.
std::string amount_of(double value, const std::string& unit, int digits = 4) {
  return unit.empty() || unit == "1" ? number(value, digits) : amount(value, unit);
}

/// With its sign where it is negative: a force that rises in a hold.
std::string share_words(double share) {
  return share < 0.0 ? percent(share) : percent_magnitude(share);
}

/// Root mean square of measured less fitted.
double misfit_of(const FitCurve& curve) {
  double sum = 0.0;
  for (const auto& row : curve.rows) sum += std::pow(row.measured - row.fitted, 2);
  return curve.rows.empty() ? meshes::unknown : std::sqrt(sum / double(curve.rows.size()));
}

bool any_course(const Fit& fit) {
  return std::ranges::any_of(fit.curves,
                             [](const FitCurve& curve) { return curve.entry.course.has_value(); });
}

Table file_table(const Fit& fit) {
  if (!any_course(fit)) return {};
  Table table{heads({"File", "Rows", "Points\nfitted", "Noise", "Misfit", "Loop", "Relaxation"})};
  for (const FitCurve& curve : fit.curves) {
    const LoadingHistory course = curve.entry.course.value_or(LoadingHistory());
    const std::string& unit = curve.y_quantity.si_unit;
    const double misfit = misfit_of(curve), noise = course.noise_of_value(), ratio = misfit / noise;
    const bool timed = course.hold_time > 0.0;
    // A way back above the loading is the machine's.
    table.rows.push_back({{curve.name, curve.condition},
                          count(double(course.rows)),
                          count(double(curve.rows.size())),
                          amount(noise, unit),
                          {amount(misfit, unit), if_known(ratio, number(ratio, 2) + " × noise")},
                          {share_words(course.loop),
                           course.play > 0.0 ? "play or lag, " + amount(course.play, "m") : ""},
                          {share_words(course.relaxation),
                           timed ? "in " + number(course.hold_time, 3) + gap + "s" : ""}});
  }
  return table;
}

Table repeat_table(const Fit& fit) {
  Table table{heads({"Repeat", "Force\nover the fit's", "Standard error"})};
  for (const Repeats& group : fit.file.repeats)
    for (std::size_t i = 0; i < std::min(group.curves.size(), group.factors.size()); ++i) {
      const double error =
          i < group.factor_errors.size() ? group.factor_errors[i] : meshes::unknown;
      table.rows.push_back(
          {group.curves[i], number(group.factors[i]), if_known(error, "± " + number(error, 2))});
    }
  return table;
}

Figure scatter_figure(const Repeats& group, const std::string& name) {
  Figure figure{name, 860, 480, 1, {}};
  const std::size_t points = group.travel.size();
  if (points == 0 || group.mean.size() != points || group.scatter.size() != points) return figure;
  const ShownUnit &length = shown_units().length, &force = shown_units().force;
  const auto line = [&](const char* label, const char* key, const Style& style,
                        const std::vector<double>& values) {
    Series series{label, key, style};
    for (std::size_t i = 0; i < points; ++i) series.add(length(group.travel[i]), force(values[i]));
    return series;
  };
  Series band{"± one deviation", "band", {"#0072B2", "", 1.0}};
  band.filled = true;
  for (std::size_t i = 0; i < points; ++i)
    band.add(length(group.travel[i]), force(group.mean[i] + group.scatter[i]));
  for (std::size_t i = points; i-- > 0;)
    band.add(length(group.travel[i]), force(group.mean[i] - group.scatter[i]));
  Panel mean{
      .x_label = length.label("travel since touch"),
      .y_label = force.label("force"),
      .series = {band, line("mean of the repeats", "mean", {"#0072B2", "", 1.6}, group.mean)}};
  Panel scatter{
      .x_label = mean.x_label,
      .y_label = force.label("deviation"),
      .series = {line("between repeats", "scatter", {"#D55E00", "", 1.6}, group.scatter)}};
  if (group.noise.size() == points && std::isfinite(group.noise.front()))
    scatter.series.push_back(
        line("noise of a row", "noise", {"#555555", "(6,4)", 1.4}, group.noise));
  figure.panels = {mean, scatter};
  return figure;
}

/// Force over time in the longest hold of every file that has one.
Figure hold_figure(const Fit& fit, const std::string& name) {
  const ShownUnit& force = shown_units().force;
  Panel panel{.x_label = "time since the end of the loading [s]",
              .y_label = force.label("force"),
              .key = "top right"};
  for (const FitCurve& curve : fit.curves) {
    if (!curve.entry.course || curve.entry.course->held_time.empty()) continue;
    Series series{curve.name, curve.name, numbered_style(panel.series.size()),
                  curve.entry.course->held_time};
    for (const double value : curve.entry.course->held_y) series.y.push_back(force(value));
    panel.series.push_back(std::move(series));
  }
  Figure figure{name, 760, 400, 1, {}};
  if (!panel.series.empty()) figure.panels = {panel};
  return figure;
}

/// Largest |factor - 1|.
double widest(const Repeats& group) {
  double most = 0.0;
  for (const double factor : group.factors) most = std::fmax(most, std::abs(factor - 1.0));
  return most;
}

Chapter measured_chapter(const Fit& fit, const std::string& prefix) {
  ChapterData chapter("fit_measured");
  chapter.id = prefix + "-measured";
  chapter["name"] = fit.name;
  chapter["travel"] = fit.file.rig.has_value();
  chapter.tables["files"] = file_table(fit);
  chapter.tables["repeats"] = repeat_table(fit);
  WordList groups;
  for (const Repeats& group : fit.file.repeats) {
    TemplateData& words = groups.emplace_back();
    const std::string name = fmt::format("{}_repeats{}", prefix, groups.size());
    words["curves"] = enumerate(group.curves);
    words["scatter"] = "up to " + percent_magnitude(widest(group));
    words["deviation"] = group.deviation > 0.0 ? percent_magnitude(group.deviation) : "";
    words["probability"] = number(group.probability, 2);
    words["figure"] = name;
    chapter.figures.push_back(scatter_figure(group, name));
  }
  chapter["groups"] = std::move(groups);
  Figure held = hold_figure(fit, prefix + "_hold");
  chapter["hold"] = held.panels.empty() ? "" : held.name;
  if (!held.panels.empty()) chapter.figures.push_back(std::move(held));
  return written(std::move(chapter));
}

bool is_assumed(const RigEntry& entry) {
  return entry.given == false;
}

/// Where the value of a quantity is from.
Cell origin_cell(const RigEntry& entry) {
  if (entry.fitted) return is_assumed(entry) ? Cell("fitted", "nobody has told it") : "fitted";
  if (!entry.given) return "held";
  return *entry.given ? Cell("given") : Cell("assumed", "default, not measured");
}

Table rig_table(const Fit& fit) {
  if (!fit.file.rig) return {};
  Table table{heads({"Quantity\nfile or machine", "Value", "95 % interval", ""})};
  const auto add = [&](const char* title, const char* unit, const std::vector<RigEntry>& entries) {
    for (const RigEntry& entry : entries)
      table.rows.push_back(
          {{title, entry.of},
           amount(entry.value, unit),
           entry.fitted ? amount(entry.lower, unit) + " … " + amount(entry.upper, unit) : "–",
           origin_cell(entry)});
  };
  add("Travel at touch", "m", fit.file.rig->touch_offset);
  add("Compliance", "m/N", fit.file.rig->compliance);
  add("Zero of the load cell", "N", fit.file.rig->force_offset);
  add("Its drift", "N/s", fit.file.rig->drift);
  return table;
}

Table suspect_table(const Fit& fit) {
  Table table{heads({"Suspect", "Chi-square\nwould fall by", "Probability", "It would be",
                     "Usual cause and remedy"})};
  table.header.back().words = true;
  for (const ScoreTest& each : fit.file.lack_of_fit)
    table.rows.push_back({{each.name, each.of},
                          number(each.decrease, 3),
                          number(each.probability, 2),
                          amount_of(each.amount, each.unit, 3),
                          prose(each.cause)});
  return table;
}

/// What errors of sizes and place would make of the estimates.
Table sensitivity_table(const Fit& fit) {
  Table table{heads({"Were it larger", "by", "Parameter", "would be", ""})};
  for (const auto& each : fit.file.sensitivities)
    for (const auto& [parameter, change] : each.changes) {
      const auto own =
          std::ranges::find(fit.file.parameters, parameter, &calibration::ParameterEntry::name);
      if (own == fit.file.parameters.end()) continue;
      table.rows.push_back({each.name, amount_of(each.step, each.unit, 3), parameter,
                            fmt::format("{:+.2g} %", 100.0 * change / own->estimate),
                            each.counts ? "in the intervals" : "not in the intervals"});
    }
  return table;
}

Chapter rig_chapter(const Fit& fit, const std::string& prefix) {
  constexpr double improbable = 1e-3;
  const auto& suspects = fit.file.lack_of_fit;
  ChapterData chapter("fit_rig");
  chapter.id = prefix + "-machine";
  if (!fit.file.rig && suspects.empty() && fit.file.next.empty()) return {chapter.id, "", {}};
  chapter["name"] = fit.name;
  chapter["soft"] = fit.file.rig.has_value();
  chapter["assumed"] = fit.file.rig && std::ranges::any_of(fit.file.rig->compliance, is_assumed);
  chapter["accused"] = std::ranges::any_of(
      suspects, [](const ScoreTest& each) { return each.probability < improbable; });
  chapter.tables["rig"] = rig_table(fit);
  chapter.tables["suspects"] = suspect_table(fit);
  chapter.tables["sensitivities"] = sensitivity_table(fit);
  std::map<std::string, std::string> units;
  for (const auto& parameter : fit.file.parameters) units[parameter.name] = parameter.unit;
  chapter.tables["next"] = next_table(fit.file.next, units);
  return written(std::move(chapter));
}

}  // namespace

Table next_table(const std::vector<calibration::NextEntry>& next,
                 const std::map<std::string, std::string>& units) {
  Table table{heads({"Further press", "Parameter", "95 % interval then", "Narrower\ntimes"})};
  for (const calibration::NextEntry& further : next) {
    Cell name{further.name, as_shown(further.press)};
    if (!further.failure.empty()) table.rows.push_back({name, "–", prose(further.failure), "–"});
    for (const calibration::NarrowedEntry& each : further.parameters) {
      const auto own = units.find(each.name);
      const std::string unit = own == units.end() ? "" : own->second;
      table.rows.push_back({std::exchange(name, Cell()), each.name,
                            amount_of(each.lower, unit) + " … " + amount_of(each.upper, unit),
                            number(each.times, 3)});
    }
  }
  return table;
}

std::vector<Chapter> measured_chapters(const Fit& fit, const std::string& prefix) {
  std::vector<Chapter> chapters;
  if (!fit.file.repeats.empty() || any_course(fit))
    chapters.push_back(measured_chapter(fit, prefix));
  chapters.push_back(rig_chapter(fit, prefix));
  return chapters;
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
