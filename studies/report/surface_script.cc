/// Surfaces in space for gnuplot: shaded facets side by side, one colour scale for all.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/figure.h"

namespace fingertip::studies::reporting {
namespace {

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

/// What all surfaces share: where one looks from, and the colours of depth_shade() reversed, dark
/// for small values. The light falls from the viewer's shoulder.
std::string scene() {
  return "set view 65,125,1,1\nset view equal xyz\nset border 31 lc rgb '#888888'\n"
         "set pm3d depthorder noborder\nset pm3d lighting primary 0.4 specular 0.1\n"
         "set palette defined (0 '#440154', 0.35 '#32648e', 0.65 '#29af7f', 1 '#a0d939')\n";
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

}  // namespace

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
    text +=
        last ? fmt::format(
                   "set colorbox user origin screen {:.4f},{:.4f} size screen {:.4f},{:.4f}\n",
                   1.0 - 92.0 / figure.width, 1.0 - 0.72 / rows, 15.0 / figure.width, 0.52 / rows)
             : "unset colorbox\n";
    text += fmt::format("splot {} using 1:2:3:4 with pm3d notitle\n", block);
  }
  return text + "unset multiplot\n";
}

}  // namespace fingertip::studies::reporting
