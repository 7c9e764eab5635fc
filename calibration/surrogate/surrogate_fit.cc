// The least-squares spline behind fit_surrogate. Lengths over the depth, forces over the largest.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "calibration/statistics/non_negative.h"
#include "calibration/surrogate/surrogate.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline surrogate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;
using meshes::to_text;

constexpr double quantile = 1.959963984540054;  ///< of the normal distribution, 97.5 %
constexpr double min_slope = 1e-6;              ///< over the mean slope
/// Weight of the curvature of F' against the residuals: suits the static lattice from R/6 to R/12.
constexpr double smoothing = 3e-7;
constexpr int knot_intervals = 12;  ///< measured on presses (README)

/// Quadratic B-splines on [0, 1] for F', and their integrals for F.
class SlopeBasis {
 public:
  explicit SlopeBasis(int intervals) : knots_(intervals + 1), integrals_(intervals + 1, size()) {
    for (int k = 0; k <= intervals; ++k) knots_(k) = std::pow(double(k) / intervals, 2);
    integrals_.row(0).setZero();
    for (int k = 0; k < intervals; ++k)
      integrals_.row(k + 1) = integrals_.row(k) + within(k, knots_(k + 1));
  }

  Index size() const { return knots_.size() + 1; }
  const VectorXd& knots() const { return knots_; }
  /// Rows: knots.
  const MatrixXd& integrals() const { return integrals_; }

  RowVectorXd value(double x) const { return value(interval(x), x); }
  RowVectorXd integral(double x) const {
    const int k = interval(x);
    return integrals_.row(k) + within(k, x);
  }
  /// Where coefficient j acts (Greville), as a share of the knots' index.
  double place(Index j) const { return std::sqrt(0.5 * (knot(j + 1) + knot(j + 2))); }

 private:
  /// The knots with the ends three times.
  double knot(Index i) const { return knots_(std::clamp<Index>(i - 2, 0, knots_.size() - 1)); }
  int interval(double x) const {
    int k = 0;
    while (k + 2 < knots_.size() && x >= knots_(k + 1)) ++k;
    return k;
  }
  /// de Boor's recursion on interval k.
  RowVectorXd value(int k, double x) const {
    const auto rising = [&](Index i, int degree) {
      return (x - knot(i)) / (knot(i + degree) - knot(i));
    };
    const double up = rising(k + 2, 1);
    const double first = rising(k + 1, 2), second = rising(k + 2, 2);
    RowVectorXd all = RowVectorXd::Zero(size());
    all(k) = (1.0 - first) * (1.0 - up);
    all(k + 1) = first * (1.0 - up) + (1.0 - second) * up;
    all(k + 2) = second * up;
    return all;
  }
  /// Integral from knot k to x, exact for quadratics (Simpson).
  RowVectorXd within(int k, double x) const {
    const double from = knots_(k);
    return (x - from) / 6.0 * (value(k, from) + 4.0 * value(k, 0.5 * (from + x)) + value(k, x));
  }

  VectorXd knots_;
  MatrixXd integrals_;
};

/// Second derivatives of F' over the knots' index share.
MatrixXd curvature(const SlopeBasis& basis) {
  MatrixXd rows = MatrixXd::Zero(basis.size() - 2, basis.size());
  const double weight = std::sqrt(1.0 / double(basis.size()));
  for (Index j = 0; j < rows.rows(); ++j) {
    const double a = basis.place(j), b = basis.place(j + 1), c = basis.place(j + 2);
    rows.row(j).segment<3>(j) << 2.0 / ((b - a) * (c - a)), -2.0 / ((b - a) * (c - b)),
        2.0 / ((c - b) * (c - a));
  }
  return weight * rows;
}

/// The samples over depth and largest force. Residuals count in units of F^(2/3): a contact that is
/// wrong by a share of the spacing has an error of the force ∝ a², the force being ∝ a³ (Hertz).
struct Scaled {
  VectorXd place, force, unit;
  double depth, most;
};

VectorXd units(const VectorXd& force) {
  // The floor keeps a force of next to nothing from ruling the fit.
  return force.array().max(0.0).pow(2.0 / 3.0).max(1e-3);
}

Scaled scaled(const std::vector<SurrogateSample>& samples) {
  const Index m = Index(samples.size());
  Scaled s{VectorXd(m), VectorXd(m), {}, samples.back().indentation, 0.0};
  for (Index i = 0; i < m; ++i) {
    s.place(i) = samples[std::size_t(i)].indentation / s.depth;
    s.force(i) = samples[std::size_t(i)].force;
  }
  s.most = s.force.maxCoeff();
  s.force /= s.most;
  s.unit = units(s.force);
  return s;
}

