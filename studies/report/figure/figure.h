/// Figures as data: panels of curves and surfaces, and how they look.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "meshes/tables/file_fields.h"
#include "studies/files/shown_units.h"
#include "studies/report/figure/contours.h"

namespace fingertip::studies::report::inline figure {

/// How a curve looks. Colours are the colour-blind-safe ones of Okabe & Ito (2008); every model
/// keeps its colour and dash pattern in all figures.
struct Style {
  std::string colour = "#000000";
  std::string dash = {};  ///< gnuplot's (on, off, …) lengths, solid when empty
  double width = 2.0;
  int point = 0;     ///< gnuplot's point type, 0 for none
  bool line = true;  ///< join the points
  double point_size = 0.65;
  double opacity = 1.0;  ///< of the points, 0 to 1

  /// The same as a line without points.
  Style as_line() const;
  /// The same as points without a line, of another type where one is given.
  Style as_points(int type = 0) const;
};

/// The style of a curve that belongs to "reference" or to a model of that name.
Style model_style(const std::string& name);
/// The i-th of a row of styles without meaning of their own.
Style numbered_style(std::size_t i);
/// The colour of the i-th of n curves for increasing indentation: from pale to dark.
std::string depth_shade(std::size_t i, std::size_t n);
/// The name of a model as the reader sees it.
std::string model_label(const std::string& name);

/// A curve in display units. A NaN in x or y breaks the line.
struct Series {
  std::string label;  ///< in the legend; left out of it when empty
  std::string key;    ///< name in the CSV; `label` when empty
  Style style = {};
  std::vector<double> x = {}, y = {};
  std::vector<double> error = {};  ///< half-height of error bars, empty for none
  /// Drawn as the line in place of straight ones between x, y, whose points stay; empty: those.
  std::vector<double> line_x = {}, line_y = {};
  /// Drawn at so many times x, lest error bars cover each other; the CSV has x itself.
  double shift = 1.0;
  bool legend_only = false;  ///< an entry of the legend without a curve
  bool filled = false;       ///< a pale area inside the closed curve, behind what follows

  void add(double at, double value) {
    x.push_back(at);
    y.push_back(value);
  }
};

/// A point per row: of `x` and `y`, members or functions of a row.
template <class Rows, class X, class Y>
Series curve(const std::string& label, const std::string& key, const Style& style, const Rows& rows,
             const X& x, const Y& y) {
  Series series{label, key, style};
  for (const auto& row : rows) series.add(std::invoke(x, row), std::invoke(y, row));
  return series;
}
/// A member of a row in a unit that is shown, for curve().
template <class Unit, class Member>
auto in(const Unit& unit, Member member) {
  return [unit, member](const auto& row) { return unit(std::invoke(member, row)); };
}
template <class Member>
auto in_percent(Member member) {
  return [member](const auto& row) { return 100.0 * std::invoke(member, row); };
}

/// Entry of the legend without a curve.
Series legend_entry(const std::string& label, const Style& style);

/// A NaN end follows the data.
struct Range {
  double from = meshes::unknown, to = meshes::unknown;

  /// Widens it, from nothing where its ends are NaN.
  void include(double value) {
    from = std::fmin(from, value);
    to = std::fmax(to, value);
  }
};
/// Of the numbers of all curves, one of the two lists; NaN without any.
Range extent_of(const std::vector<Series>& curves, std::vector<double> Series::*numbers);

/// A horizontal band, e.g. a tolerance.
struct Band {
  double from, to;
};
/// A vertical line at `x`.
struct Marker {
  double x;
  std::string colour;
};
struct Text {
  double x, y;
  std::string text;
};

/// From a point to another, with one head or, for moments, two.
struct Arrow {
  double x1, y1, x2, y2;
  std::string colour;
  bool two_heads = false;
};

/// Arrows in the colours of a value.
struct ColouredArrows {
  std::vector<Arrow> arrows = {};  ///< whose own colours do not count
  std::vector<double> values = {};
  Range range = {};   ///< of the colours; from < to
  std::string label;  ///< of the values, with their unit
};

/// A surface in space, coloured by a value. Drawn with all three axes from -extent to extent.
struct Surface {
  struct Point {
    double x, y, z, value;
  };
  std::vector<std::vector<Point>> rows;  ///< of equal length; neighbours span the facets
  std::string z_label, value_label;
  double extent = 1.0;        ///< > 0
  Range values = {0.0, 1.0};  ///< of the colours; from < to
};

/// A function of x and y as colours: white where it is unknown.
struct HeatMap {
  GridFunction function;       ///< valid()
  Range values = {};           ///< of the colours; from < to
  std::string label;           ///< of the values, with their unit
  bool signed_values = false;  ///< colours for both signs, white at zero
};

/// One pair of axes.
struct Panel {
  std::string title = {}, x_label = {}, y_label = {};  ///< labels carry their unit in brackets
  std::vector<Series> series = {};
  std::optional<Range> x_range = {}, y_range = {};
  std::optional<Band> band = {};
  std::vector<Marker> markers = {};
  std::vector<Text> texts = {};
  std::vector<Arrow> arrows = {};
  bool bare = false;             ///< a picture: without axes
  bool equal_scales = false;     ///< one unit is as long on x as on y
  int log_x = 0, log_y = 0;      ///< base of a logarithmic axis, 2 or 10; 0 for a linear one.
                                 ///< A range given for base 10 must be finite and positive.
  std::string key = "top left";  ///< gnuplot's place of the legend, "" for none
  std::vector<std::string> x_names = {};  ///< tics at 1, 2, … in place of numbers
  /// In place of series. All panels of a figure have one or none has; they fill the columns row by
  /// row.
  std::optional<Surface> surface = std::nullopt;
  std::optional<HeatMap> map = std::nullopt;  ///< behind the series
  std::optional<ColouredArrows> coloured_arrows = std::nullopt;  ///< before them; in place of a map

  bool has_colour_scale() const { return map || coloured_arrows; }
};

/// Panel::key of a legend above the axes.
inline constexpr const char* above = "outside top center horizontal";

/// A panel over indentation.
Panel over_indentation(const std::string& y_label, const std::string& key = "top left");

struct Figure {
  std::string name;               ///< file name without extension
  int width = 760, height = 430;  ///< [px]
  int columns = 1;
  std::vector<Panel> panels;
  int right_margin = 18;  ///< room right of several panels, e.g. for beside_panels() [px]

  /// Panel::key of a legend in the right margin.
  std::string beside_panels() const;
};

/// `text` as a string in a gnuplot script: in single quotes, which suspend every other escape.
std::string gnuplot_string(const std::string& text);

/// Into gnuplot's log after a panel: where its axes are, for page_points() (figure_points.h).
inline constexpr const char* tell_axes =
    "print sprintf('axes %.6g %.6g %.6g %.6g %.9g %.9g %.9g %.9g', GPVAL_TERM_XMIN, "
    "GPVAL_TERM_XMAX, GPVAL_TERM_YMIN, GPVAL_TERM_YMAX, GPVAL_X_MIN, GPVAL_X_MAX, GPVAL_Y_MIN, "
    "GPVAL_Y_MAX)\n";

}  // namespace fingertip::studies::report::inline figure
