/// Figures drawn by gnuplot as SVG, with the plotted numbers as CSV.
#pragma once

#include <filesystem>
#include <string>

#include "studies/report/figure/figure.h"

namespace fingertip::studies::report::inline figure {

/// Draws the figure with gnuplot (started as a process) into `folder`/NAME.svg and writes what is
/// plotted to `folder`/NAME.csv: one row per point, `panel,series`, then one column per distinct
/// axis label. The picture is for use inside an HTML page: without XML prolog, with ids that are
/// unique to the figure and `title` as its accessible name.
/// Throws std::runtime_error with gnuplot's message when it is missing or fails.
struct Drawing {
  std::string svg;
  std::string points;  ///< page_points()
};
Drawing draw(const Figure& figure, const std::string& title, const std::filesystem::path& folder);

}  // namespace fingertip::studies::report::inline figure
