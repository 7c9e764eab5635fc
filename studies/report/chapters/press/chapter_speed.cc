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

/// Relative difference at a sample of the continuum.
double error_at(const MovingPress& press, const meshes::PressSample& sample) {
  return force_at(press.response, sample.indentation) / sample.normal_force - 1.0;
}

Figure force_figure(const std::vector<MovingPress>& presses) {
  Panel force = over_indentation(shown_units().force.label("normal force"));
  Panel error = over_indentation("force error [%]", "");  // the colours of the curves above
  error.band = Band{-1.0, 1.0};
  double most = 1.5;
  std::size_t count = 0;
  for (const MovingPress& press : presses) {
    if (!has_reference(press)) continue;
    const Style style = numbered_style(count++);
    Style line = style.as_line();
    line.dash.clear();
    const auto samples = press.reference.pressing();
    force.series.push_back(
        force_curve("continuum, " + press.label, "", style.as_points(), samples));
    force.series.push_back(
        force_curve("lattice, " + press.label, "", line, press.response.pressing()));
    error.series.push_back(
        curve(press.label, "", style, samples,
              in(shown_units().length, &meshes::PressSample::indentation),
              [&](const meshes::PressSample& sample) { return 100.0 * error_at(press, sample); }));
    for (const double off : error.series.back().y) most = std::fmax(most, 1.1 * std::abs(off));
    const double depth = shown_units().length(press.reference.depth());
    if (!force.x_range || force.x_range->to < depth) force.x_range = Range{0.0, 1.02 * depth};
  }
  error.x_range = force.x_range;
  error.y_range = Range{-most, most};
  return {"force_at_speed", 860, 720, 1, {force, error}};
}

Table error_table(const std::vector<MovingPress>& presses) {
  Table table{{"Press"}, true};
  for (const MovingPress& press : presses) {
    if (!has_reference(press)) continue;
    if (table.header.size() == 1)
      for (const meshes::PressSample& sample : press.reference.pressing())
        table.header.emplace_back("F", shown_units().length.text(sample.indentation));
    std::vector<Cell> row{press.label};
    for (const meshes::PressSample& sample : press.reference.pressing()) {
      const double f = force_at(press.response, sample.indentation), off = error_at(press, sample);
      row.emplace_back(number(shown_units().force(f)), percent(off), grade(off));
    }
    row.resize(table.header.size());
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// The presses that are compared with others, and by how much their forces differ at most.
Table change_table(const std::vector<MovingPress>& presses) {
  Table table{heads({"Press", "compared with", "Largest difference"})};
  for (const MovingPress& press : presses)
    if (!press.beside.empty())
      table.rows.push_back({press.label, press.beside, percent_magnitude(press.change)});
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
