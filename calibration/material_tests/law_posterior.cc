#include "calibration/material_tests/law_posterior.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "calibration/material_tests/strain_grid.h"
#include "calibration/material_tests/zeroed_model.h"
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

/// The law's own stress, of `computed` with a zero, over the scale.
VectorXd stress_of(const Seen& test, const ZeroPlaces& zeros, const VectorXd& estimates,
                   VectorXd computed) {
  if (zeros.stress) computed -= estimates(*zeros.stress) * test.per_scale;
  return computed;
}

/// What the law misses of every test, and factors on the parts of several.
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
    const VectorXd stress = stress_of(tests[t], zeros[t], estimates, computed.segment(first, rows));
    // Where stresses are small it is a share of them; large ones count alike, as in the search.
    const VectorXd size = stress.cwiseAbs().cwiseMin(stress.norm() / std::sqrt(double(rows)));
    append(missed.columns, first, size.asDiagonal() * smooth_columns(tests[t].way, smooth_length));
    append(factors.columns, first, stress.asDiagonal() * tests[t].in_part);
    first += rows;
  }
  std::vector<ErrorComponent> components{missed};
  if (factors.columns.cols() > 1) components.push_back(factors);
  return components;
}

/// Of the errors of means of specimens, shares of the stresses that are computed: by those that are
/// measured a fit to nothing at all would seem as good (Peelle's puzzle).
MatrixXd covariance_of(const std::vector<Seen>& tests, const std::vector<ZeroPlaces>& zeros,
                       const VectorXd& estimates, Index values) {
  MatrixXd covariance;
  Index first = 0;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const Index rows = tests[t].way.size();
    if (tests[t].of_mean > 0.0) {
      if (covariance.size() == 0) covariance = MatrixXd::Zero(values, values);
      const VectorXd off = tests[t].of_mean * stress_of(tests[t], zeros[t], estimates,
                                                        tests[t].model->evaluate(estimates).value);
      covariance.block(first, first, rows, rows) = off * off.transpose();
    }
    first += rows;
  }
  return covariance;
}

/// -2 ln of Cauchy's density over that of the normal one in its place, of zeros beyond what is
/// usual.
double heavy_tails(const std::vector<FreeParameter>& told, const std::vector<FreeParameter>& used,
                   const VectorXd& estimates) {
  double sum = 0.0;
  for (std::size_t j = 0; j < told.size(); ++j) {
    if (!told[j].prior || !told[j].prior->heavy_tails) continue;
    const double own = told[j].prior->deviation, normal = used[j].prior->deviation,
                 zero = estimates(Index(j)) - told[j].prior->mean;
    sum +=
        2.0 * std::log(own * (1.0 + std::pow(zero / own, 2)) / normal) - std::pow(zero / normal, 2);
  }
  return sum;
}

