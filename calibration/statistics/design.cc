#include "calibration/statistics/design.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "calibration/files/words.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Variances beyond this many squares of a column's size are those of what nothing tells.
constexpr double no_less = 1e-300;

void check_observations(const Observations& seen, std::size_t parameters) {
  const Index values = seen.jacobian.rows(), errors = seen.model_covariance.rows();
  std::vector<meshes::Violation> found;
  if (seen.jacobian.cols() != Index(parameters))
    found.push_back({"jacobian", std::to_string(seen.jacobian.cols()) + " columns",
                     "every parameter has a column", "give " + std::to_string(parameters)});
  const bool positive = seen.deviation.size() == values && seen.deviation.allFinite() &&
                        (values == 0 || seen.deviation.minCoeff() > 0.0);
  if (!positive)
    found.push_back({"deviation", std::to_string(seen.deviation.size()) + " values",
                     "every value has a deviation, > 0", "state the noise of the force"});
  if (errors != 0 && (errors != values || seen.model_covariance.cols() != values))
    found.push_back({"model_covariance", std::to_string(errors) + " rows",
                     "a covariance has a row and a column per value", "give none, or all"});
  if (!found.empty()) throw meshes::InvalidInput(found);
}

/// L⁻¹ J with L Lᵀ = S + M, in units of the deviations.
MatrixXd whitened(const Observations& seen) {
  MatrixXd jacobian = seen.deviation.cwiseInverse().asDiagonal() * seen.jacobian;
  if (seen.model_covariance.size() == 0) return jacobian;
  const VectorXd inverse = seen.deviation.cwiseInverse();
  MatrixXd sum = inverse.asDiagonal() * seen.model_covariance * inverse.asDiagonal();
  sum.diagonal().array() += 1.0;
  const Eigen::LLT<MatrixXd> root(sum);
  if (root.info() != Eigen::Success)
    throw meshes::InvalidInput({"model_covariance", "indefinite",
                                "a covariance has no negative "
                                "variance",
                                "give a positive semidefinite matrix"});
  root.matrixL().solveInPlace(jacobian);
  return jacobian;
}

/// ln of the geometric mean of the first `count`.
double mean_gain(const MeasurementGain& entry, std::size_t count) {
  const Index n = std::min<Index>(Index(count), entry.times.size());
  return n == 0 ? -1.0 : entry.times.head(n).array().log().mean();
}

}  // namespace

MatrixXd predicted_covariance(const Observations& observations,
                              const std::vector<FreeParameter>& free) {
  check_observations(observations, free.size());
  MatrixXd rows = whitened(observations);
  const Index values = rows.rows(), count = rows.cols();
  rows.conservativeResize(values + count, Eigen::NoChange);
  rows.bottomRows(count).setZero();
  for (Index j = 0; j < count; ++j)
    if (const auto& prior = free[std::size_t(j)].prior)
      rows(values + j, j) = 1.0 / prior->deviation;
  // Parameters of all units are alike in what of them one row would tell.
  const VectorXd sizes =
      rows.colwise().norm().cwiseMax(no_less).cwiseInverse().cwiseMin(1e150).transpose();
  return Sensitivity(rows, sizes).covariance();
}

std::vector<CollinearPair> nearly_collinear(const MatrixXd& covariance) {
  std::vector<CollinearPair> pairs;
  for (Index i = 0; i < covariance.rows(); ++i)
    for (Index j = i + 1; j < covariance.cols(); ++j) {
      const double correlation = covariance(i, j) / std::sqrt(covariance(i, i) * covariance(j, j));
      const double times = 1.0 / std::sqrt(std::max(1e-12, 1.0 - correlation * correlation));
      if (times >= much_wider)
        pairs.push_back({std::size_t(i), std::size_t(j), correlation, times});
    }
  std::ranges::stable_sort(pairs, std::greater<>(), &CollinearPair::times);
  return pairs;
}

void sort_by_gain(std::vector<MeasurementGain>& gains, std::size_t decisive) {
  std::ranges::stable_sort(gains, std::greater<>(),
                           [&](const MeasurementGain& each) { return mean_gain(each, decisive); });
}

std::vector<NextEntry> next_entries(const std::vector<MeasurementGain>& gains,
                                    const std::vector<std::string>& labels,
                                    const Eigen::VectorXd& at, const Eigen::VectorXd& lower,
                                    const Eigen::VectorXd& upper) {
  std::vector<NextEntry> entries;
  for (const MeasurementGain& each : gains) {
    NextEntry& entry = entries.emplace_back(NextEntry{each.name, each.press, {}, each.failure});
    for (Eigen::Index i = 0; i < each.times.size(); ++i) {
      const double times = each.times(i);
      entry.parameters.push_back({labels[std::size_t(i)], at(i) - (at(i) - lower(i)) / times,
                                  at(i) + (upper(i) - at(i)) / times, times});
    }
  }
  return entries;
}

std::string gain_statement(const std::vector<MeasurementGain>& sorted,
                           const std::vector<std::string>& labels, std::size_t decisive) {
  if (sorted.empty() || sorted.front().times.size() == 0) return "";
  const MeasurementGain& best = sorted.front();
  constexpr double worth_it = 1.1;
  const Eigen::Index asked = std::min<Index>(Index(decisive), best.times.size());
  std::string names, gains;
  for (std::size_t i = 0; i < std::min(decisive, labels.size()); ++i) {
    const std::string name = (i == 0 ? "" : ", ") + labels[i];
    names += name;
    gains += name + " " + rounded(best.times(Index(i)), 3) + " times";
  }
  if (asked > 0 && best.times.head(asked).maxCoeff() < worth_it)
    return "None of the further measurements tried would make the interval of " + names +
           " a tenth narrower.";
  return "Of the further measurements tried, " + best.name + " would tell most (" + best.press +
         "): it would make the intervals narrower, " + gains + ".";
}

}  // namespace fingertip::calibration::inline statistics
