#include "calibration/statistics/value_errors.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/dense.h"
#include "meshes/base/errors.h"

namespace fingertip::calibration::inline statistics {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A told deviation is right within this factor, one standard deviation of its logarithm.
constexpr double told_within = 0.35;
/// Sizes of components, over the scale of their prior, and steps of ln size on the grid.
constexpr double least_size = 1e-3, most_size = 100.0, size_step = 0.5, coarse_step = 1.0;
/// Steps of ln noise about its best value, and how far in standard deviations.
constexpr int noise_points = 7;
constexpr double noise_reach = 2.5;

/// A parameter that changes the values by less counts as one that does not.
constexpr double invisible = 1e-50;

/// The values in coordinates in which noise and known errors of the models are independent, and
/// parameters in units of their size.
class MixedModel {
 public:
  MixedModel(const LinearisedFit& fit, const std::vector<ErrorComponent>& components)
      : parameters_(fit.jacobian.cols()) {
    const Index values = fit.residuals.size();
    Index columns = parameters_;
    for (const ErrorComponent& each : components) columns += each.columns.cols();
    columns_.resize(values, columns);
    columns_.leftCols(parameters_) = fit.jacobian;
    component_.assign(std::size_t(columns), -1);
    Index column = parameters_;
    for (std::size_t k = 0; k < components.size(); ++k) {
      columns_.middleCols(column, components[k].columns.cols()) = components[k].columns;
      for (Index j = 0; j < components[k].columns.cols(); ++j)
        component_[std::size_t(column++)] = int(k);
    }
    const VectorXd weight = fit.deviations.cwiseInverse();
    residuals_ = weight.cwiseProduct(fit.residuals);
    columns_ = weight.asDiagonal() * columns_;
    known_ = ArrayXd::Zero(values);
    if (fit.model_covariance.size() > 0) {
      const meshes::EigenPairs eigen =
          meshes::symmetric_eigen(weight.asDiagonal() * fit.model_covariance * weight.asDiagonal());
      known_ = eigen.values.array().max(0.0);
      residuals_ = eigen.vectors.transpose() * residuals_;
      columns_ = eigen.vectors.transpose() * columns_;
    }
    alike_ = (known_ == 0.0).all();
    units_ = VectorXd::Ones(columns);
    for (Index j = 0; j < parameters_; ++j)
      if (const double norm = columns_.col(j).norm(); norm > invisible) units_(j) = 1.0 / norm;
    columns_ = columns_ * units_.asDiagonal();
    if (alike_) {  // then they need no weights of their own
      gram_ = columns_.transpose() * columns_;
      shared_ = columns_.transpose() * residuals_;
      squares_ = residuals_.squaredNorm();
    }
    unit_logs_ = 2.0 * fit.deviations.array().log().sum();
    precision_ = shift_ = VectorXd::Zero(columns);
    for (Index j = 0; j < parameters_; ++j)
      if (const auto& prior = fit.free[std::size_t(j)].prior) {
        precision_(j) = std::pow(units_(j) / prior->deviation, 2);
        shift_(j) = (prior->mean - fit.estimates(j)) / units_(j);
        unit_logs_ -= std::log(precision_(j));
      } else {
        unit_logs_ -= 2.0 * std::log(units_(j));
        without_prior_.push_back(j);
      }
  }

  /// Everything at one choice of sizes. `density` is the logarithm of the restricted likelihood.
  struct Point {
    double density = 0.0;
    VectorXd expected;    ///< of parameters and components, in units
    MatrixXd covariance;  ///< of the parameters alone; empty unless asked for
  };
  Point at(double noise, const std::vector<double>& sizes, bool all = false) const {
    const Equations found = equations(noise, sizes);
    Point point;
    point.expected = found.factor.solve(found.right);
    point.density = -0.5 * (found.determinant + found.squares - found.right.dot(point.expected));
    if (all)
      point.covariance = found.factor.solve(MatrixXd::Identity(found.right.size(), parameters_))
                             .topRows(parameters_);
    return point;
  }