/// AICc with errors that hang together, k being the parameters without a prior and a deviation.
double criterion_of(const Posterior& found, const std::vector<FreeParameter>& told, Index values) {
  constexpr double odd_one_in = 25.0;
  const double n = double(values),
               k = 1.0 + double(std::ranges::count_if(
                             told, [](const FreeParameter&each) { return !each.prior; }));
  return -2.0 * found.errors.log_likelihood +
         heavy_tails(told, found.options.free, found.fit.estimates) +
         2.0 * std::log(odd_one_in) * double(found.odd.size()) + aicc_penalty(n, k);
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

namespace {

/// G and its ends, each as many standard errors away as the furthest of any coefficient.
std::array<double, 3> modulus_interval(const LawChoice& choice, const CurveFit& fit) {
  const VectorXd slopes = shear_modulus_slopes(choice, fit.estimates);
  const Index own = slopes.size();
  const double g = sized_law(choice, fit.estimates).shear_modulus,
               deviation = std::sqrt(slopes.dot(fit.covariance.topLeftCorner(own, own) * slopes));
  double below = 0.0, above = 0.0;
  for (Index i = 0; i < own; ++i) {
    const double error = fit.standard_errors(i);
    if (!(error > 0.0)) continue;
    const double down = (fit.estimates(i) - fit.lower(i)) / error,
                 up = (fit.upper(i) - fit.estimates(i)) / error;
    below = std::max(below, slopes(i) < 0.0 ? up : down);
    above = std::max(above, slopes(i) < 0.0 ? down : up);
  }
  return {g, g - below * deviation, g + above * deviation};
}

/// Of the posterior, whose parameters stand at `places`, what `fit` has.
void put_intervals(const CurveFit& posterior, const std::vector<Index>& places, CurveFit& fit) {
  fit.covariance = posterior.covariance(places, places);
  fit.correlation = posterior.correlation(places, places);
  fit.standard_errors = posterior.standard_errors(places);
  fit.lower = fit.estimates.cwiseMin(posterior.lower(places));
  fit.upper = fit.estimates.cwiseMax(posterior.upper(places));
  fit.birge_ratio = 1.0;
}

/// `places` of all zeros among those of the posterior, `sought` that are not usual ones.
UsualZeros usual_zeros(const MaterialTest& test, const SizedLaw& law, const ZeroPlaces& places,
                       const ZeroPlaces& sought, const CurveFit& posterior) {
  UsualZeros usual;
  if (!changes_shape(test)) return usual;
  constexpr double step = 1e-5;
  const double slope = test_stress(law, test.kind, test.measure, rest_of(test.kind) + step) / step;
  VectorXd by = VectorXd::Zero(posterior.estimates.size());  // d(stress at rest)/d(parameters)
  if (places.stress && !sought.stress) {
    by(*places.stress) = 1.0;
    usual.stress = posterior.estimates(*places.stress);
    usual.at_rest_usual = usual_zero * largest_stress(test);
  }
  if (places.strain && !sought.strain) {
    by(*places.strain) = -slope;
    usual.strain = posterior.estimates(*places.strain);
    usual.at_rest_usual = std::hypot(usual.at_rest_usual, slope * usual_zero * reach_of(test));
  }
  usual.at_rest = usual.stress - slope * usual.strain;
  usual.at_rest_error = std::sqrt(by.dot(posterior.covariance * by));
  return usual;
}

}  // namespace

void add_posterior(const LawCurves& data, const CurveFitOptions& options, LawFit& fit) {
  PosteriorInput input;
  input.options = options;
  input.options.start_once();
  const std::vector<ZeroPlaces> zeros = add_zeros(data.tests, true, input.options);
  const Index own = Index(options.free.size());
  CurveFit first = fit.fit;
  first.estimates = VectorXd::Zero(Index(input.options.free.size()));
  first.estimates.head(own) = fit.fit.estimates.head(own);
  std::vector<Index> places(std::size_t(fit.fit.estimates.size()));  // of what is sought
  for (Index j = 0; j < own; ++j) places[std::size_t(j)] = j;
  for (std::size_t t = 0; t < zeros.size(); ++t)
    for (const auto zero : {&ZeroPlaces::stress, &ZeroPlaces::strain})
      if (const auto& place = fit.zeros[t].*zero) {
        places[std::size_t(*place)] = *(zeros[t].*zero);
        first.estimates(*(zeros[t].*zero)) = fit.fit.estimates(*place);
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
  input.options.model_covariance =
      covariance_of(tests, zeros, first.estimates, input.deviations.size());
  input.components = [&](const VectorXd& estimates, const VectorXd& computed) {
    return components_of(tests, zeros, estimates, computed);
  };
  Posterior found = posterior_fit(input, first);
  put_posterior(found.errors, found.options.free, found.fit);
  put_intervals(found.fit, places, fit.fit);
  fit.modulus = modulus_interval(fit.choice, found.fit);
  fit.aicc = criterion_of(found, input.options.free, input.deviations.size());
  const SizedLaw law = sized_law(fit.choice, found.fit.estimates);
  for (std::size_t t = 0; t < zeros.size(); ++t)
    fit.usual.push_back(usual_zeros(data.tests[t], law, zeros[t], fit.zeros[t], found.fit));
  const VectorXd values = all_values(input.curves), noise = found.errors.noise * input.deviations,
                 left = linearised(input.curves, input.models, input.options.free, first.estimates)
                            .residuals;
  Index row = 0;
  for (std::size_t t = 0; t < tests.size(); ++t) {
    const auto rows = Eigen::seqN(row, tests[t].way.size());
    for (std::size_t k = 0; k < tests[t].parts.size(); ++k) {
      const VectorXd weight = tests[t].in_part.col(Index(k)),
                     stress = values(rows).cwiseProduct(weight);
      if (!(stress.squaredNorm() > 0.0)) continue;
      const VectorXd off = left(rows).cwiseProduct(weight), by_law = stress - off;
      const double factor = off.dot(by_law) / by_law.squaredNorm();
      PartErrors& errors = fit.parts.emplace_back(PartErrors{t, tests[t].parts[k]});
      errors.misfit = std::sqrt(std::max(0.0, (off - factor * by_law).squaredNorm() -
                                                  noise(rows).cwiseProduct(weight).squaredNorm()) /
                                stress.squaredNorm());
      errors.misfit_seen = found.errors.seen[0] > 6.0;
      if (found.errors.parts.size() > 1)
        errors.factor = 1.0 / (1.0 - found.errors.parts[1](rows).cwiseProduct(weight).dot(stress) /
                                         stress.squaredNorm());
    }
    row += tests[t].way.size();
  }
}

ModulusOfLaws modulus_of(const LawFit& fit) {
  const double g = fit.law.shear_modulus;
  const auto ends = fit.modulus ? *fit.modulus : modulus_interval(fit.choice, fit.fit);
  return {g, std::min(g, ends[1]), std::max(g, ends[2]), {&fit}};
}

}  // namespace fingertip::calibration::inline material_tests
