#include "calibration/press_fit/displacement_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "calibration/files/words.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/dense.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Prior of the deviation of what is missed, over the field's size, as of presses.
constexpr double ratio_missed_scale = 0.01;
/// More of the data missed beyond noise is no description of them.
constexpr double most_missed = 0.1;
/// Intervals of the scan for the mode, and points of the posterior.
constexpr int scanned = 24, posterior_points = 49;
constexpr double negligible_density = 8.0;  ///< of a log density below the mode's

/// Young's modulus is 1 Pa in ScaledModel, which is asked by G.
double shear_of(double poissons_ratio) {
  return 0.5 / (1.0 + poissons_ratio);
}

meshes::Rubber unit_rubber() {
  meshes::Rubber rubber;
  rubber.youngs_modulus = 1.0;
  rubber.shear_modulus = shear_of(0.4);
  return rubber;
}

/// What residuals say of noise and misfit, of linear parameters beside them, and how likely they
/// are.
struct RatioErrors {
  double log_evidence = 0.0;
  double noise = 0.0;                   ///< deviation, median
  double size = 0.0, size_upper = 0.0;  ///< of the misfit's deviation, over the field: median, 95 %
  double seen = 0.0;                    ///< twice the logarithm of the best likelihood's ratio
  VectorXd part;                        ///< expected misfit
  VectorXd mean, lower, upper;          ///< of the linear parameters, 95 %
};

/// As value_errors has it, of one component: in the eigenvectors of its covariance noise and misfit
/// are independent, value by value, so that hundreds of values cost next to nothing at any sizes.
class NoiseAndMisfit {
 public:
  explicit NoiseAndMisfit(const MatrixXd& covariance)
      : eigen_(meshes::symmetric_eigen(covariance)) {
    variance_ = eigen_.values.array().max(0.0);
  }

  /// `freed`: a column per linear parameter without a prior. `all`: not the evidence alone.
  RatioErrors of(const VectorXd& residuals, const MatrixXd& freed, bool all) const {
    const VectorXd seen = eigen_.vectors.transpose() * residuals;
    const MatrixXd columns = eigen_.vectors.transpose() * freed;
    const double rough = std::log(std::sqrt(seen.squaredNorm() / double(seen.size())));
    std::vector<Choice> choices;
    double best = -std::numeric_limits<double>::infinity(), best_without = best;
    for (double ln_size = std::log(least_size); ln_size < std::log(most_size); ln_size += size_step)
      for (double ln = rough + noise_above; ln > rough - noise_below; ln -= noise_step) {
        Choice choice =
            chosen(seen, columns, std::exp(ln), ratio_missed_scale * std::exp(ln_size), all);
        best = std::max(best, choice.density);
        if (ln_size < std::log(1.01 * least_size))
          best_without = std::max(best_without, choice.density);
        // Half of Cauchy's distribution of the size, over its logarithm.
        choice.density += ln_size - std::log1p(std::exp(2.0 * ln_size));
        choices.push_back(std::move(choice));
      }
    RatioErrors errors = summed_up(choices, columns, seen, all);
    errors.seen = 2.0 * (best - best_without);
    return errors;
  }

 private:
  static constexpr double least_size = 1e-3, most_size = 100.0, size_step = 0.25;
  static constexpr double noise_above = 0.4, noise_below = 6.0, noise_step = 0.1;

  struct Choice {
    double noise = 0.0, size = 0.0, density = 0.0;
    VectorXd mean = {};
    MatrixXd covariance = {};
  };

  /// With linear parameters integrated out: the restricted likelihood.
  Choice chosen(const VectorXd& seen, const MatrixXd& columns, double noise, double size,
                bool all) const {
    Choice choice{noise, size};
    const Eigen::ArrayXd variance = noise * noise + size * size * variance_;
    const VectorXd weight = variance.inverse();
    choice.density = -0.5 * (variance.log().sum() + seen.dot(weight.cwiseProduct(seen)));
    if (columns.cols() == 0) return choice;
    const MatrixXd weighted = weight.asDiagonal() * columns, gram = columns.transpose() * weighted;
    const VectorXd right = weighted.transpose() * seen;
    const Eigen::LDLT<MatrixXd> factor(gram);
    choice.mean = factor.solve(right);
    choice.density += 0.5 * (right.dot(choice.mean) - factor.vectorD().array().abs().log().sum());
    if (all) choice.covariance = factor.solve(MatrixXd::Identity(gram.rows(), gram.cols()));
    return choice;
  }

