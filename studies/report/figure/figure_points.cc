#include "studies/report/figure/figure_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <sstream>

#include "meshes/tables/table_rows.h"
#include "studies/report/figure/surface_script.h"

namespace fingertip::studies::report::inline figure {
namespace {

namespace fs = std::filesystem;
using nlohmann::ordered_json;

/// Where gnuplot put the axes of a panel, and what they show.
struct Axes {
  double left, right, bottom, top;  ///< [px], upward
  std::array<double, 2> x, y;
};

std::vector<Axes> axes_in(const std::string& log) {
  std::vector<Axes> all;
  std::istringstream lines(log);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    Axes a{};
    if (words >> first >> a.left >> a.right >> a.bottom >> a.top >> a.x[0] >> a.x[1] >> a.y[0] >>
            a.y[1] &&
        first == "axes")
      all.push_back(a);
  }
  return all;
}

/// As many digits as a reader can use; null where there is no number.
ordered_json short_numbers(const std::vector<double>& values) {
  ordered_json list = ordered_json::array();
  for (const double value : values)
    list.push_back(std::isfinite(value) ? ordered_json(std::stod(fmt::format("{:.5g}", value)))
                                        : ordered_json());
  return list;
}

/// The series that gnuplot draws, with the ids that it gives them: a number per item of the plot,
/// and a letter per panel where there are several.
ordered_json series_of(const Figure& figure, std::size_t index) {
  const Panel& panel = figure.panels[index];
  const std::string letter = figure.panels.size() > 1 ? std::string(1, char('a' + index)) : "";
  ordered_json all = ordered_json::array();
  int item = panel.map ? 1 : 0;
  const auto next_id = [&] { return fmt::format("{}_plot_{}{}", figure.name, ++item, letter); };
  for (const Series& series : panel.series) {
    if (!series.legend_only && !visible(panel, series)) continue;
    ordered_json ids = {next_id()};
    if (!series.line_x.empty()) ids.push_back(next_id());
    if (!series.error.empty()) ids.push_back(next_id());
    const std::string& name = series.label.empty() ? series.key : series.label;
    all.push_back({{"label", name},
                   {"curves", ids},
                   {"shift", series.shift},
                   {"x", short_numbers(series.x)},
                   {"y", short_numbers(series.y)}});
  }
  return all;
}

}  // namespace

bool visible(const Panel& panel, const Series& series) {
  for (std::size_t i = 0; i < series.x.size(); ++i) {
    const bool shown = std::isfinite(series.x[i]) && std::isfinite(series.y[i]) &&
                       (panel.log_x == 0 || series.shift * series.x[i] > 0.0) &&
                       (panel.log_y == 0 || series.y[i] > 0.0);
    if (shown) return true;
  }
  return false;
}

void write_points(const Figure& figure, const fs::path& file) {
  std::vector<std::string> labels;
  const auto column = [&](const std::string& label) {
    const auto found = std::find(labels.begin(), labels.end(), label);
    if (found != labels.end()) return std::size_t(found - labels.begin());
    labels.push_back(label);
    return labels.size() - 1;
  };
  for (const Panel& panel : figure.panels) {
    column(panel.x_label), column(panel.y_label);
    if (panel.surface) column(panel.surface->z_label), column(panel.surface->value_label);
    if (panel.map) column(panel.map->label);
    if (panel.coloured_arrows) column(panel.coloured_arrows->label);
  }
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "panel,series";
    for (const std::string& label : labels) out << ',' << meshes::csv_cell(label);
    out << '\n';
    using Value = std::pair<std::string, double>;
    const auto write = [&](const Panel& panel, const std::string& series,
                           std::initializer_list<Value> values) {
      std::vector<std::string> cells(labels.size());
      for (const auto& [label, value] : values) cells[column(label)] = meshes::to_text(value);
      out << meshes::csv_cell(panel.title) << ',' << meshes::csv_cell(series);
      for (const std::string& cell : cells) out << ',' << cell;
      out << '\n';
    };
    for (const Panel& panel : figure.panels) {
      for (const Series& series : panel.series) {
        for (std::size_t i = 0; i < series.x.size(); ++i)
          write(panel, series.key.empty() ? series.label : series.key,
                {{panel.x_label, series.x[i]}, {panel.y_label, series.y[i]}});
      }
      if (panel.map) {
        const GridFunction& f = panel.map->function;
        for (std::size_t i = 0; i < f.x.size(); ++i)
          for (std::size_t j = 0; j < f.y.size(); ++j)
            if (std::isfinite(f.values[i][j]))
              write(panel, panel.title,
                    {{panel.x_label, f.x[i]},
                     {panel.y_label, f.y[j]},
                     {panel.map->label, f.values[i][j]}});
      }
      if (panel.coloured_arrows) {  // from where to where
        const ColouredArrows& drawn = *panel.coloured_arrows;
        for (std::size_t i = 0; i < drawn.arrows.size(); ++i) {
          const Arrow& arrow = drawn.arrows[i];
          write(panel, "from",
                {{panel.x_label, arrow.x1},
                 {panel.y_label, arrow.y1},
                 {drawn.label, drawn.values[i]}});
          write(panel, "to", {{panel.x_label, arrow.x2}, {panel.y_label, arrow.y2}});
        }
      }
      if (!panel.surface) continue;
      for (const auto& row : panel.surface->rows) {
        for (const Surface::Point& point : row)
          write(panel, panel.title,
                {{panel.x_label, point.x},
                 {panel.y_label, point.y},
                 {panel.surface->z_label, point.z},
                 {panel.surface->value_label, point.value}});
      }
    }
  });
}

std::string page_points(const Figure& figure, const std::string& log) {
  const std::vector<Axes> axes = axes_in(log);
  ordered_json panels = ordered_json::array();
  for (std::size_t i = 0; i < std::min(axes.size(), figure.panels.size()); ++i) {
    const Panel& panel = figure.panels[i];
    if (panel.bare) continue;
    const Axes& a = axes[i];
    const ordered_json box = {a.left, a.right, figure.height - a.top, figure.height - a.bottom};
    if (panel.surface) {
      panels.push_back(
          {{"title", panel.title}, {"box", box}, {"colour_scale", colour_scale_at(figure)}});
      panels.back().update(turning_surface(panel, a.right - a.left));
      continue;
    }
    panels.push_back({{"x_label", panel.x_label},
                      {"y_label", panel.y_label},
                      {"box", box},
                      {"x", {a.x[0], a.x[1], panel.log_x != 0}},
                      {"y", {a.y[0], a.y[1], panel.log_y != 0}},
                      {"series", series_of(figure, i)}});
  }
  if (panels.empty()) return "";
  // "</script>" in a label would end the element; \u003c is the same to JSON.
  std::string text;
  // Names of folders need not be UTF-8.
  for (const char c : panels.dump(-1, ' ', false, ordered_json::error_handler_t::replace))
    text += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return text;
}

}  // namespace fingertip::studies::report::inline figure
