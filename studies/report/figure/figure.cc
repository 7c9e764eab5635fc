#include "studies/report/figure/figure.h"

#include <fmt/format.h>

#include <array>

namespace fingertip::studies::report::inline figure {

std::string gnuplot_string(const std::string& text) {
  std::string result = "'";
  for (char c : text) {
    if (c == '\'')
      result += "''";
    else
      result += c == '\n' || c == '\r' ? ' ' : c;
  }
  return result + "'";
}

Style Style::as_line() const {
  Style style = *this;
  style.point = 0;
  return style;
}

Style Style::as_points(int type) const {
  Style style = *this;
  style.line = false;
  if (type != 0) style.point = type;
  return style;
}

Series legend_entry(const std::string& label, const Style& style) {
  Series entry{label, "", style};
  entry.legend_only = true;
  return entry;
}

Range extent_of(const std::vector<Series>& curves, std::vector<double> Series::*numbers) {
  Range extent;
  for (const Series& curve : curves)
    for (const double number : curve.*numbers) extent.include(number);
  return extent;
}

Panel over_indentation(const std::string& y_label, const std::string& key) {
  return {.x_label = shown_units().length.label("indentation"), .y_label = y_label, .key = key};
}

Style model_style(const std::string& name) {
  if (name == "reference") return {"#000000", "", 1.8, 7};
  if (name == "published") return {"#D55E00", "(9,5)", 2.2};
  if (name == "central") return {"#0072B2", "(10,4,2,4)", 2.2};
  if (name == "hookean") return {"#009E73", "", 2.6};
  return {"#CC79A7", "(3,3)", 2.2};
}

Style numbered_style(std::size_t i) {
  static const std::array<const char*, 7> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                  "#E69F00", "#56B4E9", "#000000"};
  static const std::array<const char*, 4> dashes{"", "(9,5)", "(10,4,2,4)", "(3,3)"};
  static const std::array<int, 7> points{7, 5, 9, 13, 6, 4, 8};
  return {colours[i % colours.size()], dashes[i % dashes.size()], 2.0, points[i % points.size()],
          true};
}

std::string depth_shade(std::size_t i, std::size_t n) {
  static const std::array<const char*, 10> shades{"#a0d939", "#74d055", "#4ac16d", "#29af7f",
                                                  "#1f978b", "#287d8e", "#32648e", "#3d4a89",
                                                  "#472c7a", "#440154"};
  return shades[n > 1 ? (shades.size() - 1) * i / (n - 1) : 0];
}

std::string Figure::beside_panels() const {
  return fmt::format("at screen {:.4f}, screen {:.4f} left top",
                     1.0 - (right_margin - 12.0) / width, 1.0 - 14.0 / height);
}

std::string model_label(const std::string& name) {
  if (name == "reference") return "continuum (FEM)";
  return name == "published" ? "published (1996)" : name;
}

}  // namespace fingertip::studies::report::inline figure
