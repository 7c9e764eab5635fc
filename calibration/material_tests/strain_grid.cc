#include "calibration/material_tests/strain_grid.h"

#include <algorithm>
#include <cmath>

namespace fingertip::calibration::inline material_tests {

namespace {

/// 1 where the strain grows, -1 where it falls.
double direction(const StrainCurve& curve) {
  return curve.strain.back() >= curve.strain.front() ? 1.0 : -1.0;
}

/// At a strain within the curve; `way` is its direction.
double interpolated(const StrainCurve& curve, double way, double strain) {
  const auto ahead = std::ranges::lower_bound(curve.strain, way * strain, {},
                                              [&](double value) { return way * value; });
  const std::size_t last = curve.strain.size() - 1;
  const std::size_t i = std::clamp<std::size_t>(std::size_t(ahead - curve.strain.begin()), 1, last);
  const double a = curve.strain[i - 1], b = curve.strain[i];
  return curve.stress[i - 1] + (curve.stress[i] - curve.stress[i - 1]) * (strain - a) / (b - a);
}

}  // namespace

void StrainCurve::keep(std::size_t first, std::size_t end) {
  for (std::vector<double>* column : {&strain, &stress, &sigma}) {
    if (column->empty()) continue;
    column->resize(end);
    column->erase(column->begin(), column->begin() + std::ptrdiff_t(first));
  }
}

CurveCleaning clean(StrainCurve& curve, const std::optional<std::array<double, 2>>& range) {
  CurveCleaning removed;
  StrainCurve whole;
  for (std::size_t i = 0; i < curve.strain.size(); ++i) {
    const double strain = curve.strain[i];
    if (std::isnan(strain) || std::isnan(curve.stress[i])) {
      ++removed.empty;
    } else if (range && (strain < (*range)[0] || strain > (*range)[1])) {
      ++removed.outside;
    } else {
      whole.strain.push_back(strain);
      whole.stress.push_back(curve.stress[i]);
      if (!curve.sigma.empty()) whole.sigma.push_back(curve.sigma[i]);
    }
  }
  curve = StrainCurve();
  if (whole.strain.empty()) return removed;
  const double way = direction(whole);
  for (std::size_t i = 0; i < whole.strain.size(); ++i) {
    if (!curve.strain.empty() && way * whole.strain[i] <= way * curve.strain.back()) {
      ++removed.backward;
      continue;
    }
    curve.strain.push_back(whole.strain[i]);
    curve.stress.push_back(whole.stress[i]);
    if (!whole.sigma.empty()) curve.sigma.push_back(whole.sigma[i]);
  }
  return removed;
}

std::optional<StrainCurve> mean_curve(const std::vector<StrainCurve>& curves, std::size_t points) {
  const double way = direction(curves.front());
  double start = way * curves.front().strain.front(), end = way * curves.front().strain.back();
  for (const StrainCurve& curve : curves) {
    if (direction(curve) != way) return std::nullopt;
    start = std::max(start, way * curve.strain.front());
    end = std::min(end, way * curve.strain.back());
  }
  if (!(start < end)) return std::nullopt;
  StrainCurve mean;
  for (std::size_t i = 0; i < points; ++i) {
    const double strain = way * (start + (end - start) * double(i) / double(points - 1));
    double sum = 0.0;
    for (const StrainCurve& curve : curves) sum += interpolated(curve, way, strain);
    mean.strain.push_back(strain);
    mean.stress.push_back(sum / double(curves.size()));
  }
  return mean;
}

}  // namespace fingertip::calibration::inline material_tests