  /// So many draws of the parameters less their estimates, and of the components' numbers, from
  /// what the values leave of them at one choice of sizes: a column each.
  MatrixXd draws(double noise, const std::vector<double>& sizes, Index count,
                 std::mt19937_64& random) const {
    const Equations found = equations(noise, sizes);
    std::normal_distribution<double> normal;
    MatrixXd drawn =
        MatrixXd::NullaryExpr(found.right.size(), count, [&] { return normal(random); });
    // P A Pᵀ = L D Lᵀ: x = Pᵀ L⁻ᵀ D^(-1/2) e has the covariance A⁻¹.
    drawn = found.factor.vectorD().cwiseAbs().cwiseSqrt().cwiseInverse().asDiagonal() * drawn;
    found.factor.matrixU().solveInPlace(drawn);
    drawn = found.factor.transpositionsP().transpose() * drawn;
    drawn.colwise() += found.factor.solve(found.right);
    return units_.asDiagonal() * drawn;
  }

  /// The logarithm of the likelihood with parameters without a prior at their best, all else
  /// integrated out.
  double log_likelihood(double noise, const std::vector<double>& sizes) const {
    const Point point = at(noise, sizes, true);
    const MatrixXd open = point.covariance(without_prior_, without_prior_);
    double unit_logs = 0.0;
    for (const Index j : without_prior_) unit_logs += std::log(units_(j));
    return point.density - 0.5 * open.ldlt().vectorD().array().abs().log().sum() - unit_logs;
  }

  Index parameters() const { return parameters_; }
  const VectorXd& units() const { return units_; }

 private:
  /// The equations at one choice of sizes, and what its density has besides.
  struct Equations {
    Eigen::LDLT<MatrixXd> factor;
    VectorXd right;
    double determinant = 0.0, squares = 0.0;
  };
  Equations equations(double noise, const std::vector<double>& sizes) const {
    Equations found{{}, {}, unit_logs_, shift_.dot(precision_.cwiseProduct(shift_))};
    auto& [factor, right, determinant, squares] = found;
    MatrixXd matrix;
    if (alike_) {
      const double weight = 1.0 / (noise * noise);
      matrix = weight * gram_;
      right = weight * shared_;
      squares += weight * squares_;
      determinant -= double(residuals_.size()) * std::log(weight);
    } else {
      const ArrayXd variance = noise * noise + known_;
      const VectorXd weight = variance.inverse();
      matrix = columns_.transpose() * weight.asDiagonal() * columns_;
      right = columns_.transpose() * weight.cwiseProduct(residuals_);
      squares += residuals_.dot(weight.cwiseProduct(residuals_));
      determinant += variance.log().sum();
    }
    for (Index j = 0; j < matrix.cols(); ++j) {
      const int k = component_[std::size_t(j)];
      const double precision = k < 0 ? precision_(j) : std::pow(sizes[std::size_t(k)], -2);
      matrix(j, j) += precision;
      right(j) += precision * shift_(j);
      if (k >= 0) determinant -= std::log(precision);
    }
    // What neither values nor priors tell, of one or of several alike, has a huge variance, not an
    // infinite one.
    matrix.diagonal().head(parameters_).array() *= 1.0 + 1e-10;
    matrix.diagonal().head(parameters_).array() += 1e-12 / (noise * noise);
    factor.compute(matrix);
    determinant += factor.vectorD().array().abs().log().sum();
    return found;
  }