  /// Below which a share of the weights lies.
  static double point(std::vector<std::pair<double, double>> values, double share) {
    std::ranges::sort(values);
    double sum = 0.0;
    for (const auto& [value, weight] : values)
      if ((sum += weight) >= share) return value;
    return values.back().first;
  }

  RatioErrors summed_up(const std::vector<Choice>& choices, const MatrixXd& columns,
                        const VectorXd& seen, bool all) const {
    double most = choices.front().density, sum = 0.0;
    for (const Choice& each : choices) most = std::max(most, each.density);
    for (const Choice& each : choices) sum += std::exp(each.density - most);
    RatioErrors errors;
    errors.log_evidence = most + std::log(sum * size_step * noise_step);
    if (!all) return errors;
    std::vector<std::pair<double, double>> noises, sizes;
    std::vector<double> weights;
    std::vector<const Choice*> kept;
    VectorXd part = VectorXd::Zero(seen.size());
    for (const Choice& each : choices) {
      const double weight = std::exp(each.density - most) / sum;
      noises.emplace_back(each.noise, weight);
      sizes.emplace_back(each.size, weight);
      constexpr double negligible_weight = 1e-6;
      if (weight < negligible_weight) continue;
      weights.push_back(weight);
      kept.push_back(&each);
      VectorXd left = seen;
      if (columns.cols() > 0) left -= columns * each.mean;
      const Eigen::ArrayXd missed = each.size * each.size * variance_;
      part += weight * (missed / (missed + each.noise * each.noise) * left.array()).matrix();
    }
    errors.noise = point(noises, 0.5);
    errors.size = point(sizes, 0.5);
    errors.size_upper = point(sizes, 0.95);
    errors.part = eigen_.vectors * part;
    errors.mean = errors.lower = errors.upper = VectorXd::Zero(columns.cols());
    for (Index j = 0; j < columns.cols(); ++j) {
      std::vector<double> means, deviations;
      for (std::size_t i = 0; i < kept.size(); ++i) {
        means.push_back(kept[i]->mean(j));
        deviations.push_back(std::sqrt(std::max(0.0, kept[i]->covariance(j, j))));
        errors.mean(j) += weights[i] * means.back();
      }
      errors.lower(j) = mixture_point(means, deviations, weights, 0.025);
      errors.upper(j) = mixture_point(means, deviations, weights, 0.975);
    }
    return errors;
  }

  meshes::EigenPairs eigen_;
  Eigen::ArrayXd variance_;  ///< of the misfit's values in the eigenvectors, at size 1
};

/// What the data say at one Poisson's ratio.
class RatioEvidence {
 public:
  RatioEvidence(const DisplacementMoments& moments, DisplacementModel& model,
                DisplacementModel* slipping, const FreedPress& freed)
      : moments_(moments),
        model_(model),
        slipping_(slipping),
        freed_(freed),
        errors_(moments.misfit_covariance()) {}

  double log_density(double nu) {
    const auto [known, is_new] = known_.try_emplace(nu, 0.0);
    if (is_new) known->second = errors(nu, false).log_evidence;
    return known->second;
  }
  /// Of a field that has changed.
  void forget() { known_.clear(); }

  RatioErrors errors(double nu, bool all) const {
    const VectorXd computed = model_.at(nu);
    return errors_.of(moments_.measured() - computed, freed_columns(nu, computed), all);
  }

  /// A column per load of what is freed: first its own values, then what frictionless adds.
  MatrixXd freed_columns(double nu, const VectorXd& computed) const {
    MatrixXd columns = MatrixXd::Zero(computed.size(), 0);
    if (freed_.compression) add_per_load(computed, columns);
    if (freed_.slip) add_per_load(slipping_->at(nu) - computed, columns);
    return columns;
  }

 private:
  void add_per_load(const VectorXd& field, MatrixXd& columns) const {
    Index first = 0;
    for (const DisplacementMoments::Load& load : moments_.loads()) {
      columns.conservativeResize(field.size(), columns.cols() + 1);
      columns.rightCols(1).setZero();
      columns.rightCols(1).col(0).segment(first, load.values) = field.segment(first, load.values);
      first += load.values;
    }
  }

