/// Confidence regions of two parameters from the profile of chi-square.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "studies/report/chapters/fit/calibration_figures.h"
#include "studies/report/figure/contours.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

struct Level {
  double increase;  ///< of chi-square, for two parameters
  const char *label, *colour;
};
constexpr Level levels[] = {
    {2.30, "68 %", "#440154"}, {5.99, "95 %", "#287d8e"}, {9.21, "99 %", "#74d055"}};

/// The covariance's block of the two parameters and their estimates, in shown units.
struct Linearised {
  double x = 0.0, y = 0.0;
  double first = 0.0, mixed = 0.0, second = 0.0;

  bool positive() const { return first > 0.0 && first * second > mixed * mixed; }
  /// Δᵀ C⁻¹ Δ, which the profile would be if the fit were linear; 0 without a covariance.
  double increase(double at_x, double at_y) const {
    if (!positive()) return 0.0;
    const double u = at_x - x, v = at_y - y;
    return (second * u * u - 2.0 * mixed * u * v + first * v * v) /
           (first * second - mixed * mixed);
  }
};

Linearised linearised(const Fit& fit, std::size_t i, std::size_t j) {
  const FitParameter &first = fit.parameters[i], &second = fit.parameters[j];
  Linearised result{first.factor * first.estimate, second.factor * second.estimate};
  const auto covariance = fit.square(fit.file.covariance);
  if (covariance.empty()) return result;
  result.first = covariance[i][i] * first.factor * first.factor;
  result.mixed = covariance[i][j] * first.factor * second.factor;
  result.second = covariance[j][j] * second.factor * second.factor;
  return result;
}

/// Δᵀ C⁻¹ Δ = level around the estimates: Cholesky's factor of C times a circle.
Series ellipse(const Linearised& fit, double level) {
  Series series{"95 %, linearised", "ellipse", {"#000000", "(6,4)", 1.3}};
  const double l11 = std::sqrt(fit.first), l21 = fit.mixed / l11,
               l22 = std::sqrt(fit.second - l21 * l21), radius = std::sqrt(level);
  for (int degree = 0; degree <= 360; degree += 3) {
    const double angle = degree * std::numbers::pi / 180.0;
    const double u = radius * std::cos(angle), v = radius * std::sin(angle);
    series.add(fit.x + l11 * u, fit.y + l21 * u + l22 * v);
  }
  return series;
}

Series mark_at(const std::string& label, double x, double y, const std::string& colour, int point) {
  return {label, label, {colour, "", 1.0, point, false, 1.1}, {x}, {y}};
}

GridFunction profile_grid(const calibration::ProfileEntry& profile, const FitParameter& first,
                          const FitParameter& second) {
  GridFunction grid{profile.first_values, profile.second_values, profile.increase};
  for (double& value : grid.x) value *= first.factor;
  for (double& value : grid.y) value *= second.factor;
  return grid;
}

GridFunction with_linearised(GridFunction grid, const Linearised& fit, double sign) {
  for (std::size_t i = 0; i < grid.x.size(); ++i)
    for (std::size_t j = 0; j < grid.y.size(); ++j)
      grid.values[i][j] += sign * fit.increase(grid.x[i], grid.y[j]);
  return grid;
}

/// The profile between the nodes. Only what it differs by from the linearised fit is interpolated:
/// of correlated parameters the profile is a valley narrower than the grid.
GridFunction finer(const GridFunction& coarse, const Linearised& fit, int factor) {
  return with_linearised(refined(with_linearised(coarse, fit, -1.0), factor), fit, 1.0);
}

/// Every second node, from the first on.
GridFunction thinned(const GridFunction& grid) {
  GridFunction thin;
  for (std::size_t j = 0; j < grid.y.size(); j += 2) thin.y.push_back(grid.y[j]);
  for (std::size_t i = 0; i < grid.x.size(); i += 2) {
    thin.x.push_back(grid.x[i]);
    thin.values.emplace_back();
    for (std::size_t j = 0; j < grid.y.size(); j += 2)
      thin.values.back().push_back(grid.values[i][j]);
  }
  return thin;
}

