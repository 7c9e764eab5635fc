#include "calibration/material_tests/relaxation_starts.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/material_tests/law_starts.h"
#include "calibration/statistics/non_negative.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr int times_per_decade = 2, max_times = 13;
/// Times are sought so far beyond those that the tests tell of.
constexpr double beyond = 30.0;
/// A branch begins with no less, and so does what is left after long times.
constexpr double min_share = 0.005, min_rest = 0.02;

VectorXd law_part(const LawChoice& choice, const VectorXd& coefficients) {
  return coefficients.head(Index(law_coefficients(choice).size()));
}

std::vector<double> time_grid(const std::array<double, 2>& times, int branches) {
  const double decades = std::log10(times[1] / times[0]);
  const int count = std::clamp(int(times_per_decade * decades) + 1, branches, max_times);
  std::vector<double> grid;
  for (int i = 0; i < count; ++i)
    grid.push_back(times[0] * std::pow(10.0, decades * (i + 0.5) / count));
  return grid;
}

/// What the law's stresses after long times, and b = 1 of every time of the grid, make of all
/// points, in columns; then the stresses measured. Over their scales.
Eigen::MatrixXd columns_of(const std::vector<MaterialTest>& tests,
                           const std::vector<std::vector<double>>& scales, const LawChoice& law,
                           const VectorXd& coefficients, const std::vector<double>& grid) {
  Index points = 0;
  for (const MaterialTest& test : tests) points += Index(test.stress.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(points, Index(grid.size()) + 2);
  Index row = 0;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const MaterialTest& test = tests[t];
    if (test.kind == TestKind::volumetric) continue;
    LawModel model(test, scales[t], law, law_coefficients(law));
    const Index n = Index(test.stress.size());
    columns.col(0).segment(row, n) = model.evaluate(coefficients).value;
    const auto put = [&](Index column, const PartTable& parts) {
      for (Index p = 0; p < n; ++p)
        columns(row + p, column) = model.scaled(std::size_t(p), parts.row(p).head<2>());
    };
    if (!model.course().empty()) {
      const PartTable equilibrium = model.equilibrium_parts(coefficients).leftCols(2);
      for (std::size_t i = 0; i < grid.size(); ++i)
        put(Index(i) + 1, model.course().branch(equilibrium, grid[i]).held);
    }
    for (Index p = 0; p < n; ++p)
      columns(row + p, columns.cols() - 1) =
          test.stress[std::size_t(p)] / scales[t][std::size_t(p)];
    row += n;
  }
  return columns.topRows(row);
}

/// The factors on the law's stresses and those of its branches, for the best choice of times.
struct Branches {
  std::vector<std::size_t> times;
  VectorXd factors;
  double misfit = std::numeric_limits<double>::infinity();
};

Branches best_branches(const Eigen::MatrixXd& columns, std::size_t count) {
  const VectorXd measured = columns.col(columns.cols() - 1);
  const std::size_t grid = std::size_t(columns.cols()) - 2;
  Branches best;
  std::vector<char> taken(grid, 0);
  std::fill(taken.begin(), taken.begin() + std::ptrdiff_t(count), 1);
  do {
    Branches one;
    Eigen::MatrixXd chosen(columns.rows(), Index(count) + 1);
    chosen.col(0) = columns.col(0);
    for (std::size_t i = 0; i < grid; ++i) {
      if (taken[i] == 0) continue;
      one.times.push_back(i);
      chosen.col(Index(one.times.size())) = columns.col(Index(i) + 1);
    }
    const VectorXd sizes = chosen.colwise().norm();
    if (!(sizes.minCoeff() > 0.0)) continue;
    try {
      chosen = chosen * sizes.cwiseInverse().asDiagonal();
      one.factors = non_negative_least_squares(chosen, measured);
      one.misfit = (chosen * one.factors - measured).squaredNorm();
      one.factors = one.factors.cwiseQuotient(sizes);
      if (one.misfit < best.misfit) best = one;
    } catch (const meshes::NotConverged&) {
      continue;
    }
  } while (std::prev_permutation(taken.begin(), taken.end()));
  return best;
}

