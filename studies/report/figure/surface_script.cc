/// Surfaces in space: shaded facets side by side, one colour scale for all.
#include "studies/report/figure/surface_script.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace fingertip::studies::report::inline figure {
namespace {

using nlohmann::ordered_json;

/// Where one looks from [degrees].
constexpr int azimuth = 125, elevation = 25;

/// From small values, dark, to large ones: the colours of depth_shade() reversed.
struct Shade {
  double at;
  std::array<int, 3> rgb;
};
constexpr std::array<Shade, 4> palette{{{0.0, {0x44, 0x01, 0x54}},
                                        {0.35, {0x32, 0x64, 0x8e}},
                                        {0.65, {0x29, 0xaf, 0x7f}},
                                        {1.0, {0xa0, 0xd9, 0x39}}}};

std::string hex(const std::array<int, 3>& rgb) {
  return fmt::format("#{:02x}{:02x}{:02x}", rgb[0], rgb[1], rgb[2]);
}

/// Room for the colour scale at the right [px].
constexpr double scale_room = 110.0;

std::string grid_block(const Surface& surface, const std::string& name) {
  std::string text = name + " << EOD\n";
  for (const auto& row : surface.rows) {
    for (const Surface::Point& point : row)
      text += fmt::format("{:.5g} {:.5g} {:.5g} {:.5g}\n", point.x, point.y, point.z, point.value);
    text += '\n';
  }
  return text + "EOD\n";
}

/// What all surfaces share. The light falls from the viewer's shoulder; the page's script knows it.
std::string scene() {
  std::string shades;
  for (const Shade& shade : palette)
    shades += fmt::format("{}{} '{}'", shades.empty() ? "" : ", ", shade.at, hex(shade.rgb));
  return fmt::format(
      "set view {},{},1,1\nset view equal xyz\nset border 31 lc rgb '#888888'\n"
      "set pm3d depthorder noborder\nset pm3d lighting primary 0.4 specular 0.1\n"
      "set palette defined ({})\n",
      90 - elevation, azimuth, shades);
}

/// The largest of 1, 2 and 5 times a power of ten that is at most `extent`.
double round_below(double extent) {
  const double decade = std::pow(10.0, std::floor(std::log10(extent)));
  return extent >= 5.0 * decade ? 5.0 * decade : extent >= 2.0 * decade ? 2.0 * decade : decade;
}

std::string axes(const Panel& panel) {
  const Surface& surface = *panel.surface;
  std::string text = fmt::format("set xyplane at {:.8g}\n", -surface.extent);
  const double step = round_below(surface.extent);
  for (const char axis : {'x', 'y', 'z'})
    text += fmt::format("set {0}range [{1:.8g}:{2:.8g}]\nset {0}tics {3:.3g}\n", axis,
                        -surface.extent, surface.extent, step);
  return text + fmt::format(
                    "set xlabel {} rotate parallel\nset ylabel {} rotate parallel\n"
                    "set zlabel {} rotate parallel offset 1.2,0\n",
                    gnuplot_string(panel.x_label), gnuplot_string(panel.y_label),
                    gnuplot_string(surface.z_label));
}

/// The colour that gnuplot gives to a value between the ends of the scale, before it is lit.
std::string colour_of(double value, const Range& range) {
  const double at = std::clamp((value - range.from) / (range.to - range.from), 0.0, 1.0);
  const auto above = std::find_if(palette.begin() + 1, palette.end() - 1,
                                  [&](const Shade& shade) { return at <= shade.at; });
  const auto below = above - 1;
  const double share = (at - below->at) / (above->at - below->at);
  std::array<int, 3> rgb{};
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = int(std::lround(std::lerp(double(below->rgb[i]), double(above->rgb[i]), share)));
  return hex(rgb);
}

/// A shape under construction.
struct Shape {
  double scale;  ///< [px] per unit
  ordered_json points = ordered_json::array(), pieces = points, labels = points;

