#include "studies/fits/models/held_back.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "calibration/statistics/curve_checks.h"
#include "calibration/statistics/posterior.h"
#include "calibration/statistics/value_errors.h"
#include "meshes/base/dense.h"
#include "meshes/base/errors.h"
#include "meshes/press/no_equilibrium.h"
#include "studies/fits/models/fit_repeats.h"
#include "studies/fits/models/measurement_gains.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::ForwardModel;
using calibration::FreeParameter;
using calibration::PredictedEntry;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A share of 5 % of so many is known within 0.7 %.
constexpr Index draw_count = 4000;

/// Columns L with L Lᵀ the covariance, but for a ten thousandth of it.
MatrixXd root_of(const MatrixXd& covariance) {
  constexpr double negligible = 1e-4;
  const meshes::EigenPairs eigen = meshes::symmetric_eigen(covariance);
  const VectorXd variances = eigen.values.cwiseMax(0.0);  // increasing
  const double sum = variances.sum();
  Index left_out = 0;
  for (double small = 0.0; left_out < variances.size(); ++left_out)
    if ((small += variances(left_out)) > negligible * sum) break;
  const Index kept = variances.size() - left_out;
  return eigen.vectors.rightCols(kept) *
         variances.tail(kept).cwiseSqrt().asDiagonal().toDenseMatrix();
}

/// One press that was held back, behind the curves of the fit.
class HeldBack {
 public:
  /// `place`: of the press among the curves of `all`, whose models these are.
  HeldBack(const FitInput& fitted, const FitInput& all, std::size_t place,
           const std::vector<ForwardModel*>& models, const calibration::FitRecord& record)
      : record_(record), input_(all), parameters_(Index(fitted.options.free.size())) {
    input_.curves.assign(fitted.curves.begin(), fitted.curves.end());
    models_.assign(models.begin(), models.begin() + std::ptrdiff_t(fitted.curves.size()));
    input_.curves.push_back(all.curves[place]);
    models_.push_back(models[place]);
    std::vector<FreeParameter>& free = input_.options.free;
    for (Index j = 0; j < parameters_; ++j) free[std::size_t(j)].start = record.fit.estimates(j);
    const FitCurve& own = input_.curves.back();
    for (const auto member : calibration::rig_members)
      if (const auto of_rig = own.travel ? (own.travel->rig.*member).place : std::nullopt;
          of_rig && *of_rig >= parameters_)
        own_.push_back(*of_rig);
    if (own.y.size() <= own_.size())
      throw meshes::InvalidInput(
          {own.name, std::to_string(own.y.size()) + " values",
           std::to_string(own_.size()) + " quantities of its machine are estimated from them",
           "give more rows, or tell the machine (calibration.rig)"});
    known_ = first_value(input_.curves, fitted.curves.size());
    while (models_.back()->refine(start_of(input_.options))) {
    }
  }

  PredictedEntry foretold() {
    constexpr int rounds = 3;
    draw();
    for (int round = 0; round < rounds && !own_.empty(); ++round) {
      estimate_own();
      draw();
    }
    const VectorXd left = estimate_own();
    return entry_of(left, as_left(left.size()));
  }

 private:
  /// What the fit makes of the press's values less those computed at the start of the options.
  void draw() {
    const VectorXd at = start_of(input_.options);
    const std::vector<calibration::Curve> curves = curves_of(input_);
    calibration::LinearisedFit all =
        calibration::linearised(curves, models_, input_.options.free, at);
    const ForceAndDepth pressed =
        presses_at(input_, at, calibration::all_values(curves) - all.residuals);
    std::vector<calibration::ErrorComponent> components =
        components_of(input_, pressed, input_.curves.size() - 1);
    const MatrixXd relative = relative_model_error(
        presses_of_values(input_), input_.with_lattice_error, known_errors_at_values(input_));
    if (relative.size() > 0)
      components.push_back({pressed.force.asDiagonal() * root_of(relative), 1.0, true});
    VectorXd told = told_deviations(input_, record_.fit.residual_deviation);
    for (const calibration::OddValue& odd : record_.odd)  // counts for nothing
      told(first_value(curves, odd.curve) + Index(odd.place)) *= 1e3;
    const Index values = all.residuals.size() - known_;
    told.tail(values) *= noise_ratio();
    slopes_ = all.jacobian.bottomRows(values);
    calibration::FurtherValues further{slopes_.leftCols(parameters_), {}, told.tail(values)};
    for (calibration::ErrorComponent& each : components) {
      further.columns.emplace_back(each.columns.bottomRows(values));
      each.columns = each.columns.topRows(known_).eval();
    }
    const VectorXd computed =
        calibration::all_values(curves).head(known_) - all.residuals.head(known_);
    calibration::LinearisedFit fit;
    fit.residuals = all.residuals.head(known_);
    fit.jacobian = all.jacobian.topLeftCorner(known_, parameters_);
    fit.estimates = at.head(parameters_);
    fit.free.assign(input_.options.free.begin(), input_.options.free.begin() + parameters_);
    calibration::put_normal_priors(fit.free, std::vector(fit.free), fit.estimates);
    fit.deviations = told.head(known_);
    fit.noise_told = !curves.front().sigma.empty();
    if (!fit.noise_told)
      fit.least_noise = calibration::PosteriorInput().least_told * computed.cwiseAbs().maxCoeff() /
                        fit.deviations.minCoeff();
    draws_ = calibration::further_values(fit, components, further, draw_count);
    mean_ = draws_.rowwise().mean();
    draws_.colwise() -= mean_;
    MatrixXd covariance = draws_ * draws_.transpose() / double(draws_.cols());
    covariance.diagonal() *= 1.0 + 1e-9;
    weight_ = covariance.llt().solve(MatrixXd::Identity(values, values));
  }

