/// Pictures of mesh and lattices, and the contact pressure.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters.h"

namespace fingertip::studies::reporting {
namespace {

/// All panels show the rod's frame with the pole below, in cm.
struct Frame {
  Range x, z;
  double plane_at_touch = meshes::unknown, plane_at_end = meshes::unknown;
};

/// The frame that holds everything, from the undeformed mesh section (or the lattice boundary).
Frame common_frame(const RunData& run) {
  double radius = 0.0, top = -1e9, bottom = 1e9, depth = run.reference.depth();
  const auto include = [&](const std::vector<double>& x, const std::vector<double>& z) {
    for (double value : x) radius = std::fmax(radius, std::abs(to_cm(value)));
    for (double value : z)
      top = std::fmax(top, to_cm(value)), bottom = std::fmin(bottom, to_cm(value));
  };
  if (!run.section.empty()) include(run.section.numbers("x1 [m]"), run.section.numbers("z1 [m]"));
  for (const ModelData& model : run.models) {
    depth = std::max(depth, model.response.depth());
    if (run.section.empty() && !model.boundary.empty()) {
      include(model.boundary.numbers("x [m]"), model.boundary.numbers("z [m]"));
    }
  }
  Frame frame;
  const double margin = 0.12 * radius;
  frame.x = {-1.25 * radius, 1.25 * radius};
  frame.z = {top + margin, bottom - margin};
  frame.plane_at_touch = top;
  frame.plane_at_end = top - to_cm(depth);
  return frame;
}

Panel frame_panel(const Frame& frame, const std::string& title) {
  Panel panel;
  panel.title = title;
  panel.x_label = "x [cm]";
  panel.y_label = "z [cm]";
  panel.x_range = frame.x;
  panel.y_range = frame.z;
  panel.equal_scales = true;
  panel.key = "";
  return panel;
}

void add_plane(Panel& panel, const Frame& frame, double z) {
  panel.series.push_back(
      {"", "plane", {frame.x.from, frame.x.to}, {z, z}, {}, {"#333333", "", 2.4, 0, true}});
}

/// Line segments with breaks between them.
void add_segment(Series& series, double x1, double z1, double x2, double z2) {
  series.x.insert(series.x.end(), {x1, x2, meshes::unknown});
  series.y.insert(series.y.end(), {z1, z2, meshes::unknown});
}

Series section_series(const RunData& run, const std::string& prefix, const Style& style) {
  Series series{"", prefix.empty() ? "mesh undeformed" : "mesh deformed", {}, {}, {}, style};
  const std::vector<double> x1 = run.section.numbers(prefix + "x1 [m]"),
                            z1 = run.section.numbers(prefix + "z1 [m]");
  const std::vector<double> x2 = run.section.numbers(prefix + "x2 [m]"),
                            z2 = run.section.numbers(prefix + "z2 [m]");
  double least = 0.0;
  for (double x : x1) least = std::fmin(least, x);
  for (std::size_t i = 0; i < x1.size(); ++i) {
    add_segment(series, to_cm(x1[i]), to_cm(z1[i]), to_cm(x2[i]), to_cm(z2[i]));
    // A quarter model shows its mirror image, too.
    if (least > -1e-6)
      add_segment(series, -to_cm(x1[i]), to_cm(z1[i]), -to_cm(x2[i]), to_cm(z2[i]));
  }
  return series;
}

/// How far the rod has travelled from rest to the end of the trace [m].
double rod_travel(const ModelData& model) {
  const std::vector<double> indentation = model.trace.numbers("indentation [m]");
  return indentation.empty() ? 0.0 : indentation.back() - indentation.front();
}

/// The boundary springs on the viewer's side (y <= 0), projected on the plane y = 0.
Series boundary_series(const ModelData& model, bool deformed, const Style& style) {
  Series series{"", model.name + (deformed ? " deformed" : " undeformed"), {}, {}, {}, style};
  const std::string prefix = deformed ? "deformed_" : "";
  const std::vector<double> x = model.boundary.numbers(prefix + "x [m]");
  const std::vector<double> z = model.boundary.numbers(prefix + "z [m]");
  const std::vector<double> y = model.boundary.numbers("y [m]");
  const double travel = deformed ? rod_travel(model) : 0.0;
  const std::vector<double> first = model.boundary_springs.numbers("i");
  const std::vector<double> second = model.boundary_springs.numbers("j");
  for (std::size_t s = 0; s < first.size(); ++s) {
    const auto i = std::size_t(first[s]), j = std::size_t(second[s]);
    if (i >= x.size() || j >= x.size() || y[i] > 1e-9 || y[j] > 1e-9) continue;
    add_segment(series, to_cm(x[i]), to_cm(z[i] - travel), to_cm(x[j]), to_cm(z[j] - travel));
  }
  return series;
}

Series anchored_series(const ModelData& model) {
  Series series{"", model.name + " anchored", {}, {}, {}, {"#CC79A7", "", 1.0, 7, false, 0.35}};
  const std::vector<double> x = model.boundary.numbers("deformed_x [m]");
  const std::vector<double> z = model.boundary.numbers("deformed_z [m]");
  const std::vector<double> anchored = model.boundary.numbers("anchored");
  const double travel = rod_travel(model);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (anchored[i] != 1.0) continue;
    series.x.push_back(to_cm(x[i]));
    series.y.push_back(to_cm(z[i] - travel));
  }
  return series;
}

Style thin(const std::string& colour) {
  return {colour, "", 0.7, 0, true};
}

FigureBlock shapes_figure(const RunData& run) {
  const Frame frame = common_frame(run);
  Figure figure{"shapes", 900, 700, 3, {}};
  if (!run.section.empty()) {
    Panel rest = frame_panel(frame, "continuum mesh, y = 0, at first touch");
    rest.series.push_back(section_series(run, "", thin("#444444")));
    add_plane(rest, frame, frame.plane_at_touch);
    Panel pressed = frame_panel(frame, "continuum mesh, pressed");
    pressed.series.push_back(section_series(run, "deformed_", thin("#444444")));
    add_plane(pressed, frame, frame.plane_at_end);
    figure.panels = {rest, pressed};
  }
  const ModelData* drawn = nullptr;
  for (const ModelData& model : run.models) {
    if (!model.boundary.empty() && !model.boundary_springs.empty()) drawn = &model;
  }
  if (drawn) {
    Panel rest = frame_panel(frame, model_label(drawn->name) + ", at first touch");
    rest.series.push_back(boundary_series(*drawn, false, thin("#444444")));
    add_plane(rest, frame, frame.plane_at_touch);
    figure.panels.push_back(rest);
  }
  for (const ModelData& model : run.models) {
    if (model.boundary.empty() || model.boundary_springs.empty()) continue;
    Panel pressed = frame_panel(frame, model_label(model.name) + ", pressed");
    pressed.series.push_back(boundary_series(model, true, thin(model_style(model.name).colour)));
    pressed.series.push_back(anchored_series(model));
    add_plane(pressed, frame, frame.plane_at_end);
    figure.panels.push_back(pressed);
  }
  if (figure.panels.size() <= 3) figure.height = 370;
  return {
      figure, "Continuum and lattices at first touch and pressed",
      "Everything in the rod's frame (the rod's travel is subtracted) and to the same scale, "
      "pole down: the plane, a "
      "heavy line, rises by the indentation. Mesh: the element edges in the section y = 0. "
      "Lattices: the "
      "boundary springs on the viewer's side, projected; dots are particles held by the plane. In "
      "the calibrated models a boundary particle stands for the point of the true sphere before "
      "it, which touches in its place, so that its dot need not lie on the line."};
}

FigureBlock pressure_figure(const RunData& run) {
  // From pale to dark with increasing indentation.
  static const char* const shades[] = {"#a0d939", "#74d055", "#4ac16d", "#29af7f", "#1f978b",
                                       "#287d8e", "#32648e", "#3d4a89", "#472c7a", "#440154"};
  const std::vector<double> depth = run.pressure.numbers("indentation [m]");
  const std::vector<double> radius = run.pressure.numbers("radius [m]");
  const std::vector<double> pressure = run.pressure.numbers("pressure [Pa]");
  Panel panel;
  panel.x_label = "radius [cm]";
  panel.y_label = "contact pressure [gf/cm²]";
  panel.key = "outside right top";
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (panel.series.empty() || depth[i] != depth[i - 1]) {
      const std::string label = fmt::format("{:.4g} cm", to_cm(depth[i]));
      panel.series.push_back({label, label, {}, {}, {}, {"", "", 2.0, 7, false, 0.3}});
    }
    panel.series.back().x.push_back(to_cm(radius[i]));
    panel.series.back().y.push_back(to_gf_per_cm2(pressure[i]));
  }
  const std::size_t last = std::max<std::size_t>(1, panel.series.size() - 1);
  for (std::size_t i = 0; i < panel.series.size(); ++i)
    panel.series[i].style.colour = shades[9 * i / last];
  panel.y_range = Range{0.0, meshes::unknown};
  return {{"pressure", 760, 400, 1, {panel}},
          "Contact pressure of the continuum",
          "One colour per indentation, darker is deeper; every dot is a node of the surface. The "
          "pressure "
          "falls to zero at the edge of contact."};
}

}  // namespace

Chapter pictures_chapter(const RunData& run) {
  Chapter chapter{"pictures", "Shapes and pressure", {}};
  FigureBlock shapes = shapes_figure(run);
  if (!shapes.figure.panels.empty()) chapter.blocks.push_back(std::move(shapes));
  if (!run.pressure.empty()) chapter.blocks.push_back(pressure_figure(run));
  return chapter;
}

}  // namespace fingertip::studies::reporting