  ordered_json place(double x, double y, double z) const {
    ordered_json list = ordered_json::array();
    for (const double value : {x, y, z})
      list.push_back(std::stod(fmt::format("{:.4g}", scale * value)));
    return list;
  }
  void add_line(const std::string& colour, const ordered_json& from, const ordered_json& to) {
    pieces.push_back({colour, points.size(), points.size() + 1});
    points.push_back(from), points.push_back(to);
  }
  void add_label(const std::string& text, const ordered_json& at,
                 const ordered_json& along = nullptr) {
    labels.push_back({text, at, along});
  }
};

void add_facets(Shape& shape, const Surface& surface) {
  const std::size_t columns = surface.rows.front().size();
  for (std::size_t i = 0; i < surface.rows.size(); ++i) {
    for (std::size_t j = 0; j < columns; ++j) {
      const Surface::Point& point = surface.rows[i][j];
      shape.points.push_back(shape.place(point.x, point.y, point.z));
      if (i == 0 || j == 0) continue;
      const auto &last = surface.rows[i - 1], &row = surface.rows[i];
      const double sum = last[j - 1].value + last[j].value + row[j].value + row[j - 1].value;
      const std::size_t corner = i * columns + j;
      shape.pieces.push_back({colour_of(sum / 4.0, surface.values), corner - columns - 1,
                              corner - columns, corner, corner - 1});
    }
  }
}

/// Axes, grid and labels where gnuplot prints them from azimuth and elevation above.
void add_axes(Shape& shape, const Panel& panel) {
  const Surface& surface = *panel.surface;
  const double end = surface.extent, step = round_below(end);
  const auto at = [&](double x, double y, double z) { return shape.place(x, y, z); };
  for (const double side : {-end, end}) {
    shape.add_line("#888888", at(side, -end, -end), at(side, end, -end));
    shape.add_line("#888888", at(-end, side, -end), at(end, side, -end));
  }
  shape.add_line("#888888", at(end, -end, -end), at(end, -end, end));
  for (int i = -int(end / step); i * step <= end; ++i) {
    const double tic = i * step;
    std::string text = fmt::format("{:.3g}", std::abs(tic));
    if (i < 0) text.insert(0, "−");
    shape.add_line("#f0f0f0", at(tic, -end, -end), at(tic, end, -end));
    shape.add_line("#f0f0f0", at(-end, tic, -end), at(end, tic, -end));
    shape.add_label(text, at(tic, 1.13 * end, -end));
    shape.add_label(text, at(1.13 * end, tic, -end));
    shape.add_label(text, at(1.24 * end, -1.24 * end, tic));
  }
  shape.add_label(panel.x_label, at(0, 1.97 * end, -end), {1, 0, 0});
  shape.add_label(panel.y_label, at(1.97 * end, 0, -end), {0, 1, 0});
  shape.add_label(surface.z_label, at(1.325 * end, -1.325 * end, 0), {0, 0, 1});
}

}  // namespace

double colour_scale_at(const Figure& figure) {
  return figure.width - 92.0;
}

ordered_json turning_surface(const Panel& panel, double side) {
  // gnuplot's cube of axes is as long as 4/7 of its square.
  Shape shape{4.0 / 7.0 * side / (2.0 * panel.surface->extent)};
  add_facets(shape, *panel.surface);
  add_axes(shape, panel);
  return {{"view", {azimuth, elevation}},
          {"points", std::move(shape.points)},
          {"pieces", std::move(shape.pieces)},
          {"labels", std::move(shape.labels)}};
}

std::string surface_script(const Figure& figure) {
  const std::size_t columns = std::size_t(std::max(1, figure.columns));
  const double rows = double((figure.panels.size() + columns - 1) / columns);
  const double share = (figure.width - scale_room) / figure.width / double(columns);
  std::string text = scene() + "unset key\nset multiplot\n";
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    const Panel& panel = figure.panels[i];
    if (!panel.surface) continue;
    const std::string block = fmt::format("$surface{}", i);
    text += grid_block(*panel.surface, block) + axes(panel);
    // Larger than its share: gnuplot leaves much room around what it draws in space.
    const double row = double(i / columns), column = double(i % columns);
    text += fmt::format("set size {:.4f},{:.4f}\nset origin {:.4f},{:.4f}\n", 1.15 * share,
                        1.45 / rows, column * share, (rows - 1.0 - row - 0.18) / rows);
    text += "set title " + gnuplot_string(panel.title) + " offset 0,-4.5\n";
    const Range& values = panel.surface->values;
    text += fmt::format("set cbrange [{:.8g}:{:.8g}]\nset cblabel {}\n", values.from, values.to,
                        gnuplot_string(panel.surface->value_label));
    const bool last = i + 1 == figure.panels.size();
    // The scale ends above where the labels of the first row begin.
    text += last ? fmt::format(
                       "set colorbox user origin screen {:.4f},{:.4f} size screen {:.4f},{:.4f}\n",
                       colour_scale_at(figure) / figure.width, 1.0 - 0.72 / rows,
                       15.0 / figure.width, 0.52 / rows)
                 : "unset colorbox\n";
    text += fmt::format("splot {} using 1:2:3:4 with pm3d notitle\n", block) + tell_axes;
  }
  return text + "unset multiplot\n";
}

}  // namespace fingertip::studies::report::inline figure
