#include "studies/report/figure/drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <kainjow/mustache.hpp>
#include <stdexcept>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/base/text_file.h"
#include "meshes/press/press_response.h"
#include "studies/files/process.h"
#include "studies/report/figure/axis_tics.h"
#include "studies/report/figure/figure_points.h"
#include "studies/report/figure/format.h"
#include "studies/report/figure/surface_script.h"

namespace fingertip::studies::report::inline figure {
namespace {

namespace fs = std::filesystem;

std::string data_block(const std::string& name, const std::vector<double>& x,
                       const std::vector<double>& y, const std::vector<double>& errors,
                       double shift) {
  std::string text = name + " << EOD\n";
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) {
      text += '\n';
      continue;
    }
    const double error = i < errors.size() ? errors[i] : 0.0;
    text += fmt::format("{:.8g} {:.8g} {:.8g}\n", shift * x[i], y[i],
                        std::isfinite(error) ? error : 0.0);
  }
  return text + "EOD\n";
}

/// gnuplot takes #AARRGGBB, where 0 is opaque.
std::string point_colour(const Style& style) {
  if (style.opacity >= 1.0) return style.colour;
  return fmt::format("#{:02x}{}", int(std::lround(255.0 * (1.0 - style.opacity))),
                     style.colour.substr(1));
}

std::string plot_item(const Series& series, const std::string& block) {
  const Style& style = series.style;
  const std::string title =
      series.label.empty() ? " notitle" : " title " + gnuplot_string(series.label);
  if (series.filled)
    return fmt::format("{} using 1:2 with filledcurves closed fc rgb '{}' fs solid 0.25 noborder{}",
                       block, style.colour, title);
  const bool own_line = !series.line_x.empty();
  const std::string with = !style.line                ? "points"
                           : style.point && !own_line ? "linespoints"
                                                      : "lines";
  const std::string source =
      series.legend_only ? "keyentry" : block + (own_line ? "l" : "") + " using 1:2";
  std::string item = fmt::format("{} with {} lc rgb '{}'", source, with,
                                 style.line ? style.colour : point_colour(style));
  if (style.line)
    item += fmt::format(" lw {} dt {}", style.width, style.dash.empty() ? "solid" : style.dash);
  const std::string points = fmt::format(" pt {} ps {}", style.point, style.point_size);
  if (style.point && !own_line) item += points;
  item += title;
  if (own_line)
    item += fmt::format(", {} using 1:2 with points lc rgb '{}'{} notitle", block,
                        point_colour(style), points);
  if (!series.error.empty()) {
    // Vectors with flat ends: the style "errorbars" would erase the curves around its points.
    item += fmt::format(
        ", {} using 1:($2-$3):(0):(2*$3) with vectors heads size screen 0.004,90 "
        "lc rgb '{}' lw 1.2 notitle",
        block, style.colour);
  }
  return item;
}

std::string decorations(const Panel& panel) {
  std::string text;
  if (panel.band) {
    text += fmt::format(
        "set object rectangle from graph 0, first {:.8g} to graph 1, first {:.8g} "
        "behind fillcolor rgb '#e8e4d4' fillstyle solid noborder\n",
        panel.band->from, panel.band->to);
  }
  for (const Marker& marker : panel.markers) {
    text += fmt::format(
        "set arrow from first {0:.8g}, graph 0 to first {0:.8g}, graph 1 nohead "
        "lc rgb '{1}' lw 1 dt (2,3)\n",
        marker.x, marker.colour);
  }
  for (const Arrow& arrow : panel.arrows) {
    const auto head = [&](double along) {
      return fmt::format(
          "set arrow from first {:.8g}, first {:.8g} to first {:.8g}, first {:.8g} head filled "
          "front size screen 0.012,20 lc rgb '{}' lw 2\n",
          arrow.x1, arrow.y1, arrow.x1 + along * (arrow.x2 - arrow.x1),
          arrow.y1 + along * (arrow.y2 - arrow.y1), arrow.colour);
    };
    text += head(1.0);
    if (arrow.two_heads) text += head(0.8);
  }
  for (const Text& label : panel.texts) {
    text += fmt::format("set label {} at first {:.8g}, first {:.8g} center tc rgb '#444444'\n",
                        gnuplot_string(label.text), label.x, label.y);
  }
  return text;
}