  Index parameters_;
  MatrixXd columns_, gram_;
  VectorXd residuals_, shared_, units_, precision_, shift_;
  bool alike_ = true;  ///< all values, for the models have no known errors
  double squares_ = 0.0, unit_logs_ = 0.0;
  std::vector<Index> without_prior_;  ///< parameters
  ArrayXd known_;               ///< variance of the models' known errors over that of the noise
  std::vector<int> component_;  ///< of a column; -1: a parameter
};

/// Where a function of one number is greatest between two, by golden section.
template <typename Function>
double greatest(const Function& function, double low, double high, double width) {
  constexpr double share = 0.381966;
  double a = low + share * (high - low), b = high - share * (high - low);
  double at_a = function(a), at_b = function(b);
  while (high - low > width) {
    if (at_a > at_b) {
      high = b, b = a, at_b = at_a;
      at_a = function(a = low + share * (high - low));
    } else {
      low = a, a = b, at_a = at_b;
      at_b = function(b = high - share * (high - low));
    }
  }
  return 0.5 * (low + high);
}

/// A choice of sizes, and the logarithm of its posterior density over the logarithms of sizes.
struct Choice {
  double noise = 1.0;
  std::vector<double> sizes;
  double density = 0.0;
};

/// Of half of Cauchy's distribution, over ln size.
double size_prior(double size, double scale) {
  return std::log(size / scale) - std::log1p(std::pow(size / scale, 2));
}

/// The value below which a share of the weights lies.
double weighted_point(std::vector<std::pair<double, double>> values, double share) {
  std::ranges::sort(values);
  double sum = 0.0;
  for (const auto& [value, weight] : values)
    if ((sum += weight) >= share) return value;
  return values.back().first;
}

/// All choices of the sizes of components, with some of the noise each.
class Grid {
 public:
  Grid(const MixedModel& model, const std::vector<ErrorComponent>& components,
       const LinearisedFit& fit, double noise)
      : model_(model),
        components_(components),
        unknown_(std::ranges::count(components, false, &ErrorComponent::known)),
        told_(fit.noise_told),
        least_(std::log(std::max(fit.least_noise, 1e-300))),
        centre_(std::log(noise)) {
    std::vector<double> sizes(components.size());
    choose(0, sizes);
    double most = choices_.front().density;
    for (const Choice& each : choices_) most = std::max(most, each.density);
    double sum = 0.0;
    for (Choice& each : choices_) sum += std::exp(each.density - most);
    for (Choice& each : choices_) each.density = std::exp(each.density - most) / sum;
    evidence_ = most + std::log(sum);
  }

  /// `density` is their weight, of sum 1.
  const std::vector<Choice>& choices() const { return choices_; }
  double log_evidence() const { return evidence_; }

  /// Without a prior of sizes: the best likelihood of all choices, and of those without component
  /// `k`.
  double seen(std::size_t k) const { return 2.0 * (best_ - best_without_[k]); }
  const Choice& likeliest() const { return best_choice_; }

 private:
  double noise_prior(double ln_noise) const {
    constexpr double below = 0.2;  // of a logarithm: a floor that is not quite hard
    return (told_ ? -0.5 * std::pow(ln_noise / std::log1p(told_within), 2) : 0.0) -
           0.5 * std::pow(std::min(0.0, ln_noise - least_) / below, 2);
  }
  void choose(std::size_t k, std::vector<double>& sizes) {
    if (k == sizes.size()) return add(sizes);
    if (components_[k].known) {
      sizes[k] = 1.0;
      return choose(k + 1, sizes);
    }
    const double scale = components_[k].scale;
    const double step = unknown_ > 1 ? coarse_step : size_step;
    for (double ln = std::log(least_size); ln <= std::log(most_size); ln += step) {
      sizes[k] = scale * std::exp(ln);
      choose(k + 1, sizes);
    }
  }
  /// The noise at these sizes about its best value, as far as its curvature tells.
  void add(const std::vector<double>& sizes) {
    const auto density = [&](double ln) {
      return model_.at(std::exp(ln), sizes).density + noise_prior(ln);
    };
    // Of the choice before it is close by: Newton's steps, where they go uphill.
    constexpr double step = 0.1, close = 0.03;
    double best = centre_, there = density(best), bend = 0.0, next = best;
    for (int i = 0; i < 4; ++i) {
      const double up = density(best + step), down = density(best - step);
      bend = (up + down - 2.0 * there) / (step * step);
      next = bend < 0.0 ? best - (up - down) / (2.0 * step * bend) : best;
      if (!(bend < 0.0) || std::abs(next - best) > 1.0) {
        next = greatest(density, best - 8.0, best + 8.0, close);
        i = std::max(i, 2);
      }
      const bool found = std::abs(next - best) < close;
      best = next, there = density(best);
      if (found) break;
    }
    centre_ = best;
    if (best_choice_.sizes.empty() || there > best_) best_choice_ = {std::exp(best), sizes, there};
    const double deviation = std::clamp(1.0 / std::sqrt(std::max(-bend, 1e-2)), 0.01, 2.0);
    best_without_.resize(sizes.size(), -std::numeric_limits<double>::infinity());
    best_ = std::max(best_, there);
    double prior = 0.0;
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      if (components_[k].known) continue;
      prior += size_prior(sizes[k], components_[k].scale);
      if (sizes[k] < 1.01 * least_size * components_[k].scale)
        best_without_[k] = std::max(best_without_[k], there);
    }
    constexpr double negligible = 14.0;  // of a logarithm
    most_ = std::max(most_, there + prior);
    if (there + prior < most_ - negligible) return;
    for (int i = 0; i < noise_points; ++i) {
      const double z = noise_reach * (2.0 * i / (noise_points - 1) - 1.0),
                   ln = best + z * deviation;
      choices_.push_back(
          {std::exp(ln), sizes, (z == 0.0 ? there : density(ln)) + prior + std::log(deviation)});
    }
  }

