/// What a fit has found, as files have it.
#pragma once

#include <string>
#include <vector>

#include "calibration/files/fit_file.h"
#include "calibration/statistics/fit_result.h"

namespace fingertip::calibration::inline statistics {

inline std::vector<std::vector<double>> rows(const Eigen::MatrixXd& matrix) {
  std::vector<std::vector<double>> rows;
  for (const auto& row : matrix.rowwise()) rows.emplace_back(row.begin(), row.end());
  return rows;
}

inline std::vector<MinimumEntry> minimum_entries(const CurveFit& fit) {
  std::vector<MinimumEntry> entries;
  for (const Minimum& minimum : fit.minima)
    entries.push_back({{minimum.estimates.begin(), minimum.estimates.end()},
                       minimum.loss,
                       minimum.iterations,
                       minimum.converged});
  return entries;
}

/// Without start, prior and kind of interval.
inline ParameterEntry parameter_entry(const CurveFit& fit, std::size_t i) {
  const Eigen::Index at = Eigen::Index(i);
  ParameterEntry entry;
  entry.name = name(fit.parameters[i]);
  entry.unit = unit(fit.parameters[i]);
  entry.estimate = fit.estimates(at);
  entry.standard_error = fit.standard_errors(at);
  entry.lower = fit.lower(at);
  entry.upper = fit.upper(at);
  entry.at_bound = fit.at_bound[i];
  return entry;
}

}  // namespace fingertip::calibration::inline statistics