  /// Of the press's values over those of the fit, as far as rows of their files tell it.
  double noise_ratio() const {
    const std::vector<FitCurve>& curves = input_.curves;
    if (!curves.front().sigma.empty()) return 1.0;
    double squares = 0.0;
    for (std::size_t i = 0; i + 1 < curves.size(); ++i)
      squares += std::pow(curves[i].course.noise_of_value(), 2) / double(curves.size() - 1);
    const double ratio = curves.back().course.noise_of_value() / std::sqrt(squares);
    return std::isfinite(ratio) && ratio > 0.0 ? ratio : 1.0;
  }

  /// The press's own parameters by its values; what is left of these, measured less foretold.
  VectorXd estimate_own() {
    constexpr int steps = 20;
    const VectorXd measured = values_of(input_.curves.back());
    for (int step = 0;; ++step) {
      const VectorXd at = start_of(input_.options);
      const calibration::CurveSlopes now = models_.back()->evaluate(at);
      const VectorXd left = measured - now.value - mean_;
      slopes_ = now.jacobian;
      if (step == steps || own_.empty() || !make_step(left)) return left;
    }
  }

  /// Slopes of the press's own parameters, and how sure these are without its values.
  MatrixXd own_slopes() const { return slopes_(Eigen::all, own_); }
  std::vector<FreeParameter> own_free() const {
    std::vector<FreeParameter> free;
    for (const Index j : own_) free.push_back(input_.options.free[std::size_t(j)]);
    VectorXd at(Index(free.size()));
    for (Index k = 0; k < at.size(); ++k) at(k) = free[std::size_t(k)].start;
    calibration::put_normal_priors(free, std::vector(free), at);
    return free;
  }
  /// How values off by some amount move them: (Aᵀ W A + P)⁻¹ Aᵀ W, and (...)⁻¹ P.
  struct Response {
    MatrixXd by_values, by_priors;
  };
  Response response() const {
    const MatrixXd slopes = own_slopes();
    const std::vector<FreeParameter> free = own_free();
    MatrixXd matrix = slopes.transpose() * weight_ * slopes;
    MatrixXd priors = MatrixXd::Zero(matrix.rows(), matrix.cols());
    for (Index k = 0; k < matrix.rows(); ++k)
      if (const auto& prior = free[std::size_t(k)].prior)
        priors(k, k) = std::pow(prior->deviation, -2);
    matrix += priors;
    const VectorXd units = matrix.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
    const Eigen::LDLT<MatrixXd> factor(units.asDiagonal() * matrix * units.asDiagonal());
    const auto solved = [&](const MatrixXd& right) -> MatrixXd {
      return units.asDiagonal() * factor.solve(units.asDiagonal() * right);
    };
    return {solved(slopes.transpose() * weight_), solved(priors)};
  }
  bool make_step(const VectorXd& left) {
    constexpr double close = 1e-3;  // of what a deviation of the values makes
    const Response moved = response();
    std::vector<FreeParameter>& free = input_.options.free;
    VectorXd away(Index(own_.size()));
    for (std::size_t k = 0; k < own_.size(); ++k) {
      const FreeParameter& own = free[std::size_t(own_[k])];
      away(Index(k)) = own.prior ? own.prior->mean - own.start : 0.0;
    }
    const VectorXd step = moved.by_values * left + moved.by_priors * away;
    const VectorXd change = own_slopes() * step;
    for (std::size_t k = 0; k < own_.size(); ++k) {
      FreeParameter& own = free[std::size_t(own_[k])];
      own.start = std::clamp(own.start + step(Index(k)), own.lower, own.upper);
    }
    return change.dot(weight_ * change) > close * close;
  }

