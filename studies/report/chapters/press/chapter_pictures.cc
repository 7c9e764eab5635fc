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
  const auto include = [&](double x, double z) {
    radius = std::fmax(radius, std::abs(shown_units().length(x)));
    top = std::fmax(top, shown_units().length(z));
    bottom = std::fmin(bottom, shown_units().length(z));
  };
  for (const fem_reference::SectionRow& row : run.section)
    include(row.undeformed[0], row.undeformed[1]);
  for (const ModelData& model : run.models) {
    depth = std::max(depth, model.response.depth());
    if (run.section.empty())
      for (const BoundaryRow& row : model.boundary) include(row.rest.x(), row.rest.z());
  }
  Frame frame;
  frame.touch = first_touch(run).plane;
  frame.end = frame.touch - shown_units().length(depth);
  const double margin = 0.12 * radius;
  frame.x = {-1.25 * radius, 1.25 * radius};
  frame.z = {std::fmax(top, frame.touch) + margin, bottom - margin};
  return frame;
}

/// A shape in the frame, with the obstacle below.
Panel frame_panel(const RunData& run, const Frame& frame, const std::string& title, bool pressed,
                  std::vector<Series> shape) {
  shape.push_back(obstacle_series(run, frame.x, pressed ? frame.end : frame.touch));
  return {.title = title + (pressed ? ", pressed" : ", at first touch"),
          .x_label = shown_units().length.label("x"),
          .y_label = shown_units().length.label("z"),
          .series = std::move(shape),
          .x_range = frame.x,
          .y_range = frame.z,
          .equal_scales = true,
          .key = ""};
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
  Series series{"", model.name + (deformed ? " deformed" : " undeformed"), style};
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
  Series series{"", model.name + " anchored", {"#CC79A7", "", 1.0, 7, false, 0.35}};
  const double travel = rod_travel(model);
  for (const BoundaryRow& row : model.boundary)
    if (row.anchored)
      series.add(shown_units().length(row.deformed.x()),
                 shown_units().length(row.deformed.z() - travel));
  return series;
}

Figure shapes_figure(const RunData& run) {
  const Frame frame = common_frame(run);
  Figure figure{"shapes", 900, 700, 3, {}};
  const auto add = [&](const std::string& title, bool pressed, std::vector<Series> shape) {
    figure.panels.push_back(frame_panel(run, frame, title, pressed, std::move(shape)));
  };
  if (!run.section.empty()) {
    add("continuum mesh, y = 0", false, {section_series(run, false, thin("#444444"))});
    add("continuum mesh", true, {section_series(run, true, thin("#444444"))});
  }
  std::vector<const ModelData*> drawn;
  for (const ModelData& model : run.models)
    if (!model.boundary.empty() && !model.boundary_springs.empty()) drawn.push_back(&model);
  if (!drawn.empty())
    add(model_label(drawn.back()->name), false,
        {boundary_series(*drawn.back(), false, thin("#444444"))});
  for (const ModelData* model : drawn)
    add(model_label(model->name), true,
        {boundary_series(*model, true, thin(model_style(model->name).colour)),
         anchored_series(*model)});
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
