#include "calibration/press_fit/rig_estimates.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline press_fit {
namespace {

/// A line y = a + s x, and the standard error of s.
struct Regression {
  double slope = 0.0, error = 0.0;
};

Regression line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = double(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n,
               mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double sxx = 0.0, sxy = 0.0, left = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sxx += (x[i] - mean_x) * (x[i] - mean_x);
    sxy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = sxy / sxx;
  for (std::size_t i = 0; i < x.size(); ++i)
    left += std::pow(y[i] - mean_y - slope * (x[i] - mean_x), 2);
  return {slope, std::sqrt(left / ((n - 2.0) * sxx))};
}

}  // namespace

double apparent_touch(const Curve& curve, double zero, double compliance, double force) {
  constexpr double lowest_share = 0.05, highest_share = 0.4;
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double f = curve.y[i] - zero;
    if (f < lowest_share * force || f > highest_share * force) continue;
    const double x = curve.x[i] - compliance * f - curve.x.front(), y = std::cbrt(f * f);
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  if (n < 2.0 || !(slope > 0.0)) return curve.x.front();
  return curve.x.front() + (sx - sy / slope) / n;
}

Prior compliance_of_blank(const Curve& curve) {
  constexpr double lowest_of_line = 0.1, min_error = 1e-4;
  constexpr std::size_t min_forces = 6;
  const double zero = curve.y.front(), largest = *std::ranges::max_element(curve.y) - zero;
  std::vector<double> x, y;
  for (std::size_t i = 0; i < curve.y.size(); ++i)
    if (curve.y[i] - zero >= lowest_of_line * largest)
      x.push_back(curve.x[i]), y.push_back(curve.y[i]);
  const auto refuse = [&](const std::string& value, const char* rule, const char* remedy) {
    throw meshes::InvalidInput(
        {"calibration.rig", "blank " + curve.name + ": " + value, rule, remedy});
  };
  if (x.size() < min_forces)
    refuse(std::to_string(x.size()) + " forces above a tenth of the largest",
           "a line needs six or more", "press the blank again, in smaller steps");
  const auto middle = std::ptrdiff_t(x.size() / 2);
  const Regression whole = line_through(x, y),
                   lower = line_through({x.begin(), x.begin() + middle},
                                        {y.begin(), y.begin() + middle}),
                   upper =
                       line_through({x.begin() + middle, x.end()}, {y.begin() + middle, y.end()});
  if (!(whole.slope > 0.0))
    refuse("the force does not grow with the travel", "a blank is pressed as a finger is",
           "turn the sign of position or force (studies/manual/your_press.md)");
  const double c = 1.0 / whole.slope;
  const double error = c * whole.error / whole.slope * student_95(int(x.size()) - 2) / normal_95();
  // Of a c that is equally likely anywhere between those of the halves.
  double bent = 0.0;
  if (lower.slope > 0.0 && upper.slope > 0.0) {
    const double noise = std::hypot(lower.error / (lower.slope * lower.slope),
                                    upper.error / (upper.slope * upper.slope)),
                 apart = std::abs(1.0 / lower.slope - 1.0 / upper.slope);
    if (apart > 3.0 * noise) bent = apart / std::sqrt(12.0);
  }
  return {c, std::max(std::hypot(error, bent), min_error * c)};
}

}  // namespace fingertip::calibration::inline press_fit