/// gnuplot refuses empty ranges, and on logarithmic axes ends that are not positive; the data rule
/// then.
std::string axis_range(const char* axis, const std::optional<Range>& range, bool logarithmic) {
  if (!range || range->from == range->to) return fmt::format("set {}range [*:*]\n", axis);
  const auto end = [&](double value) {
    const bool usable = std::isfinite(value) && (!logarithmic || value > 0.0);
    return usable ? fmt::format("{:.8g}", value) : std::string("*");
  };
  return fmt::format("set {}range [{}:{}]\n", axis, end(range->from), end(range->to));
}

/// What a logarithmic axis must show: its range where a positive one is given, else the positive
/// data, else {1, 1}.
Range positive_extent(const Panel& panel, bool vertical) {
  const auto& range = vertical ? panel.y_range : panel.x_range;
  if (range && range->from > 0.0 && range->to > 0.0)
    return {std::fmin(range->from, range->to), std::fmax(range->from, range->to)};
  Range extent;
  for (const Series& series : panel.series)
    for (const double value : vertical ? series.y : series.x)
      if (value > 0.0 && std::isfinite(value)) extent.include(value);
  return std::isnan(extent.from) ? Range{1.0, 1.0} : extent;
}

/// gnuplot's own labels would need its enhanced text, which texts from files must not reach.
std::string placed_tics(const char* axis,
                        const std::vector<std::pair<std::string, double>>& labels) {
  std::string tics;
  for (const auto& [label, value] : labels)
    tics += fmt::format("{}{} {:.8g}", tics.empty() ? "" : ", ", gnuplot_string(label), value);
  return fmt::format("set {}tics ({})\n", axis, tics);
}

/// Range, scale and tics of one axis.
std::string axis(const Panel& panel, bool vertical) {
  const char* name = vertical ? "y" : "x";
  const int base = vertical ? panel.log_y : panel.log_x;
  std::optional<Range> range = vertical ? panel.y_range : panel.x_range;
  std::string text = fmt::format("set {}tics autofreq\n", name);
  std::vector<std::pair<std::string, double>> labels;
  if (base != 0) text += fmt::format("set logscale {} {}\n", name, base);
  if (base == 10) {
    const Range extent = positive_extent(panel, vertical);
    const double padding = std::pow(extent.to / extent.from, 0.06) * 1.1;
    const Range shown{extent.from / padding, extent.to * padding};
    for (const double tic : logarithmic_tics(extent, range ? extent : shown))
      labels.emplace_back(tic_label(tic), tic);
    if (!range) range = shown;
  }
  if (!vertical)
    for (const std::string& own : panel.x_names)
      labels.emplace_back(own, double(labels.size() + 1));
  if (!labels.empty()) text += placed_tics(name, labels);
  return text + axis_range(name, range, base != 0);
}

std::string colour_scale(const char* palette, const Range& range, const std::string& label) {
  return fmt::format(
      "set palette defined {}\nset cbrange [{:.8g}:{:.8g}]\nset cblabel {} offset 1.5,0\n"
      "set colorbox\n",
      palette, range.from, range.to, gnuplot_string(label));
}

/// The data and the item of a plot.
struct ItemScript {
  std::string data, item;
};
ItemScript map_script(const HeatMap& map, std::size_t index) {
  const std::string block = fmt::format("$p{}map", index);
  ItemScript script{
      colour_scale(map.signed_values
                       ? "(-1 '#0072B2', -0.5 '#9ecae1', 0 '#ffffff', 0.5 '#fdae6b', 1 '#D55E00')"
                       : "(0 '#f7fbff', 0.35 '#9ecae1', 0.7 '#3182bd', 1 '#08306b')",
                   map.values, map.label),
      block + " using 1:2:3 with image notitle"};
  script.data += block + " << EOD\n";
  const GridFunction& f = map.function;
  for (std::size_t i = 0; i < f.x.size(); ++i)
    for (std::size_t j = 0; j < f.y.size(); ++j)
      script.data += std::isfinite(f.values[i][j])
                         ? fmt::format("{:.6g} {:.6g} {:.5g}\n", f.x[i], f.y[j], f.values[i][j])
                         : fmt::format("{:.6g} {:.6g} NaN\n", f.x[i], f.y[j]);
  script.data += "EOD\n";
  return script;
}

