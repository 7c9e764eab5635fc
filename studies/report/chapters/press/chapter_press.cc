/// Force curves.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

const std::string above = "outside top center horizontal";

Series force_series(const meshes::PressResponse& response, const std::string& name) {
  Series series{model_label(name), name, {0.0}, {0.0}, {}, model_style(name)};
  for (const meshes::PressSample& sample : response.pressing()) {
    series.x.push_back(shown_units().length(sample.indentation));
    series.y.push_back(shown_units().force(sample.normal_force));
  }
  return series;
}

/// The continuum's samples as points with error bars ...
Series reference_points(const meshes::PressResponse& response) {
  Series series = force_series(response, "reference");
  series.style.line = false;
  series.error.push_back(0.0);
  for (const meshes::PressSample& sample : response.pressing()) {
    series.error.push_back(shown_units().force(sample.force_error));
  }
  return series;
}

/// ... and the curve between them that the errors are measured against.
Series reference_line(const meshes::PressResponse& response) {
  Series series{"", "reference, interpolated", {}, {}, {}, model_style("reference")};
  series.style.point = 0;
  const int steps = 120;
  for (int i = 0; i <= steps; ++i) {
    const double depth = i == steps ? response.depth() : response.depth() * i / steps;
    series.x.push_back(shown_units().length(depth));
    series.y.push_back(shown_units().force(response.normal_force_at(depth)));
  }
  return series;
}

Panel force_panel(const RunData& run) {
  Panel panel;
  panel.x_label = shown_units().length.label("indentation");
  panel.y_label = shown_units().force.label("normal force");
  if (!run.reference.empty()) panel.series.push_back(reference_line(run.reference));
  for (const ModelData& model : run.models) {
    if (!model.response.empty()) panel.series.push_back(force_series(model.response, model.name));
  }
  // Last, so that the points stay visible on top.
  if (!run.reference.empty()) panel.series.push_back(reference_points(run.reference));
  return panel;
}

/// Relative error at 60 depths from the first sample of the continuum on: before it the reference
/// is only an interpolation from zero.
Series error_series(const RunData& run, const ModelData& model) {
  Series series{model_label(model.name), model.name, {}, {}, {}, model_style(model.name)};
  const double from = run.reference.samples().front().indentation;
  const double to = std::min(run.reference.depth(), model.response.depth());
  const int steps = 60;
  for (int i = 0; i <= steps && to > from; ++i) {
    const double depth = i == steps ? to : from + (to - from) * i / steps;
    series.x.push_back(shown_units().length(depth));
    series.y.push_back(100.0 * meshes::relative_force_error(model.response, run.reference, depth));
  }
  return series;
}

/// Range of the error axis that shows the useful part: before the first depth of the verdict, where
/// a point or two touch, a curve may leave the picture.
Range error_axis(const RunData& run, const std::vector<Series>& curves) {
  const double from = run.depths.empty() ? 0.0 : shown_units().length(run.depths.front());
  double least = -5.0, most = 5.0;
  for (const Series& curve : curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (curve.x[i] < from) continue;
      least = std::fmin(least, curve.y[i]);
      most = std::fmax(most, curve.y[i]);
    }
  }
  const double padding = 0.08 * (most - least);
  return {least - padding, most + padding};
}

Table response_table(const RunData& run) {
  Table table;
  table.header = {plain("Indentation", unit_name(shown_units().length)),
                  {"Continuum", "± estimated error", Grade::none},
                  plain("Contact radius", unit_name(shown_units().length)),
                  plain("Peak pressure", unit_name(shown_units().stress))};
  for (const ModelData& model : run.models)
    table.header.push_back({model_label(model.name), "", Grade::none});
  for (double depth : run.depths) {
    std::vector<Cell> row{{fmt::format("{:.4g}", shown_units().length(depth)), "", Grade::none}};
    const auto cell = [&](const meshes::PressResponse& response) -> Cell {
      const double f = force_at(response, depth);
      if (std::isnan(f)) return {"–", "", Grade::none};
      return {number(shown_units().force(f)), si_note(f, "N"), Grade::none};
    };
    row.push_back(cell(run.reference));
    row.push_back({"–", "", Grade::none});
    row.push_back({"–", "", Grade::none});
    for (const meshes::PressSample& sample : run.reference.pressing()) {
      if (std::abs(sample.indentation - depth) > 1e-9) continue;
      if (std::isfinite(sample.force_error)) {
        const ShownUnit& force = shown_units().force;
        row[1].text = number_with_error(force(sample.normal_force), force(sample.force_error)) +
                      " ± " + number(force(sample.force_error), 2);
      }
      row[2] = {number(shown_units().length(sample.contact_radius)),
                si_note(sample.contact_radius, "m"), Grade::none};
      row[3] = {number(shown_units().stress(sample.max_pressure)),
                si_note(sample.max_pressure, "Pa"), Grade::none};
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
  Panel errors;
  errors.x_label = shown_units().length.label("indentation");
  errors.y_label = "force error [%]";
  errors.key = above;
  errors.band = Band{-2.0, 2.0};
  for (const ModelData& model : run.models) {
    if (!run.reference.empty() && !model.response.empty())
      errors.series.push_back(error_series(run, model));
  }
  if (!errors.series.empty()) {
    errors.y_range = error_axis(run, errors.series);
    chapter.figures.push_back({"force_error", 760, 360, 1, {errors}});
  }
  chapter.tables["response"] = response_table(run);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