/// Coefficients of F' for the scaled samples.
VectorXd fitted(const SlopeBasis& basis, const Scaled& s) {
  const Index m = s.place.size(), size = basis.size();
  const MatrixXd penalty = curvature(basis);
  MatrixXd rows(m + penalty.rows(), size);
  VectorXd wanted = VectorXd::Zero(rows.rows());
  for (Index i = 0; i < m; ++i) rows.row(i) = basis.integral(s.place(i)) / s.unit(i);
  wanted.head(m) = s.force.cwiseQuotient(s.unit);
  rows.bottomRows(penalty.rows()) = std::sqrt(double(m) * smoothing) * penalty;
  VectorXd least = VectorXd::Constant(size, min_slope);
  least(0) = 0.0;
  return least + non_negative_least_squares(rows, wanted - rows * least);
}

/// At every knot the largest of `values` of the samples in the intervals beside it, so that a line
/// between knots covers every sample, and at least `floor`.
VectorXd covering(const VectorXd& knots, const VectorXd& place, const VectorXd& values,
                  const VectorXd& floor) {
  VectorXd cover = floor;
  for (Index k = 0; k < knots.size(); ++k) {
    const double from = k > 0 ? knots(k - 1) : 0.0;
    const double to = k + 1 < knots.size() ? knots(k + 1) : 1.0;
    for (Index i = 0; i < place.size(); ++i)
      if (place(i) >= from && place(i) <= to) cover(k) = std::max(cover(k), values(i));
  }
  return cover;
}

/// Linear between the samples and from 0 at 0.
VectorXd interpolated(const VectorXd& knots, const VectorXd& place, const VectorXd& values) {
  VectorXd result(knots.size());
  for (Index k = 0; k < knots.size(); ++k) {
    Index i = 0;
    while (i + 1 < place.size() && place(i) < knots(k)) ++i;
    const double from = i > 0 ? place(i - 1) : 0.0, start = i > 0 ? values(i - 1) : 0.0;
    result(k) = start + (values(i) - start) * (knots(k) - from) / (place(i) - from);
  }
  return result;
}

std::string statement_of(const std::vector<SurrogateSample>& samples, const Scaled& s,
                         const VectorXd& residuals) {
  const auto percent = [](double share) { return to_text(std::round(1e4 * share) / 1e2) + " %"; };
  Index worst = 0;
  const double relative = residuals.cwiseQuotient(s.force).maxCoeff(&worst);
  return std::to_string(samples.size()) + " samples to " + to_text(samples.back().indentation) +
         " m smoothed by a rising cubic spline; largest residual " + percent(residuals.maxCoeff()) +
         " of the largest force, " + percent(relative) + " of its own force (at " +
         to_text(samples[std::size_t(worst)].indentation) +
         " m). The band holds 1.96 standard deviations of the force and the largest residual.";
}

void check(const std::vector<SurrogateSample>& samples) {
  const auto refuse = [](const std::string& key, double value, const char* rule,
                         const char* remedy) {
    throw meshes::InvalidInput({key, to_text(value), rule, remedy});
  };
  if (samples.size() < 5)
    refuse("samples", double(samples.size()), "a curve needs at least 5 samples",
           "compute the force at more depths");
  double before = 0.0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::string at = "samples[" + std::to_string(i) + "].";
    const SurrogateSample& s = samples[i];
    if (!(std::isfinite(s.indentation) && s.indentation > before))
      refuse(at + "indentation", s.indentation, "indentations must be positive and increase",
             "sort them");
    if (!(std::isfinite(s.force) && s.force > 0.0))
      refuse(at + "force", s.force, "forces must be positive", "leave out what does not touch");
    if (!(std::isfinite(s.deviation) && s.deviation >= 0.0))
      refuse(at + "deviation", s.deviation, "a standard deviation must not be negative",
             "0 if there is none");
    before = s.indentation;
  }
}

}  // namespace

Surrogate fit_surrogate(const std::vector<SurrogateSample>& samples, const std::string& condition) {
  check(samples);
  const Scaled s = scaled(samples);
  const SlopeBasis basis(knot_intervals);
  const VectorXd coefficients = fitted(basis, s);

  SurrogateTable table;
  const VectorXd force = basis.integrals() * coefficients;
  VectorXd residuals(s.place.size()), deviations(s.place.size());
  for (Index i = 0; i < residuals.size(); ++i) {
    residuals(i) = std::abs(s.force(i) - basis.integral(s.place(i)) * coefficients);
    deviations(i) = samples[std::size_t(i)].deviation / s.most;
  }
  const double worst = residuals.cwiseQuotient(s.unit).maxCoeff();
  const VectorXd roughness = covering(basis.knots(), s.place, residuals, worst * units(force));
  const VectorXd uncertainty = covering(basis.knots(), s.place, deviations,
                                        interpolated(basis.knots(), s.place, deviations));
  for (Index k = 0; k < force.size(); ++k) {
    table.knots.push_back(s.depth * basis.knots()(k));
    table.force.push_back(s.most * force(k));
    table.stiffness.push_back(s.most / s.depth * basis.value(basis.knots()(k)).dot(coefficients));
    table.band.push_back(s.most * (quantile * uncertainty(k) + roughness(k)));
  }
  table.condition = condition;
  table.statement = statement_of(samples, s, residuals);
  return Surrogate(std::move(table));
}

}  // namespace fingertip::calibration::inline surrogate
