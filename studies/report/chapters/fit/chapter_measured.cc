/// What files of presses tell besides the curve that is fitted: noise, loop, holds, repeats, the
/// machine, and what is like the misfit.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/chapters/fit/calibration_figures.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

using calibration::LoadingHistory;
using calibration::Repeats;
using calibration::RigEntry;
using calibration::ScoreTest;

/// With its sign where it is negative: a force that rises in a hold.
std::string share_words(double share) {
  return share < 0.0 ? percent(share) : percent_magnitude(share);
}

/// A way back above the loading is the machine's.
Cell loop_cell(const LoadingHistory& course) {
  return plain(share_words(course.loop),
               course.play > 0.0 ? "play or lag, " + amount(course.play, "m") : "");
}

/// Root mean square of measured less fitted.
double misfit_of(const FitCurve& curve) {
  double sum = 0.0;
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    sum += std::pow(curve.measured[i] - curve.fitted[i], 2);
  return curve.x.empty() ? meshes::unknown : std::sqrt(sum / double(curve.x.size()));
}

Table file_table(const Fit& fit) {
  Table table;
  const bool any =
      std::ranges::any_of(fit.curves, [](const FitCurve& c) { return c.course.has_value(); });
  if (!any) return table;
  table.header = {plain("File"),   plain("Rows"), plain("Points", "fitted"), plain("Noise"),
                  plain("Misfit"), plain("Loop"), plain("Relaxation")};
  for (const FitCurve& curve : fit.curves) {
    const LoadingHistory course = curve.course.value_or(LoadingHistory());
    const std::string unit = curve.y_quantity.si_unit;
    const double misfit = misfit_of(curve), noise = course.noise_of_value(), ratio = misfit / noise;
    const auto shown = [&](double value) {
      return std::isfinite(value) ? amount(value, unit) : std::string("–");
    };
    const bool timed = course.hold_time > 0.0;
    table.rows.push_back(
        {plain(curve.name, curve.condition), plain(count(double(course.rows))),
         plain(count(double(curve.x.size()))), plain(shown(noise)),
         plain(shown(misfit), std::isfinite(ratio) ? number(ratio, 2) + " × noise" : ""),
         loop_cell(course),
         plain(share_words(course.relaxation),
               timed ? "in " + number(course.hold_time, 3) + gap + "s" : "")});
  }
  return table;
}

Table repeat_table(const Fit& fit) {
  Table table;
  for (const Repeats& group : fit.file.repeats)
    for (std::size_t i = 0; i < std::min(group.curves.size(), group.factors.size()); ++i) {
      const double error =
          i < group.factor_errors.size() ? group.factor_errors[i] : meshes::unknown;
      table.rows.push_back({plain(group.curves[i]), plain(number(group.factors[i])),
                            plain(if_known(error, "± " + number(error, 2)))});
    }
  if (!table.rows.empty())
    table.header = {plain("Repeat"), plain("Force", "over the fit's"), plain("Standard error")};
  return table;
}

std::vector<double> in_unit(std::vector<double> values, double factor) {
  for (double& value : values) value *= factor;
  return values;
}

Figure scatter_figure(const Repeats& group, const std::string& name) {
  Figure figure{name, 860, 480, 1, {}};
  const std::size_t points = group.travel.size();
  if (points == 0 || group.mean.size() != points || group.scatter.size() != points) return figure;
  const ShownUnit &length = shown_units().length, &force = shown_units().force;
  Panel mean, scatter;
  mean.x_label = scatter.x_label = length.label("travel since touch");
  mean.y_label = force.label("force");
  scatter.y_label = force.label("deviation");
  Series band{"± one deviation", "band", {}, {}, {}, {"#0072B2", "", 1.0, 0, true}};
  band.filled = true;
  for (std::size_t i = 0; i < points; ++i) {
    band.x.push_back(length(group.travel[i]));
    band.y.push_back(force(group.mean[i] + group.scatter[i]));
  }
  for (std::size_t i = points; i-- > 0;) {
    band.x.push_back(length(group.travel[i]));
    band.y.push_back(force(group.mean[i] - group.scatter[i]));
  }
  const std::vector<double> x = in_unit(group.travel, length.factor);
  mean.series = {band,
                 {"mean of the repeats",
                  "mean",
                  x,
                  in_unit(group.mean, force.factor),
                  {},
                  {"#0072B2", "", 1.6, 0, true}}};
  scatter.series = {{"between repeats",
                     "scatter",
                     x,
                     in_unit(group.scatter, force.factor),
                     {},
                     {"#D55E00", "", 1.6, 0, true}}};
  if (group.noise.size() == points && std::isfinite(group.noise.front()))
    scatter.series.push_back({"noise of a row",
                              "noise",
                              x,
                              in_unit(group.noise, force.factor),
                              {},
                              {"#555555", "(6,4)", 1.4, 0, true}});
  figure.panels = {mean, scatter};
  return figure;
}

