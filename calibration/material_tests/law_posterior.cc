#include "calibration/material_tests/law_posterior.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "calibration/material_tests/strain_grid.h"
#include "calibration/statistics/posterior.h"

namespace fingertip::calibration::inline material_tests {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// A test has so many values at most, means of rows that follow each other: laws are smooth, and
/// errors cost the square of their number.
constexpr std::size_t most_values = 60;
/// What a law misses of a test is a share of its stress, smooth over half of its rows' way.
constexpr double smooth_length = 0.5, misfit_scale = 0.01;
/// Of the prior of factors' deviation: most tests of one laboratory differ by less than is usual.
constexpr double factor_scale = 0.01;

bool changes_shape(const MaterialTest& test) {
  return test.kind != TestKind::volumetric;
}

/// Means of so many rows that follow each other.
struct Groups {
  explicit Groups(std::size_t rows) : size(Index((rows + most_values - 1) / most_values)) {}

  template <typename Matrix>
  Matrix mean(const Matrix& rows) const {
    const Index groups = (rows.rows() + size - 1) / size;
    Matrix means(groups, rows.cols());
    for (Index g = 0; g < groups; ++g)
      means.row(g) =
          rows.middleRows(g * size, std::min(size, rows.rows() - g * size)).colwise().mean();
    return means;
  }

  Index size;
};

class GroupedModel final : public ForwardModel {
 public:
  GroupedModel(std::unique_ptr<ForwardModel> model, Groups groups)
      : model_(std::move(model)), groups_(groups) {}
  CurveSlopes evaluate(const VectorXd& parameters) override {
    const CurveSlopes all = model_->evaluate(parameters);
    return {groups_.mean(all.value), groups_.mean(all.jacobian)};
  }

 private:
  std::unique_ptr<ForwardModel> model_;
  Groups groups_;
};

/// A test as the posterior sees it.
struct Seen {
  Curve curve;
  std::unique_ptr<ForwardModel> model;
  VectorXd deviation;    ///< LinearisedFit::deviations
  VectorXd per_scale;    ///< of a stress [1/Pa]
  VectorXd way;          ///< 0 at one end of the test, 1 at the other
  double of_mean = 0.0;  ///< error of that of its specimens
  std::vector<TestPart> parts;
  MatrixXd in_part;  ///< share of a value's rows, a column per part
};

Seen seen_of(const LawCurves& data, std::size_t t, std::unique_ptr<ForwardModel> model) {
  const MaterialTest& test = data.tests[t];
  const Groups groups(test.stress.size());
  const auto mean = [&](const std::vector<double>& rows) -> VectorXd {
    return groups.mean(VectorXd(VectorXd::Map(rows.data(), Index(rows.size()))));
  };
  Seen seen;
  seen.curve = data.curves[t];
  const VectorXd y = mean(seen.curve.y);
  const Index rows = Index(seen.curve.y.size());
  seen.deviation.resize(y.size());
  for (Index g = 0; g < y.size(); ++g) {
    const Index first = g * groups.size, count = std::min(groups.size, rows - first);
    seen.deviation(g) = std::sqrt(double(count)) / double(count);
    if (!seen.curve.sigma.empty())
      seen.deviation(g) =
          VectorXd::Map(seen.curve.sigma.data() + first, count).norm() / double(count);
  }
  seen.curve.sigma.clear();
  seen.curve.y.assign(y.begin(), y.end());
  seen.curve.x.resize(seen.curve.y.size());
  seen.per_scale = groups.mean(VectorXd(VectorXd::Map(data.scales[t].data(), rows).cwiseInverse()));
  const double rest = rest_of(test.kind), least = std::min(rest, test.deformation.front()),
               most = std::max(rest, test.deformation.back());
  seen.way = (mean(test.deformation).array() - least) / (most - least);
  seen.of_mean = error_of_mean(test.specimens);
  if (changes_shape(test)) seen.parts = parts_of(test);
  MatrixXd in_part = MatrixXd::Zero(rows, Index(seen.parts.size()));
  for (std::size_t k = 0; k < seen.parts.size(); ++k)
    for (const std::size_t point : seen.parts[k].points) in_part(Index(point), Index(k)) = 1.0;
  seen.in_part = groups.mean(in_part);
  seen.model = std::make_unique<GroupedModel>(std::move(model), groups);
  return seen;
}

/// What the law misses of every test, and factors on the parts of several that differ: their mean
/// is the rubber's, so that no factor is common to all.
std::vector<ErrorComponent> components_of(const std::vector<Seen>& tests,
                                          const std::vector<ZeroPlaces>& zeros,
                                          const VectorXd& estimates, const VectorXd& computed) {
  ErrorComponent missed{{}, misfit_scale}, factors{{}, factor_scale};
  const auto append = [&](MatrixXd& all, Index first, const MatrixXd& columns) {
    all.conservativeResize(computed.size(), all.cols() + columns.cols());
    all.rightCols(columns.cols()).setZero();
    all.block(first, all.cols() - columns.cols(), columns.rows(), columns.cols()) = columns;
  };
  Index first = 0;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const Index rows = tests[t].way.size();
    VectorXd stress = computed.segment(first, rows);
    if (zeros[t].stress) stress -= estimates(*zeros[t].stress) * tests[t].per_scale;
    // Where stresses are small it is a share of them; large ones count alike, as in the search.
    const VectorXd size = stress.cwiseAbs().cwiseMin(stress.norm() / std::sqrt(double(rows)));
    append(missed.columns, first, size.asDiagonal() * smooth_columns(tests[t].way, smooth_length));
    append(factors.columns, first, stress.asDiagonal() * tests[t].in_part);
    first += rows;
  }
  std::vector<ErrorComponent> components{missed};
  if (factors.columns.cols() < 2) return components;
  components.push_back(factors);
  return components;
}