  /// The draws, each with own parameters drawn and estimated as those of the press were.
  MatrixXd as_left(Index values) const {
    MatrixXd left = draws_;
    if (own_.empty()) return left;
    const MatrixXd slopes = own_slopes();
    const std::vector<FreeParameter> free = own_free();
    MatrixXd away = MatrixXd::Zero(Index(own_.size()), left.cols());
    std::mt19937_64 random;
    std::normal_distribution<double> normal;
    for (Index j = 0; j < left.cols(); ++j)
      for (Index k = 0; k < away.rows(); ++k) {
        const FreeParameter& own = free[std::size_t(k)];
        if (!own.prior) continue;
        away(k, j) = own.prior->deviation * normal(random);
        // A compliance is not below zero.
        if (own.lower >= own.prior->mean) away(k, j) = std::abs(away(k, j));
      }
    left += slopes * away;
    left -= slopes * (response().by_values * left);
    return left.topRows(values);
  }

  PredictedEntry entry_of(const VectorXd& left, const MatrixXd& drawn) const {
    const FitCurve& curve = input_.curves.back();
    PredictedEntry entry;
    entry.name = curve.name, entry.condition = curve.condition;
    for (const Index j : own_) {
      const FreeParameter& own = input_.options.free[std::size_t(j)];
      entry.own.push_back(
          {calibration::label(own), std::string(calibration::unit(own.parameter)), own.start});
    }
    entry.x = curve.x, entry.measured = curve.y;
    const Index values = left.size(), draws = drawn.cols();
    VectorXd low(values), high(values);
    entry.within = 0.0;
    for (Index i = 0; i < values; ++i) {
      std::vector<double> sorted(std::size_t(draws), 0.0);
      VectorXd::Map(sorted.data(), draws) = drawn.row(i).transpose();
      std::ranges::sort(sorted);
      low(i) = sorted[std::size_t(0.025 * double(draws))];
      high(i) = sorted[std::size_t(0.975 * double(draws))];
      const double foretold = curve.y[std::size_t(i)] - left(i);
      entry.foretold.push_back(foretold);
      entry.lower.push_back(foretold + low(i)), entry.upper.push_back(foretold + high(i));
      entry.within += left(i) >= low(i) && left(i) <= high(i) ? 1.0 / double(values) : 0.0;
    }
    // How far a press strays, in half widths of its intervals, where it strays most.
    const auto strays = [&](const auto& one) {
      double most = 0.0;
      for (Index i = 0; i < values; ++i)
        most = std::max(most, one(i) / (one(i) < 0.0 ? low(i) : high(i)));
      return most;
    };
    const double own = strays(left);
    Index farther = 0;
    for (Index j = 0; j < draws; ++j) farther += strays(drawn.col(j)) >= own ? 1 : 0;
    entry.probability = double(farther + 1) / double(draws + 1);
    entry.rms_relative = calibration::relative_rms(left, values_of(curve));
    return entry;
  }

  const calibration::FitRecord& record_;
  FitInput input_;  ///< whose parameters start where they are estimated
  std::vector<ForwardModel*> models_;
  Index parameters_ = 0, known_ = 0;  ///< of the fit: its parameters and values, which stand first
  std::vector<Index> own_;            ///< places of parameters that the press alone tells
  MatrixXd slopes_, draws_, weight_;
  VectorXd mean_;
};

}  // namespace

PredictedEntry predicted_press(const FitInput& input, std::size_t place,
                               const std::vector<ForwardModel*>& models,
                               const calibration::FitRecord& record) {
  return HeldBack(input, *input.with_held_back, place, models, record).foretold();
}

std::vector<PredictedEntry> predicted(const FitInput& input, const FitModels& models,
                                      const calibration::FitRecord& record,
                                      const std::filesystem::path& folder,
                                      const JobContext& context,
                                      const std::function<bool(const std::string& name)>& go_on) {
  std::vector<PredictedEntry> entries;
  if (!input.with_held_back) return entries;
  FitInput all = *input.with_held_back;
  all.place = input.place;
  const auto not_foretold = [&](const FitCurve& curve, const char* why) {
    PredictedEntry& entry = entries.emplace_back();
    entry.name = curve.name, entry.condition = curve.condition, entry.failure = why;
  };
  std::string at_work;
  const FitModels answers(
      all, folder, context, [&] { return go_on(at_work); }, &models);
  const std::vector<ForwardModel*> list = answers.addresses();
  for (std::size_t i = input.curves.size(); i < all.curves.size(); ++i) {
    at_work = all.curves[i].name;
    if (!go_on(at_work)) throw meshes::Interrupted("presses that were held back are not foretold");
    try {
      entries.push_back(predicted_press(input, i, list, record));
    } catch (const meshes::NotConverged& error) {
      not_foretold(all.curves[i], error.what());
    } catch (const meshes::InvalidInput& error) {
      not_foretold(all.curves[i], error.what());
    }
  }
  return entries;
}

}  // namespace fingertip::studies::inline fits::inline models