  const MixedModel& model_;
  const std::vector<ErrorComponent>& components_;
  std::ptrdiff_t unknown_;  ///< components whose size is
  bool told_;
  double least_, centre_;
  std::vector<Choice> choices_;
  double evidence_ = 0.0, best_ = -std::numeric_limits<double>::infinity(), most_ = best_;
  std::vector<double> best_without_;
  Choice best_choice_;
};

void check(const LinearisedFit& fit, const std::vector<ErrorComponent>& components) {
  const Index values = fit.residuals.size();
  bool fits = values > 0 && fit.jacobian.rows() == values && fit.deviations.size() == values &&
              fit.jacobian.cols() == Index(fit.free.size()) &&
              fit.estimates.size() == fit.jacobian.cols() &&
              (fit.model_covariance.size() == 0 ||
               (fit.model_covariance.rows() == values && fit.model_covariance.cols() == values));
  for (const ErrorComponent& each : components)
    fits = fits && each.columns.rows() == values && each.scale > 0.0;
  if (!fits || !(fit.deviations.minCoeff() > 0.0))
    throw meshes::InvalidInput({"errors", std::to_string(values) + " values",
                                "residuals, slopes, deviations > 0 and columns have a row per "
                                "value, slopes a column per parameter",
                                "give them for the same values and parameters"});
}

/// The search for the noise begins where the residuals are.
double rough_noise(const LinearisedFit& fit) {
  if (fit.noise_told) return 1.0;
  const double rough = std::sqrt(fit.residuals.cwiseQuotient(fit.deviations).squaredNorm() /
                                 double(fit.residuals.size()));
  return std::max({rough, fit.least_noise, 1e-9});
}

}  // namespace