/// Of the errors of means of specimens, shares of the stresses that are computed: by those that are
/// measured a fit to nothing at all would seem as good (Peelle's puzzle).
MatrixXd covariance_of(const std::vector<Seen>& tests, const VectorXd& estimates, Index values) {
  MatrixXd covariance;
  Index first = 0;
  for (const Seen& test : tests) {
    const Index rows = test.way.size();
    if (test.of_mean > 0.0) {
      if (covariance.size() == 0) covariance = MatrixXd::Zero(values, values);
      const VectorXd off = test.of_mean * test.model->evaluate(estimates).value;
      covariance.block(first, first, rows, rows) = off * off.transpose();
    }
    first += rows;
  }
  return covariance;
}

/// AICc with errors that hang together, k being the parameters without a prior and a deviation.
double criterion_of(const ValueErrors& errors, const std::vector<FreeParameter>& free,
                    Index values) {
  const double n = double(values),
               k = 1.0 + double(std::ranges::count_if(
                             free, [](const FreeParameter&each) { return !each.prior; }));
  return n <= k + 1.0
             ? std::numeric_limits<double>::infinity()
             : -2.0 * errors.log_likelihood + 2.0 * k + 2.0 * k * (k + 1.0) / (n - k - 1.0);
}

}  // namespace

std::vector<ZeroPlaces> add_zeros(const std::vector<MaterialTest>& tests, bool usual,
                                  CurveFitOptions& options) {
  std::vector<ZeroPlaces> places(tests.size());
  const auto append = [&](FreeParameter free, const std::string& of) {
    free.of = of;
    options.free.push_back(std::move(free));
    for (VectorXd& start : options.other_starts) {
      start.conservativeResize(start.size() + 1);
      start(start.size() - 1) = 0.0;
    }
    return Index(options.free.size()) - 1;
  };
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const MaterialTest& test = tests[t];
    const double most = largest_stress(test), reach = reach_of(test);
    FreeParameter stress{
        .parameter = MaterialParameter::stress_zero, .lower = -most, .upper = most, .scale = most},
        strain{.parameter = MaterialParameter::strain_zero,
               .lower = -0.5 * reach,
               .upper = 0.5 * reach,
               .scale = reach};
    if (!test.stress_zero_sought)
      stress.prior = test.stress_zero_known ? Prior{0.0, test.stress_zero_error}
                                            : Prior{0.0, usual_zero * most, true};
    if (!test.strain_zero_sought) strain.prior = Prior{0.0, usual_zero * reach, true};
    const auto is_free = [&](const FreeParameter& zero) {
      return !zero.prior || (usual && changes_shape(test) && zero.prior->deviation > 0.0);
    };
    if (is_free(stress)) places[t].stress = append(stress, test.name);
    if (is_free(strain)) places[t].strain = append(strain, test.name);
  }
  return places;
}

