#include "calibration/statistics/score_tests.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>

#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/dense.h"
#include "meshes/base/errors.h"
#include "meshes/rubber/relaxation.h"

namespace fingertip::calibration::inline statistics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Less of a change than this is round-off of what the parameters do.
constexpr double imitated = 1e-6;

/// `vector` without its part in the columns of `matrix`.
template <typename T>
T without_columns(const T& vector, const MatrixXd& matrix) {
  if (matrix.cols() == 0) return vector;
  // Columns differ in their units.
  MatrixXd scaled = matrix;
  for (Index j = 0; j < scaled.cols(); ++j)
    if (const double norm = scaled.col(j).norm(); norm > 0.0) scaled.col(j) /= norm;
  return vector - scaled * meshes::shortest_least_squares(scaled, vector);
}

double probability_of(double decrease, const CurveFit& fit) {
  if (fit.chi_square) return chi_square_above(decrease, 1);
  const double freedom = fit.degrees_of_freedom - 1.0, rest = fit.degrees_of_freedom - decrease;
  if (freedom < 1.0) return 1.0;
  if (!(rest > 0.0)) return 0.0;
  return cdf(
      complement(boost::math::fisher_f(1.0, freedom), std::max(0.0, decrease * freedom / rest)));
}

ScoreTest result(const OmittedEffect& of, double amount, double decrease, const CurveFit& fit) {
  const double all = fit.chi_square.value_or(double(fit.degrees_of_freedom));
  return {of.name,
          of.of,
          of.cause,
          of.unit,
          amount,
          decrease,
          probability_of(decrease, fit),
          all > 0.0 ? std::min(1.0, decrease / all) : 0.0,
          of.share_of};
}

}  // namespace

std::vector<ScoreTest> score_tests(const CurveFit& fit, const CurveFitOptions& options,
                                   const std::vector<OmittedEffect>& effects) {
  const Index values = fit.jacobian.rows(), count = fit.jacobian.cols();
  const Index priors = std::ranges::count_if(
      options.free, [](const FreeParameter& free) { return bool(free.prior); });
  MatrixXd jacobian = MatrixXd::Zero(values + priors, count);
  VectorXd residuals(values + priors);
  jacobian.topRows(values) = fit.jacobian;
  residuals.head(values) = fit.whitening * stacked(fit.residuals);
  Index row = values;
  for (Index j = 0; j < std::min(count, Index(options.free.size())); ++j)
    if (const auto& prior = options.free[std::size_t(j)].prior) {
      residuals(row) = (prior->mean - fit.estimates(j)) / prior->deviation;
      jacobian(row++, j) = 1.0 / prior->deviation;
    }
  std::vector<ScoreTest> found;
  for (const OmittedEffect& effect : effects) {
    if (effect.change.size() != values)
      throw meshes::InvalidInput(
          {"effects." + effect.name, std::to_string(effect.change.size()) + " values",
           "a change has a number per value of all curves", "give one for these curves"});
    VectorXd change = VectorXd::Zero(values + priors);
    change.head(values) = fit.whitening * effect.change;
    const double size = change.norm();
    change = without_columns(change, jacobian);
    if (!(change.norm() > imitated * size)) continue;
    const double shared = change.dot(residuals), square = change.squaredNorm();
    const double amount = std::clamp(shared / square, effect.least, effect.most);
    const double decrease = std::max(0.0, amount * (2.0 * shared - amount * square));
    found.push_back(result(effect, amount, decrease, fit));
  }
  std::ranges::stable_sort(found, std::greater<>(), &ScoreTest::decrease);
  return found;
}

