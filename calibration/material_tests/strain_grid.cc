#include "calibration/material_tests/strain_grid.h"

#include <algorithm>
#include <cmath>

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

CurveCleaning clean(StrainCurve& curve, const std::optional<std::array<double, 2>>& range) {
  CurveCleaning removed;
  removed.empty = std::erase_if(
      curve, [](const CurveRow& row) { return std::isnan(row.x) || std::isnan(row.y); });
  removed.outside = std::erase_if(curve, [&](const CurveRow& row) {
    return range && (row.x < (*range)[0] || row.x > (*range)[1]);
  });
  if (curve.empty()) return removed;
  const double way = direction(curve);
  double farthest = -INFINITY;
  removed.backward = std::erase_if(curve, [&](const CurveRow& row) {
    const bool back = way * row.x <= farthest;
    farthest = std::max(farthest, way * row.x);
    return back;
  });
  return removed;
}

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

}  // namespace fingertip::calibration::inline material_tests
