#include "calibration/material_tests/strain_grid.h"

#include <algorithm>
#include <cmath>

#include "calibration/statistics/fit_statistics.h"

namespace fingertip::calibration::inline material_tests {

namespace {

/// 1 where the strain grows, -1 where it falls.
double direction(const StrainCurve& curve) {
  return curve.back().x >= curve.front().x ? 1.0 : -1.0;
}

/// At a strain within the curve; `way` is its direction.
double interpolated(const StrainCurve& curve, double way, double strain) {
  const auto ahead = std::ranges::lower_bound(curve, way * strain, {},
                                              [&](const CurveRow& row) { return way * row.x; });
  const std::size_t i =
      std::clamp<std::size_t>(std::size_t(ahead - curve.begin()), 1, curve.size() - 1);
  const CurveRow &a = curve[i - 1], &b = curve[i];
  return a.y + (b.y - a.y) * (strain - a.x) / (b.x - a.x);
}

}  // namespace

std::optional<StrainCurve> mean_curve(const std::vector<StrainCurve>& curves, std::size_t points) {
  const double way = direction(curves.front());
  double start = way * curves.front().front().x, end = way * curves.front().back().x;
  for (const StrainCurve& curve : curves) {
    if (direction(curve) != way) return std::nullopt;
    start = std::max(start, way * curve.front().x);
    end = std::min(end, way * curve.back().x);
  }
  if (!(start < end)) return std::nullopt;
  StrainCurve mean;
  for (std::size_t i = 0; i < points; ++i) {
    const double strain = way * (start + (end - start) * double(i) / double(points - 1));
    double sum = 0.0;
    for (const StrainCurve& curve : curves) sum += interpolated(curve, way, strain);
    mean.push_back({strain, sum / double(curves.size())});
  }
  return mean;
}

std::vector<double> factors_of(const std::vector<StrainCurve>& curves, const StrainCurve& mean) {
  std::vector<double> factors;
  const double way = direction(mean);
  for (const StrainCurve& curve : curves) {
    double product = 0.0, square = 0.0;
    for (const CurveRow& row : mean) {
      product += row.y * interpolated(curve, way, row.x);
      square += row.y * row.y;
    }
    factors.push_back(product / square);
  }
  return factors;
}

double scatter_of(const std::vector<double>& factors) {
  const auto count = double(factors.size());
  double mean = 0.0, squares = 0.0;
  for (const double factor : factors) mean += factor / count;
  for (const double factor : factors) squares += (factor - mean) * (factor - mean);
  return factors.size() < 2 ? 0.0 : std::sqrt(squares / (count - 1.0));
}

double error_of_mean(const std::vector<double>& factors) {
  if (factors.size() < 2) return 0.0;
  return student_95(int(factors.size()) - 1) / normal_95() * scatter_of(factors) /
         std::sqrt(double(factors.size()));
}

}  // namespace fingertip::calibration::inline material_tests