ScoreTest score_test(const CurveFit& before, const CurveFit& after, const OmittedEffect& what) {
  if (before.chi_square.has_value() != after.chi_square.has_value())
    throw meshes::InvalidInput({"effects." + what.name, "sigma of one fit alone",
                                "chi-square is compared with chi-square",
                                "do both fits with the same curves and loss"});
  const double variance = std::max(std::pow(before.residual_deviation, 2), 1e-300);
  const double decrease = std::max(
      0.0, before.chi_square
               ? *before.chi_square - *after.chi_square
               : (sum_of_squares(before.residuals) - sum_of_squares(after.residuals)) / variance);
  return result(what, after.estimates(after.estimates.size() - 1), decrease, before);
}

VectorXd relaxation_change(const VectorXd& forces, const std::vector<double>& times,
                           double constant) {
  if (forces.size() != Index(times.size()))
    throw meshes::InvalidInput({"effects.times", std::to_string(times.size()) + " values",
                                "every force has its time", "give one for each"});
  VectorXd change(forces.size());
  double alive = forces.size() > 0 ? forces(0) : 0.0;  // of the branch, over its weight
  for (Index k = 0; k < forces.size(); ++k) {
    if (k > 0) {
      const meshes::PronyRecursion step(times[std::size_t(k)] - times[std::size_t(k - 1)],
                                        constant);
      alive = alive * step.decay + (forces(k) - forces(k - 1)) * step.gain;
    }
    change(k) = alive - forces(k);
  }
  return change;
}

double fading_of(const LoadingHistory& course, const VectorXd& forces, const std::vector<double>& x,
                 const std::vector<double>& times, double constant) {
  const Index count = forces.size();
  double weight = 0.0;
  if (course.loop > 0.0) {
    // There and back.
    VectorXd both(2 * count);
    both << forces, forces.reverse();
    std::vector<double> when = times;
    for (Index k = count; k-- > 0;) when.push_back(2.0 * times.back() - times[std::size_t(k)]);
    const VectorXd change = relaxation_change(both, when, constant);
    double done = 0.0, faded = 0.0, lost = 0.0;
    for (Index k = 1; k < count; ++k) {
      const double dx = x[std::size_t(k)] - x[std::size_t(k - 1)];
      const auto gap = [&](Index i) { return change(i) - change(2 * count - 1 - i); };
      done += 0.5 * (forces(k) + forces(k - 1)) * dx;
      faded += 0.5 * (change(k) + change(k - 1)) * dx;
      lost += 0.5 * (gap(k) + gap(k - 1)) * dx;
    }
    // loop = w lost / (done + w faded)
    if (lost > 0.0) weight = course.loop * done / (lost - course.loop * faded);
  }
  if (course.relaxation > 0.0 && course.hold_time > 0.0) {
    // relaxation = w alive fades / (1 + w (alive - 1))
    const double alive = 1.0 +
                         relaxation_change(forces, times, constant)(count - 1) / forces(count - 1),
                 fades = -std::expm1(-course.hold_time / constant);
    weight =
        std::max(weight, course.relaxation / (alive * fades - course.relaxation * (alive - 1.0)));
  }
  return weight;
}

VectorXd narrowing(const MatrixXd& covariance, const MatrixXd& rows, const MatrixXd& own) {
  // In units of the standard errors, so that parameters of all units are alike.
  const VectorXd errors = covariance.diagonal().cwiseSqrt();
  const MatrixXd correlation =
      errors.cwiseInverse().asDiagonal() * covariance * errors.cwiseInverse().asDiagonal();
  const MatrixXd seen = without_columns(MatrixXd(rows * errors.asDiagonal()), own);
  // (C⁻¹ + SᵀS)⁻¹ = C - C Sᵀ (1 + S C Sᵀ)⁻¹ S C, also for a C that is nearly singular.
  const MatrixXd shared = seen * correlation;
  const MatrixXd sum = MatrixXd::Identity(seen.rows(), seen.rows()) + shared * seen.transpose();
  const MatrixXd after = correlation - shared.transpose() * sum.ldlt().solve(shared);
  return after.diagonal().cwiseMax(0.0).cwiseSqrt();
}

}  // namespace fingertip::calibration::inline statistics
