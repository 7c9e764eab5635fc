/// Level lines of a function known on a coarse grid.
#pragma once

#include <utility>
#include <vector>

namespace fingertip::studies::report::inline figure {

/// Values over a grid of two increasing lists; rows along `x`, columns along `y`, NaN where
/// unknown.
struct GridFunction {
  std::vector<double> x, y;
  std::vector<std::vector<double>> values;

  /// At least 2 × 2 and of consistent sizes, the abscissae finite and strictly increasing.
  bool valid() const;
};

/// `coarse`, which must be valid, with every interval divided by `factor` >= 1: cubic polynomials
/// through four nodes around along each axis, hence exact for products of cubics; of lower degree
/// where fewer known ones lie in a row.
GridFunction refined(const GridFunction& coarse, int factor);

using Polyline = std::vector<std::pair<double, double>>;

/// The lines where a valid grid's bilinear pieces reach `level` (marching squares); the first point
/// of a closed line is also its last. Cells with an unknown corner hold none.
std::vector<Polyline> level_lines(const GridFunction& grid, double level);

}  // namespace fingertip::studies::report::inline figure