  const DisplacementMoments& moments_;
  DisplacementModel& model_;
  DisplacementModel* slipping_;
  FreedPress freed_;
  NoiseAndMisfit errors_;
  std::map<double, double> known_;
};

/// Where the density is greatest, between two ratios, by golden section.
double mode_between(RatioEvidence& evidence, double low, double high) {
  constexpr double share = 0.381966, width = 2e-5;
  double a = low + share * (high - low), b = high - share * (high - low);
  while (high - low > width) {
    if (evidence.log_density(a) > evidence.log_density(b)) {
      high = b, b = a;
      a = low + share * (high - low);
    } else {
      low = a, a = b;
      b = high - share * (high - low);
    }
  }
  return 0.5 * (low + high);
}

double mode_within(RatioEvidence& evidence, double lowest, double highest) {
  const double step = (highest - lowest) / scanned;
  int best = 0;
  for (int i = 1; i <= scanned; ++i)
    if (evidence.log_density(lowest + i * step) > evidence.log_density(lowest + best * step))
      best = i;
  return mode_between(evidence, std::max(lowest, lowest + (best - 1) * step),
                      std::min(highest, lowest + (best + 1) * step));
}

/// From the mode on to one side: where the density has fallen to nothing, or the bound.
double end_of(RatioEvidence& evidence, double mode, double bound) {
  const double most = evidence.log_density(mode);
  constexpr int halvings = 14;
  double far = bound;
  if (evidence.log_density(bound) > most - negligible_density) return bound;
  double near = mode;
  for (int i = 0; i < halvings && std::abs(far - near) > 0.02 * std::abs(far - mode); ++i) {
    const double middle = 0.5 * (near + far);
    (evidence.log_density(middle) > most - negligible_density ? near : far) = middle;
  }
  return far;
}

/// Of a density known at points, straight between them.
struct RatioPosterior {
  std::vector<double> at, weight;  ///< cumulative, 0 to 1

  double quantile(double share) const {
    for (std::size_t i = 1; i < at.size(); ++i)
      if (weight[i] >= share)
        return at[i - 1] +
               (at[i] - at[i - 1]) * (share - weight[i - 1]) / (weight[i] - weight[i - 1]);
    return at.back();
  }
};

RatioPosterior summed(RatioEvidence& evidence, double low, double high, double most) {
  RatioPosterior posterior;
  std::vector<double> density;
  for (int i = 0; i < posterior_points; ++i) {
    posterior.at.push_back(low + (high - low) * i / (posterior_points - 1));
    density.push_back(std::exp(evidence.log_density(posterior.at.back()) - most));
  }
  posterior.weight.assign(density.size(), 0.0);
  for (std::size_t i = 1; i < density.size(); ++i)
    posterior.weight[i] = posterior.weight[i - 1] + 0.5 * (density[i - 1] + density[i]) *
                                                        (posterior.at[i] - posterior.at[i - 1]);
  for (double& weight : posterior.weight) weight /= posterior.weight.back();
  return posterior;
}

std::vector<LoadEntry> load_entries(const DisplacementMoments& moments,
                                    const std::vector<MeasuredDisplacements>& measured,
                                    const VectorXd& residuals, const RatioErrors& errors,
                                    const FreedPress& freed) {
  std::vector<LoadEntry> loads;
  Index first = 0;
  for (std::size_t s = 0; s < measured.size(); ++s) {
    const DisplacementMoments::Load& load = moments.loads()[s];
    LoadEntry& entry = loads.emplace_back();
    entry.indentation = measured[s].indentation;
    entry.points = std::size_t(std::ranges::count_if(measured[s].displacement,
                                                     [](const auto& u) { return u.allFinite(); }));
    entry.values = std::size_t(load.values);
    const double points = double(entry.points);
    entry.size = moments.measured().segment(first, load.values).norm() / std::sqrt(points);
    entry.rms = residuals.segment(first, load.values).norm() / std::sqrt(points);
    first += load.values;
    Index i = Index(s);
    if (freed.compression) {
      entry.stretch = 1.0 + errors.mean(i);
      entry.stretch_lower = 1.0 + errors.lower(i);
      entry.stretch_upper = 1.0 + errors.upper(i);
      i += Index(measured.size());
    }
    if (!freed.slip) continue;
    entry.slip = errors.mean(i);
    entry.slip_lower = errors.lower(i);
    entry.slip_upper = errors.upper(i);
  }
  return loads;
}

