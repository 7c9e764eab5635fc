/// Pictures of mesh and lattices.
#include <algorithm>
#include <cmath>

#include "studies/report/chapters/continuum/continuum_figures.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

/// All panels show the rod's frame with the pole below.
struct Frame {
  Range x, z;
  double touch = meshes::unknown, end = meshes::unknown;  ///< plane at the obstacle's top
};

/// The frame that holds everything, from the undeformed mesh section (or the lattice boundary).
Frame common_frame(const RunData& run) {
  double radius = 0.0, top = -1e9, bottom = 1e9, depth = run.reference.depth();
  const auto include = [&](const std::vector<double>& x, const std::vector<double>& z) {
    for (double value : x) radius = std::fmax(radius, std::abs(shown_units().length(value)));
    for (double value : z)
      top = std::fmax(top, shown_units().length(value)),
      bottom = std::fmin(bottom, shown_units().length(value));
  };
  const auto along = [](const auto& rows, auto member, int axis) {
    std::vector<double> values;
    for (const auto& row : rows) values.push_back((row.*member)[std::size_t(axis)]);
    return values;
  };
  constexpr auto corners = &fem_reference::SectionRow::undeformed;
  include(along(run.section, corners, 0), along(run.section, corners, 1));
  for (const ModelData& model : run.models) {
    depth = std::max(depth, model.response.depth());
    if (run.section.empty() && !model.boundary.empty()) {
      include(along(model.boundary, &BoundaryRow::rest, 0),
              along(model.boundary, &BoundaryRow::rest, 2));
    }
  }
  Frame frame;
  frame.touch = first_touch(run).plane;
  frame.end = frame.touch - shown_units().length(depth);
  const double margin = 0.12 * radius;
  frame.x = {-1.25 * radius, 1.25 * radius};
  frame.z = {std::fmax(top, frame.touch) + margin, bottom - margin};
  return frame;
}

Panel frame_panel(const Frame& frame, const std::string& title) {
  Panel panel;
  panel.title = title;
  panel.x_label = shown_units().length.label("x");
  panel.y_label = shown_units().length.label("z");
  panel.x_range = frame.x;
  panel.y_range = frame.z;
  panel.equal_scales = true;
  panel.key = "";
  return panel;
}

/// How far the rod has travelled from rest to the end [m]; unknown where no file tells it.
double rod_travel(const ModelData& model) {
  // Without time its way begins at first touch.
  if (model.summary.rests() && !model.snapshots.empty()) return model.snapshots.back().indentation;
  if (model.trace.empty()) return meshes::unknown;
  return model.trace.back().indentation - model.trace.front().indentation;
}

/// The boundary springs on the viewer's side (y <= 0), projected on the plane y = 0.
Series boundary_series(const ModelData& model, bool deformed, const Style& style) {
  Series series{"", model.name + (deformed ? " deformed" : " undeformed"), {}, {}, {}, style};
  const double travel = deformed ? rod_travel(model) : 0.0;
  for (const BoundarySpringRow& spring : model.boundary_springs) {
    const BoundaryRow &first = model.boundary[spring.i], &second = model.boundary[spring.j];
    if (first.rest.y() > 1e-9 || second.rest.y() > 1e-9) continue;
    const meshes::Vector3& from = deformed ? first.deformed : first.rest;
    const meshes::Vector3& to = deformed ? second.deformed : second.rest;
    add_segment(series, shown_units().length(from.x()), shown_units().length(from.z() - travel),
                shown_units().length(to.x()), shown_units().length(to.z() - travel));
  }
  return series;
}

Series anchored_series(const ModelData& model) {
  Series series{"", model.name + " anchored", {}, {}, {}, {"#CC79A7", "", 1.0, 7, false, 0.35}};
  const double travel = rod_travel(model);
  for (const BoundaryRow& row : model.boundary) {
    if (!row.anchored) continue;
    series.x.push_back(shown_units().length(row.deformed.x()));
    series.y.push_back(shown_units().length(row.deformed.z() - travel));
  }
  return series;
}

Figure shapes_figure(const RunData& run) {
  const Frame frame = common_frame(run);
  Figure figure{"shapes", 900, 700, 3, {}};
  if (!run.section.empty()) {
    Panel rest = frame_panel(frame, "continuum mesh, y = 0, at first touch");
    rest.series.push_back(section_series(run, false, thin("#444444")));
    rest.series.push_back(obstacle_series(run, frame.x, frame.touch));
    Panel pressed = frame_panel(frame, "continuum mesh, pressed");
    pressed.series.push_back(section_series(run, true, thin("#444444")));
    pressed.series.push_back(obstacle_series(run, frame.x, frame.end));
    figure.panels = {rest, pressed};
  }
  const ModelData* drawn = nullptr;
  for (const ModelData& model : run.models) {
    if (!model.boundary.empty() && !model.boundary_springs.empty()) drawn = &model;
  }
  if (drawn) {
    Panel rest = frame_panel(frame, model_label(drawn->name) + ", at first touch");
    rest.series.push_back(boundary_series(*drawn, false, thin("#444444")));
    rest.series.push_back(obstacle_series(run, frame.x, frame.touch));
    figure.panels.push_back(rest);
  }
  for (const ModelData& model : run.models) {
    if (model.boundary.empty() || model.boundary_springs.empty()) continue;
    Panel pressed = frame_panel(frame, model_label(model.name) + ", pressed");
    pressed.series.push_back(boundary_series(model, true, thin(model_style(model.name).colour)));
    pressed.series.push_back(anchored_series(model));
    pressed.series.push_back(obstacle_series(run, frame.x, frame.end));
    figure.panels.push_back(pressed);
  }
  if (figure.panels.size() <= 3) figure.height = 370;
  return figure;
}

}  // namespace

Chapter pictures_chapter(const RunData& run) {
  // Without its rod's way a press cannot be drawn in the rod's frame.
  for (const ModelData& model : run.models)
    if (!model.boundary.empty() && std::isnan(rod_travel(model))) return {};
  ChapterData chapter("pictures");
  chapter.figures = {shapes_figure(run)};
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