ValueErrors value_errors(const LinearisedFit& fit, const std::vector<ErrorComponent>& components) {
  check(fit, components);
  const MixedModel model(fit, components);
  const Grid grid(model, components, fit, rough_noise(fit));
  const Index parameters = model.parameters();
  ValueErrors result;
  result.log_evidence = grid.log_evidence();
  result.log_likelihood = model.log_likelihood(grid.likeliest().noise, grid.likeliest().sizes);
  // Sizes: medians, by which the errors' covariance is told.
  std::vector<std::pair<double, double>> noises;
  for (const Choice& each : grid.choices()) noises.emplace_back(each.noise, each.density);
  result.noise = weighted_point(noises, 0.5);
  const Index values = fit.residuals.size();
  result.covariance_of_values = fit.model_covariance;
  if (fit.model_covariance.size() == 0)
    result.covariance_of_values = MatrixXd::Zero(values, values);
  for (std::size_t k = 0; k < components.size(); ++k) {
    std::vector<std::pair<double, double>> sizes;
    for (const Choice& each : grid.choices()) sizes.emplace_back(each.sizes[k], each.density);
    result.sizes.push_back(weighted_point(sizes, 0.5));
    result.upper_sizes.push_back(weighted_point(sizes, 0.95));
    result.seen.push_back(grid.seen(k));
    result.parts.emplace_back(VectorXd::Zero(values));
    const MatrixXd& columns = components[k].columns;
    result.covariance_of_values += std::pow(result.sizes[k], 2) * columns * columns.transpose();
  }
  // The parameters: a mixture over all choices that weigh anything.
  constexpr double least_weight = 1e-5;
  std::vector<double> weights;
  std::vector<MixedModel::Point> points;
  for (const Choice& each : grid.choices()) {
    if (each.density < least_weight) continue;
    weights.push_back(each.density);
    points.push_back(model.at(each.noise, each.sizes, true));
  }
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  VectorXd mean = VectorXd::Zero(parameters);
  MatrixXd second = MatrixXd::Zero(parameters, parameters);
  for (std::size_t i = 0; i < points.size(); ++i) {
    weights[i] /= sum;
    const VectorXd expected = points[i].expected.head(parameters);
    mean += weights[i] * expected;
    second += weights[i] * (points[i].covariance + expected * expected.transpose());
    Index column = parameters;
    for (std::size_t k = 0; k < components.size(); ++k) {
      const Index count = components[k].columns.cols();
      result.parts[k] +=
          weights[i] * (components[k].columns * points[i].expected.segment(column, count));
      column += count;
    }
  }
  const auto units = model.units().head(parameters).asDiagonal();
  result.mean = fit.estimates + units * mean;
  result.covariance = units * (second - mean * mean.transpose()) * units;
  result.lower = result.upper = result.mean;
  for (Index j = 0; j < parameters; ++j) {
    std::vector<double> means, deviations;
    for (const MixedModel::Point& point : points) {
      means.push_back(point.expected(j));
      deviations.push_back(std::sqrt(std::max(0.0, point.covariance(j, j))));
    }
    result.lower(j) =
        fit.estimates(j) + units.diagonal()(j) * mixture_point(means, deviations, weights, 0.025);
    result.upper(j) =
        fit.estimates(j) + units.diagonal()(j) * mixture_point(means, deviations, weights, 0.975);
  }
  return result;
}

MatrixXd further_values(const LinearisedFit& fit, const std::vector<ErrorComponent>& components,
                        const FurtherValues& further, Index draws) {
  check(fit, components);
  const MixedModel model(fit, components);
  const Grid grid(model, components, fit, rough_noise(fit));
  const Index values = further.jacobian.rows();
  MatrixXd slopes = further.jacobian, drawn(values, draws);
  for (const MatrixXd& each : further.columns) {
    slopes.conservativeResize(Eigen::NoChange, slopes.cols() + each.cols());
    slopes.rightCols(each.cols()) = each;
  }
  // Every choice of sizes as often as it weighs.
  std::mt19937_64 random;
  std::normal_distribution<double> normal;
  double sum = 0.0;
  Index done = 0;
  for (const Choice& each : grid.choices()) {
    sum += each.density;
    const Index count = std::min(draws, Index(std::llround(sum * double(draws)))) - done;
    if (count <= 0) continue;
    drawn.middleCols(done, count) = slopes * model.draws(each.noise, each.sizes, count, random);
    for (Index j = done; j < done + count; ++j)
      for (Index i = 0; i < values; ++i)
        drawn(i, j) += each.noise * further.deviations(i) * normal(random);
    done += count;
  }
  return drawn.leftCols(done);
}

MatrixXd smooth_columns(const VectorXd& u, double length) {
  // Nyström: through a few nodes, far closer than the length, which leaves 1e-4 of the variance.
  const Index nodes = Index(std::ceil(2.0 / length)) + 6;
  const VectorXd at = VectorXd::LinSpaced(nodes, -0.05, 1.05);
  const auto kernel = [&](double a, double b) {
    return std::exp(-0.5 * std::pow((a - b) / length, 2));
  };
  const MatrixXd own =
      MatrixXd::NullaryExpr(nodes, nodes, [&](Index i, Index j) { return kernel(at(i), at(j)); });
  const MatrixXd across =
      MatrixXd::NullaryExpr(u.size(), nodes, [&](Index i, Index j) { return kernel(u(i), at(j)); });
  const meshes::EigenPairs eigen = meshes::symmetric_eigen(own);
  const double least = 1e-5 * eigen.values(nodes - 1);
  const Index kept = (eigen.values.array() > least).count();
  return across * eigen.vectors.rightCols(kept) *
         eigen.values.tail(kept).cwiseSqrt().cwiseInverse().asDiagonal();
}

}  // namespace fingertip::calibration::inline statistics