/// The palest colour is to be seen on white.
ItemScript arrows_script(const ColouredArrows& drawn, std::size_t index) {
  const std::string block = fmt::format("$p{}arrows", index);
  ItemScript script{colour_scale("(0 '#b0b7bf', 0.35 '#56B4E9', 0.7 '#0072B2', 1 '#0b1f5c')",
                                 drawn.range, drawn.label) +
                        block + " << EOD\n",
                    block +
                        " using 1:2:3:4:5 with vectors head filled size screen 0.01,18 "
                        "lc palette lw 1.8 notitle"};
  for (std::size_t i = 0; i < drawn.arrows.size(); ++i) {
    const Arrow& arrow = drawn.arrows[i];
    script.data += fmt::format("{:.6g} {:.6g} {:.6g} {:.6g} {:.5g}\n", arrow.x1, arrow.y1,
                               arrow.x2 - arrow.x1, arrow.y2 - arrow.y1, drawn.values[i]);
  }
  script.data += "EOD\n";
  return script;
}

std::string panel_script(const Panel& panel, std::size_t index) {
  std::string text = "unset object\nunset arrow\nunset label\nunset logscale\n";
  text += "set title " + gnuplot_string(panel.title) + " offset 0,-0.5\n";
  text += "set xlabel " + gnuplot_string(panel.x_label) + "\nset ylabel " +
          gnuplot_string(panel.y_label) + "\n";
  text += axis(panel, false) + axis(panel, true);
  text += panel.equal_scales ? "set size ratio -1\n" : "set size noratio\n";
  text += panel.key.empty() ? "unset key\n" : "set key " + panel.key + " Left reverse samplen 3\n";
  text += panel.bare ? "unset border\nunset xtics\nunset ytics\nunset grid\n" : "";
  text += decorations(panel);
  const auto seen = [&](const Series& series) { return visible(panel, series); };
  if (!panel.has_colour_scale() && std::none_of(panel.series.begin(), panel.series.end(), seen)) {
    // An empty panel keeps its place in the layout.
    return text + "unset logscale\nset xrange [0:1]\nset yrange [0:1]\nplot NaN notitle\n" +
           tell_axes;
  }
  std::string plot;
  if (panel.map) {
    const ItemScript map = map_script(*panel.map, index);
    text += map.data;
    plot = "plot " + map.item;
  }
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const bool legend_only = panel.series[i].legend_only;
    if (!legend_only && !seen(panel.series[i])) continue;
    const std::string block = fmt::format("$p{}s{}", index, i);
    const Series& own = panel.series[i];
    if (!legend_only) text += data_block(block, own.x, own.y, own.error, own.shift);
    if (!own.line_x.empty()) text += data_block(block + "l", own.line_x, own.line_y, {}, own.shift);
    plot += (plot.empty() ? "plot " : ", \\\n  ") + plot_item(panel.series[i], block);
  }
  if (panel.coloured_arrows && !panel.coloured_arrows->arrows.empty()) {
    const ItemScript arrows = arrows_script(*panel.coloured_arrows, index);
    text += arrows.data;
    plot += (plot.empty() ? "plot " : ", \\\n  ") + arrows.item;
  }
  return text + plot + "\n" + tell_axes;
}

/// Where the panels sit: the same room for labels in px around each of them; gnuplot leaves out a
/// vertical axis' label that finds no place beside ticks of six digits. Panels of one column share
/// their horizontal axis, so only the lowest needs its label.
std::string layout(const Figure& figure, int columns, int rows) {
  const double w = figure.width, h = figure.height;
  const bool shared = columns == 1;
  // Where a scale of colours stands beside each panel.
  const double scale = std::ranges::any_of(figure.panels, &Panel::has_colour_scale) ? 80 : 0;
  return fmt::format(
      "set multiplot layout {},{} margins screen {:.4f},{:.4f},{:.4f},{:.4f} spacing screen "
      "{:.4f},{:.4f}\n",
      rows, columns, 100 / w, 1.0 - figure.right_margin / w, 66 / h, 1.0 - (shared ? 14 : 46) / h,
      (106 + scale) / w, (shared ? 34 : 92) / h);
}

