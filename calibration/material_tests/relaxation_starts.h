/// Where the search for the branches of a relaxation begins.
#pragma once

#include <optional>
#include <vector>

#include "calibration/material_tests/law_result.h"
#include "calibration/statistics/fit_options.h"

namespace fingertip::calibration::inline material_tests {

/// From the first to the last time that any of the tests tells of (observed_times); none where all
/// are slow.
std::optional<std::array<double, 2>> observed_times(const std::vector<MaterialTest>& tests);

/// Frees share and time of every branch beside the coefficients of the law, which begin where
/// `without`, the same law without branches, has them. Times are drawn from a grid of two per
/// decade of the observed times: a law of given shape is a sum over G_inf and G_inf b_i, so that
/// these follow from non-negative least squares for every choice of times; the best one begins. A
/// further search goes on from `fewer`, the fit of one branch less, so that what has more branches
/// is not worse.
void add_branches(const std::vector<MaterialTest>& tests,
                  const std::vector<std::vector<double>>& scales, const LawChoice& choice,
                  const LawFit& without, const LawFit& fewer, CurveFitOptions& options);

/// Of a fit whose branches are not the fastest first: the same in that order, as a start; else
/// none.
std::optional<Eigen::VectorXd> sorted_branches(const LawChoice& choice,
                                               const Eigen::VectorXd& estimates);

}  // namespace fingertip::calibration::inline material_tests
