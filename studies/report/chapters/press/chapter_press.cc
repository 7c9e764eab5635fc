/// Force curves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

/// From zero, where nothing touches.
Series force_series(const meshes::PressResponse& response, const std::string& name) {
  Series series = force_curve(model_label(name), name, model_style(name), response.pressing());
  series.x.insert(series.x.begin(), 0.0);
  series.y.insert(series.y.begin(), 0.0);
  return series;
}

/// The continuum's samples as points with error bars ...
Series reference_points(const meshes::PressResponse& response) {
  Series series = force_series(response, "reference");
  series.style.line = false;
  series.error.push_back(0.0);
  for (const meshes::PressSample& sample : response.pressing())
    series.error.push_back(shown_units().force(sample.force_error));
  return series;
}

/// ... and the curve between them that the errors are measured against.
Series reference_line(const meshes::PressResponse& response) {
  Series series{"", "reference, interpolated", model_style("reference").as_line()};
  const int steps = 120;
  for (int i = 0; i <= steps; ++i) {
    const double depth = i == steps ? response.depth() : response.depth() * i / steps;
    series.add(shown_units().length(depth), shown_units().force(response.normal_force_at(depth)));
  }
  return series;
}

Panel force_panel(const RunData& run) {
  Panel panel = over_indentation(shown_units().force.label("normal force"));
  if (!run.reference.empty()) panel.series.push_back(reference_line(run.reference));
  for (const ModelData& model : run.models)
    if (!model.response.empty()) panel.series.push_back(force_series(model.response, model.name));
  // Last, so that the points stay visible on top.
  if (!run.reference.empty()) panel.series.push_back(reference_points(run.reference));
  return panel;
}

/// Relative error at 60 depths from the first sample of the continuum on: before it the reference
/// is only an interpolation from zero.
Series error_series(const RunData& run, const ModelData& model) {
  Series series{model_label(model.name), model.name, model_style(model.name)};
  const double from = run.reference.samples().front().indentation;
  const double to = std::min(run.reference.depth(), model.response.depth());
  const int steps = 60;
  for (int i = 0; i <= steps && to > from; ++i) {
    const double depth = i == steps ? to : from + (to - from) * i / steps;
    series.add(shown_units().length(depth),
               100.0 * meshes::relative_force_error(model.response, run.reference, depth));
  }
  return series;
}

/// Range of the error axis that shows the useful part: before the first depth of the verdict, where
/// a point or two touch, a curve may leave the picture.
Range error_axis(const RunData& run, const std::vector<Series>& curves) {
  const double from = run.depths.empty() ? 0.0 : shown_units().length(run.depths.front());
  Range range{-5.0, 5.0};
  for (const Series& curve : curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (!(curve.x[i] < from)) range.include(curve.y[i]);
  const double padding = 0.08 * (range.to - range.from);
  return {range.from - padding, range.to + padding};
}

Table response_table(const RunData& run) {
  const ShownUnits& units = shown_units();
  Table table{heads({"Indentation\n" + unit_name(units.length), "Continuum",
                     "Contact radius\n" + unit_name(units.length),
                     "Peak pressure\n" + unit_name(units.stress)})};
  for (const ModelData& model : run.models) table.header.emplace_back(model_label(model.name));
  for (const double depth : run.depths) {
    const auto cell = [&](const meshes::PressResponse& response) {
      const double force = force_at(response, depth);
      return amount_cell(force, units.force, std::abs(force) * response.relative_error_at(depth));
    };
    std::vector<Cell> row{fmt::format("{:.4g}", units.length(depth)), cell(run.reference), "–",
                          "–"};
    for (const meshes::PressSample& sample : run.reference.pressing()) {
      if (std::abs(sample.indentation - depth) > 1e-9) continue;
      row[2] = amount_cell(sample.contact_radius, units.length);
      row[3] = amount_cell(sample.max_pressure, units.stress);
    }
    for (const ModelData& model : run.models) row.push_back(cell(model.response));
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

Chapter force_chapter(const RunData& run) {
  ChapterData chapter("force");
  chapter.figures = {{"force_indentation", 760, 460, 1, {force_panel(run)}}};
  if (chapter.figures.front().panels.front().series.empty()) return {};
  Panel errors = over_indentation("force error [%]", above);
  errors.band = Band{-2.0, 2.0};
  for (const ModelData& model : run.models)
    if (!run.reference.empty() && !model.response.empty())
      errors.series.push_back(error_series(run, model));
  if (!errors.series.empty()) {
    errors.y_range = error_axis(run, errors.series);
    chapter.figures.push_back({"force_error", 760, 360, 1, {errors}});
  }
  chapter.tables["response"] = response_table(run);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
