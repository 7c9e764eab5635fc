/// The numbers behind a figure: as CSV beside it, and for the page's script, with which readers ask
/// a curve for its values and switch series off.
#pragma once

#include <filesystem>
#include <string>

#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline figure {

/// Whether something of the series can be seen: logarithmic axes show positive numbers alone.
bool visible(const Panel& panel, const Series& series);

/// One row per point: `panel,series`, then a column per distinct axis label.
void write_points(const Figure& figure, const std::filesystem::path& file);

/// A JSON list of panels with axes {labels, box [px of the SVG: left, right, top, bottom], x and y
/// [from, to, whether logarithmic]} and series {label, curves: ids of their elements in the SVG, x,
/// y, shift}, and of surfaces {title, box, colour_scale, turning_surface()}, safe inside an HTML
/// script element. Bare panels are left out; empty text when none remains. `log` is gnuplot's: a
/// line "axes ..." per panel.
std::string page_points(const Figure& figure, const std::string& log);

}  // namespace fingertip::studies::report::inline figure