/// Force over time in the longest hold of every file that has one.
Figure hold_figure(const Fit& fit, const std::string& name) {
  Figure figure{name, 760, 400, 1, {}};
  Panel panel;
  panel.x_label = "time since the end of the loading [s]";
  panel.key = "top right";
  for (const FitCurve& curve : fit.curves) {
    if (!curve.course || curve.course->held_time.empty()) continue;
    panel.y_label = shown_units().force.label("force");
    panel.series.push_back({curve.name,
                            curve.name,
                            curve.course->held_time,
                            in_unit(curve.course->held_y, shown_units().force.factor),
                            {},
                            numbered_style(panel.series.size())});
  }
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
    Words& words = groups.emplace_back();
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
  return !entry.fitted && entry.given == false;
}

/// Where the value of a quantity is from; runs of earlier versions do not tell who held it.
Cell origin_cell(const RigEntry& entry) {
  if (entry.fitted) return plain("fitted");
  if (!entry.given) return plain("held");
  return *entry.given ? plain("given") : plain("assumed", "default, not measured");
}

/// A quantity of a machine, per file or machine.
void add_rig_rows(Table& table, const char* title, const std::string& unit,
                  const std::vector<RigEntry>& entries) {
  for (const RigEntry& entry : entries) {
    const auto shown = [&](double value) {
      return std::isfinite(value) ? amount(value, unit) : std::string("–");
    };
    table.rows.push_back(
        {plain(title, entry.of), plain(shown(entry.value)),
         plain(entry.fitted ? shown(entry.lower) + " … " + shown(entry.upper) : "–"),
         origin_cell(entry)});
  }
}

Table rig_table(const Fit& fit) {
  Table table;
  if (!fit.file.rig) return table;
  const calibration::RigFile& rig = *fit.file.rig;
  table.header = {plain("Quantity", "file or machine"), plain("Value"), plain("95 % interval"),
                  plain("")};
  add_rig_rows(table, "Travel at touch", "m", rig.touch_offset);
  add_rig_rows(table, "Compliance", "m/N", rig.compliance);
  add_rig_rows(table, "Zero of the load cell", "N", rig.force_offset);
  add_rig_rows(table, "Its drift", "N/s", rig.drift);
  return table;
}

Table suspect_table(const Fit& fit) {
  Table table;
  if (fit.file.lack_of_fit.empty()) return table;
  table.header = {plain("Suspect"), plain("Chi-square", "would fall by"), plain("Probability"),
                  plain("It would be"), plain("Usual cause and remedy")};
  table.header.back().words = true;
  for (const ScoreTest& each : fit.file.lack_of_fit) {
    Cell cause = plain(each.cause);
    cause.words = true;
    const std::string unit = each.unit == "1" ? "" : each.unit;
    table.rows.push_back({plain(each.name, each.of), plain(number(each.decrease, 3)),
                          plain(number(each.probability, 2)),
                          plain(unit.empty() ? number(each.amount, 3) : amount(each.amount, unit)),
                          cause});
  }
  return table;
}

/// What further presses would tell, the best one first.
Table next_table(const Fit& fit) {
  Table table;
  if (fit.file.next.empty()) return table;
  table.header = {plain("Further press"), plain("Parameter"), plain("95 % interval then"),
                  plain("Narrower", "times")};
  for (const calibration::NextEntry& further : fit.file.next) {
    if (!further.failure.empty()) {
      Cell failure = plain(further.failure);
      failure.words = true;
      table.rows.push_back(
          {plain(further.name, as_shown(further.press)), plain("–"), failure, plain("–")});
    }
    for (const calibration::NarrowedEntry& each : further.parameters) {
      std::string unit;
      for (const auto& parameter : fit.file.parameters)
        if (parameter.name == each.name) unit = parameter.unit;
      const auto shown = [&](double value) {
        if (!std::isfinite(value)) return std::string("–");
        return unit.empty() || unit == "1" ? number(value) : amount(value, unit);
      };
      table.rows.push_back({&each == &further.parameters.front()
                                ? plain(further.name, as_shown(further.press))
                                : plain(""),
                            plain(each.name), plain(shown(each.lower) + " … " + shown(each.upper)),
                            plain(number(each.times, 3))});
    }
  }
  return table;
}

Chapter rig_chapter(const Fit& fit, const std::string& prefix) {
  constexpr double improbable = 1e-3;
  const auto& suspects = fit.file.lack_of_fit;
  ChapterData chapter("fit_rig");
  chapter.id = prefix + "-machine";
  chapter["name"] = fit.name;
  chapter["soft"] = fit.file.rig.has_value();
  chapter["assumed"] = fit.file.rig && std::ranges::any_of(fit.file.rig->compliance, is_assumed);
  chapter["accused"] = std::ranges::any_of(
      suspects, [](const ScoreTest& each) { return each.probability < improbable; });
  chapter.tables["rig"] = rig_table(fit);
  chapter.tables["suspects"] = suspect_table(fit);
  chapter.tables["next"] = next_table(fit);
  if (!fit.file.rig && suspects.empty() && fit.file.next.empty()) {
    Chapter none;
    none.id = chapter.id;
    return none;
  }
  return written(std::move(chapter));
}

}  // namespace

std::vector<Chapter> measured_chapters(const Fit& fit, const std::string& prefix) {
  const bool told =
      !fit.file.repeats.empty() ||
      std::ranges::any_of(fit.curves, [](const FitCurve& c) { return c.course.has_value(); });
  std::vector<Chapter> chapters;
  if (told) chapters.push_back(measured_chapter(fit, prefix));
  chapters.push_back(rig_chapter(fit, prefix));
  return chapters;
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