void add_posterior(const LawCurves& data, const CurveFitOptions& options, LawFit& fit) {
  PosteriorInput input;
  input.options = options;
  input.options.start_once();
  const std::vector<ZeroPlaces> before =
      std::exchange(fit.zeros, add_zeros(data.tests, true, input.options));
  const std::vector<ZeroPlaces>& zeros = fit.zeros;
  const Index own = Index(options.free.size());
  CurveFit first = fit.fit;
  first.estimates = VectorXd::Zero(Index(input.options.free.size()));
  first.estimates.head(own) = fit.fit.estimates.head(own);
  for (std::size_t t = 0; t < zeros.size(); ++t) {
    if (before[t].stress) first.estimates(*zeros[t].stress) = fit.fit.estimates(*before[t].stress);
    if (before[t].strain) first.estimates(*zeros[t].strain) = fit.fit.estimates(*before[t].strain);
  }
  std::vector<Seen> tests;
  const std::vector<MaterialParameter> parameters = parameters_in(input.options);
  for (std::size_t t = 0; t < data.tests.size(); ++t) {
    tests.push_back(seen_of(data, t,
                            std::make_unique<ZeroedModel>(data.tests[t], data.scales[t], fit.choice,
                                                          parameters, zeros[t])));
    input.curves.push_back(tests.back().curve);
    input.models.push_back(tests.back().model.get());
  }
  std::vector<VectorXd> deviations;
  for (const Seen& test : tests) deviations.push_back(test.deviation);
  input.deviations = stacked(deviations);
  input.begins_open = false;  // zeros of stress and strain are nearly the same
  input.noise_told = !data.curves.front().sigma.empty();
  input.options.model_covariance = covariance_of(tests, first.estimates, input.deviations.size());
  input.components = [&](const VectorXd& estimates, const VectorXd& computed) {
    return components_of(tests, zeros, estimates, computed);
  };
  Posterior found = posterior_fit(input, first);
  put_posterior(found.errors, found.options.free, found.fit);
  fit.aicc = criterion_of(found.errors, input.options.free, input.deviations.size());
  // What tells of the search, and of the values themselves, stays.
  found.fit.minima = fit.fit.minima;
  found.fit.converged = found.fit.converged && fit.fit.converged;
  found.fit.evaluations += fit.fit.evaluations;
  found.fit.chi_square = fit.fit.chi_square;
  found.fit.chi_square_probability = fit.fit.chi_square_probability;
  found.fit.birge_ratio = 1.0;
  found.fit.residual_deviation = found.errors.noise;
  found.fit.unidentifiable = fit.fit.unidentifiable;
  fit.fit = std::move(found.fit);
  Index row = 0;
  const VectorXd values = all_values(input.curves);
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const auto rows = Eigen::seqN(row, tests[t].way.size());
    for (std::size_t k = 0; k < tests[t].parts.size(); ++k) {
      const VectorXd weight = tests[t].in_part.col(Index(k)),
                     stress = values(rows).cwiseProduct(weight);
      const auto along = [&](std::size_t c) -> VectorXd {
        return found.errors.parts[c](rows).cwiseProduct(weight);
      };
      PartErrors& errors = fit.parts.emplace_back(PartErrors{t, tests[t].parts[k]});
      errors.misfit = along(0).norm() / stress.norm();
      errors.misfit_seen = found.errors.seen[0] > 6.0;
      if (found.errors.parts.size() > 1)
        errors.factor = 1.0 / (1.0 - along(1).dot(stress) / stress.squaredNorm());
    }
    row += tests[t].way.size();
  }
}

}  // namespace fingertip::calibration::inline material_tests