/// Coefficients, shares and times of factors; none is nothing.
VectorXd start_of(const LawChoice& choice, const VectorXd& law, const Branches& branches,
                  const std::vector<double>& grid) {
  const Index own = law.size(), count = Index(branches.times.size());
  VectorXd factors = branches.factors;
  const double sum = factors.sum();
  factors(0) = std::max(factors(0), min_rest * sum);
  factors.tail(count) = factors.tail(count).cwiseMax(min_share * sum);
  VectorXd start(own + 2 * count);
  const std::vector<MaterialParameter> names = law_coefficients(choice);
  for (Index i = 0; i < own; ++i)
    start(i) = law(i) * (unit(names[std::size_t(i)]) == "Pa" ? factors(0) : 1.0);
  for (Index i = 0; i < count; ++i) {
    start(own + 2 * i) = factors(i + 1) / factors.sum();
    start(own + 2 * i + 1) = grid[branches.times[std::size_t(i)]];
  }
  return start;
}

/// A fit of fewer branches with a small one in the middle of the widest gap between its times.
VectorXd with_branch(const LawChoice& choice, const VectorXd& fewer,
                     const std::array<double, 2>& times) {
  const Index own = Index(law_coefficients(choice).size());
  std::vector<double> marks = {times[0], times[1]};
  for (Index i = own + 1; i < own + 2 * (choice.branches - 1); i += 2) marks.push_back(fewer(i));
  std::ranges::sort(marks);
  std::size_t widest = 1;
  for (std::size_t i = 1; i < marks.size(); ++i)
    if (marks[i] / marks[i - 1] > marks[widest] / marks[widest - 1]) widest = i;
  double left = 1.0;
  for (Index i = own; i < own + 2 * (choice.branches - 1); i += 2) left -= fewer(i);
  VectorXd start(own + 2 * choice.branches);
  start.head(start.size() - 2) = fewer.head(start.size() - 2);
  start.tail(2) << min_share * left, std::sqrt(marks[widest] * marks[widest - 1]);
  return sorted_branches(choice, start).value_or(start);
}

}  // namespace

std::optional<std::array<double, 2>> observed_times(const std::vector<MaterialTest>& tests) {
  std::optional<std::array<double, 2>> all;
  for (const MaterialTest& test : tests) {
    if (test.course == TestCourse::slow) continue;
    const auto own = observed_times(test);
    all = all ? std::array{std::min((*all)[0], own[0]), std::max((*all)[1], own[1])} : own;
  }
  return all;
}

void add_branches(const std::vector<MaterialTest>& tests,
                  const std::vector<std::vector<double>>& scales, const LawChoice& choice,
                  const LawFit& without, const LawFit& fewer, CurveFitOptions& options) {
  const std::array<double, 2> times = *observed_times(tests);
  const VectorXd law = law_part(choice, without.fit.estimates);
  const std::vector<double> grid = time_grid(times, choice.branches);
  const Branches best = best_branches(columns_of(tests, scales, without.choice, law, grid),
                                      std::size_t(choice.branches));
  std::vector<VectorXd> starts;
  if (std::isfinite(best.misfit)) starts.push_back(start_of(choice, law, best, grid));
  starts.push_back(with_branch(choice, fewer.fit.estimates, times));
  const std::vector<MaterialParameter> names = coefficients(choice);
  for (std::size_t i = options.free.size(); i < names.size(); ++i) {
    FreeParameter free{names[i], 0.0, 0.0, 1.0};
    if (unit(names[i]) == "s") {
      free.lower = times[0] / beyond;
      free.upper = beyond * times[1];
      free.scale = std::sqrt(times[0] * times[1]);
    } else {
      free.scale = 0.05;
    }
    options.free.push_back(free);
  }
  for (VectorXd& start : starts) start = within_bounds(std::move(start), options.free);
  for (Index i = 0; i < starts.front().size(); ++i)
    options.free[std::size_t(i)].start = starts.front()(i);
  options.other_starts.assign(starts.begin() + 1, starts.end());
}

std::optional<VectorXd> sorted_branches(const LawChoice& choice, const VectorXd& estimates) {
  const Index own = Index(law_coefficients(choice).size());
  std::vector<Index> order(std::size_t(choice.branches));
  std::iota(order.begin(), order.end(), Index(0));
  const auto time = [&](Index n) { return estimates(own + 2 * n + 1); };
  if (std::ranges::is_sorted(order, {}, time)) return std::nullopt;
  std::ranges::sort(order, {}, time);
  VectorXd sorted = estimates;
  for (Index n = 0; n < choice.branches; ++n)
    sorted.segment<2>(own + 2 * n) = estimates.segment<2>(own + 2 * order[std::size_t(n)]);
  return sorted;
}

}  // namespace fingertip::calibration::inline material_tests