/// Whether lines may be drawn between the nodes: interpolated from every second node, the others in
/// the valley tell the error, of which twice as many nodes leave at most an eighth where cubics
/// fit. Nodes without a guess, at the edge of what the model accepts, tell nothing.
bool resolved(const GridFunction& grid, const Linearised& fit) {
  const GridFunction thin = thinned(grid);
  if (!thin.valid()) return false;
  const GridFunction guess = finer(thin, fit, 2);
  double error = meshes::unknown;
  for (std::size_t i = 0; i < guess.x.size(); ++i) {
    for (std::size_t j = 0; j < guess.y.size(); ++j) {
      const bool own = i % 2 == 0 && j % 2 == 0;
      if (own || !(std::fmin(grid.values[i][j], guess.values[i][j]) < 2.0 * levels[2].increase))
        continue;
      error = std::fmax(error, std::abs(guess.values[i][j] - grid.values[i][j]));
    }
  }
  return error < 8.0 * 0.5;
}

/// All lines of one level as one curve with breaks.
Series level_series(const GridFunction& grid, const Level& level) {
  Series series{level.label, level.label, {level.colour, "", 2.2}};
  for (const Polyline& line : level_lines(grid, level.increase)) {
    for (const auto& [x, y] : line) series.add(x, y);
    series.add(meshes::unknown, meshes::unknown);
  }
  return series;
}

/// The nodes above the level before and up to `levels[k]`.
Series nodes_within(const GridFunction& grid, std::size_t k) {
  const double above = k == 0 ? -std::numeric_limits<double>::infinity() : levels[k - 1].increase;
  const std::string label = std::string("within ") + levels[k].label;
  Series series{label, label, {levels[k].colour, "", 1.0, 5, false, 0.8}};
  for (std::size_t i = 0; i < grid.x.size(); ++i)
    for (std::size_t j = 0; j < grid.y.size(); ++j)
      if (grid.values[i][j] > above && grid.values[i][j] <= levels[k].increase)
        series.add(grid.x[i], grid.y[j]);
  return series;
}

/// From the first to the last node, and to the truth, which may lie outside.
Range extent(const std::vector<double>& nodes, double truth) {
  const double margin = 0.05 * (std::fmax(nodes.back(), truth) - std::fmin(nodes.front(), truth));
  return {std::fmin(nodes.front(), truth - margin), std::fmax(nodes.back(), truth + margin)};
}

std::string axis_label(const FitParameter& parameter) {
  return parameter.shown_unit.empty() ? parameter.symbol
                                      : parameter.symbol + " [" + parameter.shown_unit + "]";
}

}  // namespace

Figure profile_figure(const Fit& fit, const std::string& prefix) {
  Figure figure{prefix + "_profile", 760, 500, 1, {}};
  const calibration::ProfileEntry& profile = *fit.file.profile;
  const std::size_t i = fit.index(profile.first), j = fit.index(profile.second);
  if (i == j || i >= fit.parameters.size() || j >= fit.parameters.size()) return figure;
  const FitParameter &first = fit.parameters[i], &second = fit.parameters[j];
  const GridFunction grid = profile_grid(profile, first, second);
  if (!grid.valid()) return figure;
  Panel panel{.x_label = axis_label(first),
              .y_label = axis_label(second),
              .x_range = extent(grid.x, first.factor * first.truth),
              .y_range = extent(grid.y, second.factor * second.truth),
              .key = "outside right top"};
  const Linearised linear = linearised(fit, i, j);
  if (resolved(grid, linear)) {
    const GridFunction fine = finer(grid, linear, 24);
    for (const Level& level : levels) panel.series.push_back(level_series(fine, level));
  } else {
    for (std::size_t k = 0; k < std::size(levels); ++k)
      panel.series.push_back(nodes_within(grid, k));
  }
  if (linear.positive()) panel.series.push_back(ellipse(linear, levels[1].increase));
  panel.series.push_back(mark_at("estimate", linear.x, linear.y, "#000000", 7));
  panel.series.push_back(
      mark_at("truth", first.factor * first.truth, second.factor * second.truth, "#D55E00", 9));
  figure.panels = {panel};
  return figure;
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