void judge_ratio(DisplacementFitFile& fit) {
  if (fit.misfit > most_missed)
    fit.failed.push_back("the model misses " + percent(fit.misfit) +
                         " of the displacements beyond noise, more than a tenth");
  if (0.5 * (fit.upper - fit.lower) > open_ratio)
    fit.failed.push_back("the data leave Poisson's ratio open by more than +-" +
                         rounded(open_ratio, 3));
  fit.statement =
      "Poisson's ratio " + rounded(fit.poissons_ratio, 4) + " (95 %: " + rounded(fit.lower, 4) +
      " to " + rounded(fit.upper, 4) + (fit.at_bound ? ", an end of what is sought). " : "). ") +
      "Noise of a component " + quantity_text(fit.noise, "m", 2) + "; beyond it the model misses " +
      percent(fit.misfit) + " of the displacements, at most " + percent(fit.misfit_upper) +
      " (95 %). E is not told.";
  for (const std::string& reason : fit.failed)
    fit.statement = "Not accepted: " + reason + ". " + fit.statement;
}

}  // namespace

DisplacementModel::DisplacementModel(ScaledModel::Solver solver, double lowest_ratio)
    : lowest_(std::max(lowest_ratio, 0.0)),
      model_(
          [this, solver = std::move(solver)](const std::vector<double>& ratios) {
            asked_.insert(asked_.end(), ratios.begin(), ratios.end());
            return solver(ratios);
          },
          {MaterialParameter::shear_modulus}, unit_rubber(), lowest_, ScaledModel::Use::search,
          ScaledModel::Interpolation::plain) {}

VectorXd DisplacementModel::at(double poissons_ratio) {
  const double shear = shear_of(poissons_ratio);
  return model_.evaluate(VectorXd::Constant(1, shear)).value / shear;
}

bool DisplacementModel::refine(double poissons_ratio) {
  return model_.refine(VectorXd::Constant(1, shear_of(poissons_ratio)));
}

DisplacementFitFile fit_poissons_ratio(const DisplacementMoments& moments,
                                       const std::vector<MeasuredDisplacements>& measured,
                                       DisplacementModel& model, DisplacementModel* slipping,
                                       FrameMotion frame, const FreedPress& freed) {
  RatioEvidence evidence(moments, model, slipping, freed);
  const double lowest = model.lowest(), highest = ScaledModel::highest_ratio;
  double mode = mode_within(evidence, lowest, highest);
  for (bool learnt = true; learnt;) {
    learnt = model.refine(mode);
    if (freed.slip) learnt = slipping->refine(mode) || learnt;
    if (!learnt) break;
    evidence.forget();
    mode = mode_within(evidence, lowest, highest);
  }
  const double most = evidence.log_density(mode);
  const double low = end_of(evidence, mode, lowest), high = end_of(evidence, mode, highest);
  const RatioPosterior posterior = summed(evidence, low, high, most);
  DisplacementFitFile fit;
  fit.frame = frame == FrameMotion::fitted ? "fitted" : "held";
  if (freed.compression) fit.freed.emplace_back("compression");
  if (freed.slip) fit.freed.emplace_back("slip");
  fit.poissons_ratio = posterior.quantile(0.5);
  fit.lower = posterior.quantile(0.025);
  fit.upper = posterior.quantile(0.975);
  fit.at_bound = low == lowest || high == highest;
  const RatioErrors errors = evidence.errors(mode, true);
  const VectorXd computed = model.at(mode);
  fit.noise = errors.noise;
  fit.misfit = errors.part.norm() / moments.measured().norm();
  fit.misfit_upper = errors.size_upper;
  fit.misfit_seen = errors.seen;
  fit.log_evidence = most;
  fit.asked = model.asked();
  std::ranges::sort(fit.asked);
  const VectorXd missed =
      moments.measured() - computed - evidence.freed_columns(mode, computed) * errors.mean;
  fit.loads = load_entries(moments, measured, missed, errors, freed);
  judge_ratio(fit);
  return fit;
}

}  // namespace fingertip::calibration::inline press_fit
