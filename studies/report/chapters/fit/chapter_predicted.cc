/// Presses that were held back from a fit, beside what it foretells of them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/fit/calibration_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

using calibration::PredictedEntry;

std::string force_words(double value) {
  return amount(value, "N");
}

Table predicted_table(const Fit& fit) {
  Table table{heads({"Press held back", "Values", "Misfit\nrms", "Within the\n95 % interval",
                     "Largest force\nmeasured", "foretold", "95 % interval", "Verdict"}),
              true};
  for (const PredictedEntry& press : fit.file.predicted) {
    const Cell name{press.name, as_shown(press.condition)};
    if (press.foretold.empty()) {
      table.rows.push_back({name, "–", "–", "–", "–", "–", prose(press.failure), "not foretold"});
      continue;
    }
    const auto last =
        std::size_t(std::ranges::max_element(press.foretold) - press.foretold.begin());
    table.rows.push_back(
        {name,
         count(double(press.x.size())),
         magnitude_cell(press.rms_relative),
         percent_magnitude(press.within),
         force_words(press.measured[last]),
         force_words(press.foretold[last]),
         force_words(press.lower[last]) + " … " + force_words(press.upper[last]),
         {press.is_within() ? "inside" : "outside", "probability " + number(press.probability, 2),
          press.is_within() ? Grade::none : Grade::wrong}});
  }
  return table;
}

Table own_table(const Fit& fit) {
  Table table{heads({"Estimated from its own values", "Value"})};
  for (const PredictedEntry& press : fit.file.predicted)
    for (const calibration::EstimateEntry& each : press.own)
      table.rows.push_back({{each.name, press.name}, amount(each.estimate, each.unit)});
  return table;
}

/// Force over the press's own x, and what is left of it, each with the interval.
Figure predicted_figure(const PredictedEntry& press, const Quantity& x, const std::string& name) {
  const ShownUnit& force = shown_units().force;
  const std::size_t points = press.x.size();
  const auto band = [&](bool left) {
    Series series{"95 % interval", left ? "interval beneath" : "interval", {"#0072B2", "", 1.0}};
    series.filled = true;
    const auto add = [&](std::size_t i, const std::vector<double>& end) {
      series.add(x(press.x[i]), force(end[i] - (left ? press.foretold[i] : 0.0)));
    };
    for (std::size_t i = 0; i < points; ++i) add(i, press.upper);
    for (std::size_t i = points; i-- > 0;) add(i, press.lower);
    return series;
  };
  Series measured{"measured", "measured", {"#D55E00", "", 1.0, 7, false, 0.8}},
      foretold{"foretold", "foretold", {"#0072B2", "", 1.6}},
      left{"", "measured less foretold", {"#D55E00", "", 1.0, 7, false, 0.8}};
  for (std::size_t i = 0; i < points; ++i) {
    measured.add(x(press.x[i]), force(press.measured[i]));
    foretold.add(x(press.x[i]), force(press.foretold[i]));
    left.add(x(press.x[i]), force(press.measured[i] - press.foretold[i]));
  }
  Figure figure{name, 860, 420, 2, {}};
  Panel above{.title = press.name,
              .x_label = x.label(),
              .y_label = force.label("force"),
              .series = {band(false), foretold, measured}};
  Panel beside{.x_label = x.label(),
               .y_label = force.label("measured less foretold"),
               .series = {band(true), left},
               .key = ""};
  figure.panels = {above, beside};
  return figure;
}

}  // namespace

Chapter predicted_chapter(const Fit& fit, const std::string& prefix) {
  ChapterData chapter("fit_predicted");
  chapter.id = prefix + "-predicted";
  if (fit.file.predicted.empty()) return {chapter.id, "", {}};
  chapter["name"] = fit.name;
  WordList figures;
  for (const PredictedEntry& press : fit.file.predicted) {
    if (press.foretold.empty()) continue;
    const std::string name = fmt::format("{}_predicted{}", prefix, figures.size() + 1);
    figures.emplace_back()["figure"] = name;
    chapter.figures.push_back(predicted_figure(press, quantity(fit.file.x_quantity), name));
  }
  chapter["figures"] = std::move(figures);
  chapter["estimated"] = std::ranges::any_of(
      fit.file.predicted, [](const PredictedEntry& press) { return !press.own.empty(); });
  chapter["outside"] = std::ranges::any_of(fit.file.predicted, [](const PredictedEntry& press) {
    return press.failure.empty() && !press.is_within();
  });
  chapter.tables["predicted"] = predicted_table(fit);
  chapter.tables["own"] = own_table(fit);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
