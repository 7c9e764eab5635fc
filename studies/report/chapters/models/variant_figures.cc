#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "studies/report/chapters/models/variant_figures.h"

namespace fingertip::studies::report::inline chapters::inline models {

std::vector<VariantPress> read_variants(const std::vector<VariantRow>& table) {
  std::vector<VariantPress> presses;
  for (const VariantRow& row : table) {
    const bool next =
        presses.empty() || presses.back().series != row.series || presses.back().name != row.name;
    if (next)
      presses.push_back({row.series,
                         row.name,
                         row.model,
                         row.continuum,
                         row.status,
                         row.x,
                         row.spacing,
                         row.volume_defect,
                         row.wall_time,
                         {},
                         {},
                         {},
                         {}});
    presses.back().depth.push_back(row.indentation);
    presses.back().force.push_back(row.normal_force);
    presses.back().reference.push_back(row.reference_force);
    presses.back().error.push_back(row.relative_error);
  }
  return presses;
}

namespace {

template <typename Row>
std::vector<std::string> found_series(const std::vector<Row>& rows) {
  std::vector<std::string> names;
  for (const Row& row : rows)
    if (std::ranges::find(names, row.series) == names.end()) names.push_back(row.series);
  return names;
}

}  // namespace

std::vector<std::string> series_of(const std::vector<VariantPress>& presses) {
  return found_series(presses);
}

std::vector<std::string> series_of(const std::vector<LaterRow>& table) {
  return found_series(table);
}

namespace {

constexpr int key_room = 215;
/// More curves than this are told apart by their shade alone.
constexpr std::size_t most_named = 9;

/// Up to four of the depths, the first and the last among them.
std::vector<double> shown_depths(const std::vector<VariantPress>& presses) {
  std::set<double> all;
  for (const VariantPress& press : presses) all.insert(press.depth.begin(), press.depth.end());
  const std::vector<double> depths(all.begin(), all.end());
  if (depths.size() <= 4) return depths;
  std::vector<double> shown;
  for (std::size_t i = 0; i < 4; ++i) shown.push_back(depths[i * (depths.size() - 1) / 3]);
  return shown;
}

/// The value at one depth; NaN when the press has no such sample.
double at_depth(const VariantPress& press, const std::vector<double>& values, double depth) {
  for (std::size_t i = 0; i < press.depth.size(); ++i)
    if (press.depth[i] == depth) return values[i];
  return meshes::unknown;
}

Series error_curve(const std::vector<VariantPress>& presses, const std::string& series,
                   double depth) {
  std::vector<const VariantPress*> found;
  for (const VariantPress& press : presses)
    if (press.series == series && std::isfinite(press.x)) found.push_back(&press);
  std::ranges::stable_sort(found, {}, &VariantPress::x);
  Series curve;
  for (const VariantPress* press : found) {
    curve.x.push_back(press->x);
    curve.y.push_back(100.0 * at_depth(*press, press->error, depth));
  }
  return curve;
}

/// Panels in one or two columns.
void lay_out(Figure& figure) {
  const std::size_t count = figure.panels.size();
  figure.columns = count > 1 ? 2 : 1;
  const int rows = int((count + 1) / 2);
  figure.width = 860;
  figure.height = count > 1 ? 60 + 270 * rows : 430;
}

/// The curves of a series' presses, coarse or early ones pale.
void add_presses(Panel& panel, const std::vector<VariantPress>& presses, bool errors) {
  const std::size_t count = presses.size();
  for (std::size_t i = 0; i < count; ++i) {
    const VariantPress& press = presses[i];
    Series curve{count > most_named ? "" : press.name, press.name, {}, {}, {}, {}};
    curve.style = numbered_style(i);
    curve.style.width = 1.6;
    if (count > most_named) curve.style.colour = depth_shade(i, count);
    for (std::size_t d = 0; d < press.depth.size(); ++d) {
      curve.x.push_back(shown_units().length(press.depth[d]));
      curve.y.push_back(errors ? 100.0 * press.error[d] : shown_units().force(press.force[d]));
    }
    panel.series.push_back(std::move(curve));
  }
}

void add_continua(Panel& panel, const std::vector<VariantPress>& presses) {
  std::set<std::string> drawn;
  for (const VariantPress& press : presses) {
    if (!drawn.insert(press.continuum).second) continue;
    Series curve{drawn.size() > 1 ? "" : "continuum", press.continuum, {}, {}, {}, {}};
    curve.style = {"#000000", "(2,3)", 1.4, 0, true};
    for (std::size_t d = 0; d < press.depth.size(); ++d) {
      curve.x.push_back(shown_units().length(press.depth[d]));
      curve.y.push_back(shown_units().force(press.reference[d]));
    }
    panel.series.push_back(std::move(curve));
  }
}

/// From zero to above the curves, lest they run through the legend.
Range with_room_for_legend(const Panel& panel) {
  double most = 0.0;
  std::size_t labels = 0;
  for (const Series& series : panel.series) {
    if (!series.label.empty()) ++labels;
    for (const double y : series.y) most = std::fmax(most, y);
  }
  return {0.0, std::fmax(most, 1e-3) * (1.1 + 0.06 * double(labels))};
}

/// The curves of a series of programs.
void add_later(const std::vector<LaterRow>& table, const std::string& series, Panel& force,
               Panel& distance) {
  std::vector<std::string> presses;
  std::set<std::string> continua;
  for (const LaterRow& row : table) {
    if (row.series != series || std::ranges::find(presses, row.name) != presses.end()) continue;
    presses.push_back(row.name);
    const Style style = numbered_style(presses.size() - 1);
    Series pressed{row.name, row.name, {}, {}, {}, style}, error = pressed;
    Series wanted{continua.empty() ? "continuum" : "", row.continuum, {}, {}, {}, {}};
    wanted.style = {"#000000", "(2,3)", 1.4, 0, true};
    for (const LaterRow& own : table) {
      if (own.series != series || own.name != row.name) continue;
      for (Series* curve : {&pressed, &error, &wanted}) curve->x.push_back(own.time);
      pressed.y.push_back(shown_units().force(own.normal_force));
      wanted.y.push_back(shown_units().force(own.reference_force));
      error.y.push_back(100.0 * own.error);
    }
    if (continua.insert(row.continuum).second) force.series.push_back(std::move(wanted));
    force.series.push_back(std::move(pressed));
    distance.series.push_back(std::move(error));
  }
}

std::vector<VariantPress> presses_of(const std::vector<VariantPress>& presses,
                                     const std::string& series) {
  std::vector<VariantPress> own;
  std::ranges::copy_if(presses, std::back_inserter(own),
                       [&](const VariantPress& press) { return press.series == series; });
  return own;
}

}  // namespace

Figure variant_error_figure(const std::vector<VariantPress>& presses, const std::string& x_label) {
  Figure figure{"variants_error", 860, 430, 1, {}};
  const std::vector<std::string> series = series_of(presses);
  for (const double depth : shown_depths(presses)) {
    Panel panel;
    panel.title = "at " + shown_units().length.text(depth);
    panel.x_label = x_label;
    panel.y_label = "force error [%]";
    panel.band = Band{-1.0, 1.0};
    panel.key.clear();
    for (std::size_t i = 0; i < series.size(); ++i) {
      Series curve = error_curve(presses, series[i], depth);
      if (curve.x.empty()) continue;
      curve.label = curve.key = series[i].empty() ? "all presses" : series[i];
      curve.style = numbered_style(i);
      panel.series.push_back(std::move(curve));
    }
    if (!panel.series.empty()) figure.panels.push_back(std::move(panel));
  }
  if (figure.panels.empty()) return figure;
  lay_out(figure);
  if (figure.panels.front().series.size() > 1) {
    figure.right_margin = key_room;
    figure.width += key_room - 18;
    figure.panels.front().key = figure.beside_panels();
  }
  return figure;
}

Figure convergence_figure(const std::vector<VariantPress>& presses, const StudyEntry& study) {
  Figure figure{"variants_convergence", 760, 440, 1, {}};
  Panel panel;
  panel.x_label = shown_units().length.label("spacing a");
  panel.y_label = "largest force error [%]";
  panel.log_x = panel.log_y = 10;
  panel.key = "outside right top";
  std::size_t index = 0;
  for (const SeriesEntry& entry : study.series) {
    const double order = entry.order;
    const std::string name = entry.name;
    if (!std::isfinite(order)) continue;
    Series curve;
    curve.label = fmt::format("{}: order {}", name, number(order, 2));
    curve.key = name;
    curve.style = numbered_style(index++);
    for (const VariantPress& press : presses) {
      if (press.series != name || !std::isfinite(press.worst())) continue;
      curve.x.push_back(shown_units().length(press.spacing));
      curve.y.push_back(100.0 * press.worst());
    }
    panel.series.push_back(std::move(curve));
  }
  if (!panel.series.empty()) figure.panels = {panel};
  return figure;
}

Figure variant_force_figure(const std::vector<VariantPress>& presses) {
  Figure figure{"variants_force", 860, 430, 1, {}};
  for (const std::string& series : series_of(presses)) {
    const std::vector<VariantPress> own = presses_of(presses, series);
    Panel panel;
    panel.title = series;
    panel.x_label = shown_units().length.label("indentation");
    panel.y_label = shown_units().force.label("normal force");
    add_continua(panel, own);
    add_presses(panel, own, false);
    panel.y_range = with_room_for_legend(panel);
    figure.panels.push_back(std::move(panel));
  }
  lay_out(figure);
  return figure;
}

std::vector<Figure> variant_later_figures(const std::vector<LaterRow>& table) {
  std::vector<Figure> figures;
  for (const std::string& series : series_of(table)) {
    Panel force, distance;
    force.x_label = distance.x_label = "time [s]";
    force.y_label = shown_units().force.label("normal force");
    distance.y_label = "error over largest force [%]";
    force.key = "outside right top";
    distance.key.clear();
    distance.band = Band{-1.0, 1.0};
    add_later(table, series, force, distance);
    figures.push_back({fmt::format("variants_later_{}", figures.size() + 1),
                       860,
                       640,
                       1,
                       {std::move(force), std::move(distance)}});
  }
  return figures;
}

std::vector<Figure> variant_depth_figures(const std::vector<VariantPress>& presses) {
  std::vector<Figure> figures;
  for (const std::string& series : series_of(presses)) {
    Figure figure{fmt::format("variants_depth_{}", figures.size() + 1), 860, 330, 1, {}};
    Panel panel;
    panel.x_label = shown_units().length.label("indentation");
    panel.y_label = "force error [%]";
    panel.key = "outside right top";
    panel.band = Band{-1.0, 1.0};
    add_presses(panel, presses_of(presses, series), true);
    figure.panels = {panel};
    figures.push_back(std::move(figure));
  }
  return figures;
}

}  // namespace fingertip::studies::report::inline chapters::inline models
