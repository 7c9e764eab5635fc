/// Forces at speed beside the transient continuum, and presses beside one another.
#include <algorithm>
#include <cmath>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

bool has_reference(const MovingPress& press) {
  return !press.reference.empty() && !press.response.empty();
}

/// Relative differences at the samples of the continuum [%].
Series error_series(const MovingPress& press, const Style& style) {
  Series series{press.label, "", {}, {}, {}, style};
  for (const meshes::PressSample& sample : press.reference.pressing()) {
    series.x.push_back(shown_units().length(sample.indentation));
    series.y.push_back(100.0 *
                       (force_at(press.response, sample.indentation) / sample.normal_force - 1.0));
  }
  return series;
}

Series force_series(const meshes::PressResponse& response, const std::string& label,
                    const Style& style) {
  Series series{label, "", {}, {}, {}, style};
  for (const meshes::PressSample& sample : response.pressing()) {
    series.x.push_back(shown_units().length(sample.indentation));
    series.y.push_back(shown_units().force(sample.normal_force));
  }
  return series;
}

Figure force_figure(const std::vector<MovingPress>& presses) {
  Panel force, error;
  force.x_label = error.x_label = shown_units().length.label("indentation");
  force.y_label = shown_units().force.label("normal force");
  error.y_label = "force error [%]";
  error.key = "";  // the colours of the curves above
  error.y_range = Range{-1.5, 1.5};
  error.band = Band{-1.0, 1.0};
  std::size_t count = 0;
  for (const MovingPress& press : presses) {
    if (!has_reference(press)) continue;
    Style style = numbered_style(count++);
    Style points = style;
    points.line = false;
    force.series.push_back(force_series(press.reference, "continuum, " + press.label, points));
    Style line = style;
    line.point = 0;
    line.dash.clear();
    force.series.push_back(force_series(press.response, "lattice, " + press.label, line));
    error.series.push_back(error_series(press, style));
    for (const double off : error.series.back().y)
      error.y_range->to = std::fmax(error.y_range->to, 1.1 * std::abs(off));
    error.y_range->from = -error.y_range->to;
    const double depth = shown_units().length(press.reference.depth());
    if (!force.x_range || force.x_range->to < depth) force.x_range = Range{0.0, 1.02 * depth};
  }
  error.x_range = force.x_range;
  return {"force_at_speed", 860, 720, 1, {force, error}};
}

Table error_table(const std::vector<MovingPress>& presses) {
  Table table;
  table.graded = true;
  table.header = {plain("Press")};
  for (const MovingPress& press : presses) {
    if (!has_reference(press)) continue;
    if (table.header.size() == 1)
      for (const meshes::PressSample& sample : press.reference.pressing())
        table.header.push_back(plain("F", shown_units().length.text(sample.indentation)));
    std::vector<Cell> row{plain(press.label)};
    for (const meshes::PressSample& sample : press.reference.pressing()) {
      const double f = force_at(press.response, sample.indentation);
      const double off = f / sample.normal_force - 1.0;
      row.push_back({number(shown_units().force(f)), percent(off), grade(off)});
    }
    row.resize(table.header.size());
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The presses that are compared with others, and by how much their forces differ at most.
Table change_table(const std::vector<MovingPress>& presses) {
  Table table;
  table.header = {plain("Press"), plain("compared with"), plain("Largest difference")};
  for (const MovingPress& press : presses) {
    if (press.beside.empty()) continue;
    table.rows.push_back(
        {plain(press.label), plain(press.beside), plain(percent_magnitude(press.change))});
  }
  return table;
}

}  // namespace

Chapter speed_chapter(const std::vector<MovingPress>& presses) {
  ChapterData chapter("speed");
  if (std::ranges::any_of(presses, has_reference)) {
    chapter.figures = {force_figure(presses)};
    chapter.tables["errors"] = error_table(presses);
  }
  chapter.tables["changes"] = change_table(presses);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
