#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "studies/report/chapters/models/variant_figures.h"

namespace fingertip::studies::report::inline chapters::inline models {

std::vector<VariantPress> presses_of(const std::vector<VariantRow>& table) {
  return grouped(table, [](const VariantRow& a, const VariantRow& b) {
    return a.series == b.series && a.name == b.name;
  });
}

double worst_error(const VariantPress& press) {
  return largest_of(press, &VariantRow::relative_error);
}

namespace {

constexpr int key_room = 215;
/// More curves than this are told apart by their shade alone.
constexpr std::size_t max_named = 9;

/// Up to four of the depths, the first and the last among them.
std::vector<double> shown_depths(const std::vector<VariantRow>& table) {
  std::set<double> all;
  for (const VariantRow& row : table) all.insert(row.indentation);
  const std::vector<double> depths(all.begin(), all.end());
  if (depths.size() <= 4) return depths;
  std::vector<double> shown;
  for (std::size_t i = 0; i < 4; ++i) shown.push_back(depths[i * (depths.size() - 1) / 3]);
  return shown;
}

std::vector<VariantPress> presses_in(const std::vector<VariantRow>& table,
                                     const std::string& series) {
  std::vector<VariantPress> own = presses_of(table);
  std::erase_if(own, [&](const VariantPress& press) { return press.front().series != series; });
  return own;
}

/// Errors at one depth over x; NaN where a press has no such sample.
Series error_curve(std::vector<VariantPress> presses, double depth) {
  std::erase_if(presses, [](const auto& press) { return !std::isfinite(press.front().x); });
  std::ranges::stable_sort(presses, {}, [](const auto& press) { return press.front().x; });
  return curve(
      "", "", {}, presses, [](const auto& press) { return press.front().x; },
      [&](const auto& press) {
        const auto row = std::ranges::find(press, depth, &VariantRow::indentation);
        return row == press.end() ? meshes::unknown : 100.0 * row->relative_error;
      });
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
template <class Value>
void add_presses(Panel& panel, const std::vector<VariantPress>& presses, const Value& value) {
  const std::size_t count = presses.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = presses[i].front().name;
    Style style = numbered_style(i);
    style.width = 1.6;
    if (count > max_named) style.colour = depth_shade(i, count);
    panel.series.push_back(curve(count > max_named ? "" : name, name, style, presses[i],
                                 in(shown_units().length, &VariantRow::indentation), value));
  }
}

const Style continuum_style{"#000000", "(2,3)", 1.4};

void add_continua(Panel& panel, const std::vector<VariantPress>& presses) {
  std::set<std::string> drawn;
  for (const VariantPress& press : presses) {
    const std::string& name = press.front().continuum;
    if (drawn.insert(name).second)
      panel.series.push_back(curve(drawn.size() > 1 ? "" : "continuum", name, continuum_style,
                                   press, in(shown_units().length, &VariantRow::indentation),
                                   in(shown_units().force, &VariantRow::reference_force)));
  }
}

/// From zero to above the curves, lest they run through the legend.
Range with_room_for_legend(const Panel& panel) {
  const auto labels = std::ranges::count_if(
      panel.series, [](const Series& series) { return !series.label.empty(); });
  const double most = extent_of(panel.series, &Series::y).to;
  return {0.0, std::fmax(most, 1e-3) * (1.1 + 0.06 * double(labels))};
}

/// The curves of a series of programs.
void add_later(const std::vector<LaterRow>& table, const std::string& series, Panel& force,
               Panel& distance) {
  const ShownUnit& unit = shown_units().force;
  std::vector<LaterRow> own = table;
  std::erase_if(own, [&](const LaterRow& row) { return row.series != series; });
  std::set<std::string> continua;
  for (const std::string& name : distinct(own, &LaterRow::name)) {
    std::vector<LaterRow> rows = own;
    std::erase_if(rows, [&](const LaterRow& row) { return row.name != name; });
    const std::string& continuum = rows.front().continuum;
    const std::string label = continua.empty() ? "continuum" : "";
    if (continua.insert(continuum).second)
      force.series.push_back(curve(label, continuum, continuum_style, rows, &LaterRow::time,
                                   in(unit, &LaterRow::reference_force)));
    const Style style = numbered_style(distance.series.size());
    force.series.push_back(
        curve(name, name, style, rows, &LaterRow::time, in(unit, &LaterRow::normal_force)));
    distance.series.push_back(
        curve(name, name, style, rows, &LaterRow::time, in_percent(&LaterRow::error)));
  }
}

}  // namespace

Figure variant_error_figure(const std::vector<VariantRow>& table, const std::string& x_label) {
  Figure figure{"variants_error", 860, 430, 1, {}};
  const std::vector<std::string> series = distinct(table, &VariantRow::series);
  for (const double depth : shown_depths(table)) {
    Panel panel{.title = "at " + shown_units().length.text(depth),
                .x_label = x_label,
                .y_label = "force error [%]",
                .band = Band{-1.0, 1.0},
                .key = ""};
    for (std::size_t i = 0; i < series.size(); ++i) {
      Series curve = error_curve(presses_in(table, series[i]), depth);
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

Figure convergence_figure(const std::vector<VariantRow>& table, const StudyEntry& study) {
  Panel panel{.x_label = shown_units().length.label("spacing a"),
              .y_label = "largest force error [%]",
              .log_x = 10,
              .log_y = 10,
              .key = "outside right top"};
  for (const SeriesEntry& entry : study.series) {
    if (!std::isfinite(entry.order)) continue;
    Series curve{fmt::format("{}: order {}", entry.name, number(entry.order, 2)), entry.name,
                 numbered_style(panel.series.size())};
    for (const VariantPress& press : presses_in(table, entry.name))
      if (const double worst = worst_error(press); std::isfinite(worst))
        curve.add(shown_units().length(press.front().spacing), 100.0 * worst);
    panel.series.push_back(std::move(curve));
  }
  Figure figure{"variants_convergence", 760, 440, 1, {}};
  if (!panel.series.empty()) figure.panels = {panel};
  return figure;
}

Figure variant_force_figure(const std::vector<VariantRow>& table) {
  Figure figure{"variants_force", 860, 430, 1, {}};
  for (const std::string& series : distinct(table, &VariantRow::series)) {
    const std::vector<VariantPress> own = presses_in(table, series);
    Panel panel = over_indentation(shown_units().force.label("normal force"));
    panel.title = series;
    add_continua(panel, own);
    add_presses(panel, own, in(shown_units().force, &VariantRow::normal_force));
    panel.y_range = with_room_for_legend(panel);
    figure.panels.push_back(std::move(panel));
  }
  lay_out(figure);
  return figure;
}

std::vector<Figure> variant_later_figures(const std::vector<LaterRow>& table) {
  std::vector<Figure> figures;
  for (const std::string& series : distinct(table, &LaterRow::series)) {
    Panel force{.x_label = "time [s]",
                .y_label = shown_units().force.label("normal force"),
                .key = "outside right top"};
    Panel distance{.x_label = "time [s]",
                   .y_label = "error over largest force [%]",
                   .band = Band{-1.0, 1.0},
                   .key = ""};
    add_later(table, series, force, distance);
    figures.push_back({fmt::format("variants_later_{}", figures.size() + 1),
                       860,
                       640,
                       1,
                       {std::move(force), std::move(distance)}});
  }
  return figures;
}

std::vector<Figure> variant_depth_figures(const std::vector<VariantRow>& table) {
  std::vector<Figure> figures;
  for (const std::string& series : distinct(table, &VariantRow::series)) {
    Panel panel = over_indentation("force error [%]", "outside right top");
    panel.band = Band{-1.0, 1.0};
    add_presses(panel, presses_in(table, series), in_percent(&VariantRow::relative_error));
    figures.push_back({fmt::format("variants_depth_{}", figures.size() + 1), 860, 330, 1, {panel}});
  }
  return figures;
}

}  // namespace fingertip::studies::report::inline chapters::inline models