std::string script(const Figure& figure, const std::string& svg) {
  const int columns = std::max(1, figure.columns);
  const int rows = (int(figure.panels.size()) + columns - 1) / columns;
  std::string text = fmt::format(
      "set terminal svg size {},{} dynamic noenhanced font 'sans-serif,13' background '#ffffff' "
      "linewidth 1\nset output {}\nset encoding utf8\nset minussign\nset border 3 lc rgb "
      "'#555555'\n"
      "set tics nomirror tc rgb '#333333'\nset grid lc rgb '#dddddd' lw 0.6 dt solid\n",
      figure.width, figure.height, gnuplot_string(svg));
  const bool surfaces = !figure.panels.empty() && figure.panels.front().surface;
  if (surfaces) return text + surface_script(figure) + "unset output\n";
  if (rows * columns > 1) text += layout(figure, columns, rows);
  for (std::size_t i = 0; i < figure.panels.size(); ++i) {
    Panel panel = figure.panels[i];
    if (columns == 1 && i + 1 < figure.panels.size()) panel.x_label.clear();
    text += panel_script(panel, i);
  }
  if (rows * columns > 1) text += "unset multiplot\n";
  return text + "unset output\n";
}

/// Runs gnuplot on a script file, in that file's folder: whatever characters the path has, gnuplot
/// sees names of ours alone. Returns its exit code, -1 when it could not be started.
int run_gnuplot(const fs::path& script_file, const fs::path& log) {
  const fs::path gnuplot = program_on_path("gnuplot");
  if (gnuplot.empty()) return -1;
  return run_process(
      {{fs::absolute(gnuplot).string(), "--default-settings", script_file.filename().string()},
       {},
       script_file.parent_path()},
      log);
}

void replace_all(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos;
       at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
}

/// Replaces the first stretch from `from` to `to`; false when there is none.
bool cut(std::string& text, const std::string& from, const std::string& to, const std::string& by) {
  const std::size_t begin = text.find(from);
  if (begin == std::string::npos) return false;
  const std::size_t end = text.find(to, begin + from.size());
  if (end == std::string::npos) return false;
  text.replace(begin, end + to.size() - begin, by);
  return true;
}

/// The SVG as an element of an HTML page, where prolog and name spaces are not needed and ids must
/// not meet those of the other figures.
std::string inlined(std::string svg, const std::string& name, const std::string& title) {
  svg.erase(0, svg.find("<svg"));
  cut(svg, "<title>", "</title>", "<title>" + kainjow::mustache::html_escape(title) + "</title>");
  cut(svg, "<desc>", "</desc>", "");
  while (cut(svg, "<title>gnuplot_", "</title>", "")) {
    // Every curve carries its number as a tooltip.
  }
  cut(svg, "<filter id='textbox'", "</filter>", "");
  cut(svg, "<filter id='greybox'", "</filter>", "");
  cut(svg, "xmlns=\"", "\"", "role=\"img\"");
  cut(svg, "xmlns:xlink=\"", "\"", "");
  for (const char* prefix : {"id=\"", "id='", "href='#", "href=\"#", "url(#"}) {
    replace_all(svg, std::string(prefix) + "gnuplot_", std::string(prefix) + name + "_");
    replace_all(svg, std::string(prefix) + "gp", std::string(prefix) + name + "_");
  }
  return svg;
}

}  // namespace

Drawing draw(const Figure& figure, const std::string& title, const fs::path& folder) {
  const fs::path svg = folder / (figure.name + ".svg");
  const fs::path script_file = folder / (figure.name + ".gnuplot");
  const fs::path log = folder / (figure.name + ".log");
  meshes::write_atomically(
      script_file, [&](std::ostream& out) { out << script(figure, svg.filename().string()); });
  const int code = run_gnuplot(script_file, log);
  if (code < 0)
    throw meshes::InvalidInput({"gnuplot", "", "the program that draws figures cannot be started",
                                "install the package gnuplot-nox"});
  const std::string message = meshes::read_text(log);
  std::string image = fs::exists(svg) ? meshes::read_text(svg) : std::string();
  if (code != 0 || image.find("</svg>") == std::string::npos) {
    throw std::runtime_error(fmt::format("gnuplot could not draw the figure {} (exit code {}): {}",
                                         figure.name, code, message));
  }
  fs::remove(script_file);
  fs::remove(log);
  write_points(figure, folder / (figure.name + ".csv"));
  return {inlined(std::move(image), figure.name, title), page_points(figure, message)};
}

}  // namespace fingertip::studies::report::inline figure
