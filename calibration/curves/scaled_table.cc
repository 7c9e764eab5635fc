#include "calibration/curves/scaled_table.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "meshes/errors.h"
#include "meshes/files.h"

namespace fingertip::calibration {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using meshes::InvalidInput;
using meshes::to_text;
using meshes::Violation;

namespace {

std::string range_text(double lower, double upper) {
  return to_text(lower) + " to " + to_text(upper);
}

/// T_0 ... T_(count-1) and their derivatives by t, |t| <= 1.
struct Chebyshev {
  VectorXd value, slope;
};

Chebyshev chebyshev(double t, Index count) {
  Chebyshev result{VectorXd::Zero(count), VectorXd::Zero(count)};
  result.value(0) = 1.0;
  if (count > 1) result.value(1) = t, result.slope(1) = 1.0;
  for (Index k = 2; k < count; ++k) {
    result.value(k) = 2.0 * t * result.value(k - 1) - result.value(k - 2);
    result.slope(k) =
        2.0 * result.value(k - 1) + 2.0 * t * result.slope(k - 1) - result.slope(k - 2);
  }
  return result;
}

void check_nodes(const std::vector<double>& nodes, const MatrixXd& scaled,
                 std::vector<Violation>& found) {
  std::vector<double> sorted = nodes;
  std::ranges::sort(sorted);
  for (const double nu : nodes)
    if (!(nu > -1.0 && nu < 0.5))
      found.push_back({"poissons_ratios", to_text(nu), "a Poisson's ratio lies in (-1, 1/2)",
                       "choose the nodes inside"});
  if (nodes.size() < 3 || std::ranges::adjacent_find(sorted) != sorted.end())
    found.push_back({"poissons_ratios", std::to_string(nodes.size()) + " nodes",
                     "a table needs at least three nodes, all different", "see chebyshev_nodes"});
  if (scaled.rows() == 0 || scaled.cols() != Index(nodes.size()) || !scaled.allFinite())
    found.push_back({"scaled",
                     std::to_string(scaled.rows()) + " x " + std::to_string(scaled.cols()),
                     "a table has a row per abscissa and a column per node, of finite numbers",
                     "compute the missing runs"});
}

void check_parameters(const std::vector<MaterialParameter>& parameters, const meshes::Rubber& held,
                      std::vector<Violation>& found) {
  using enum MaterialParameter;
  const auto free = [&](MaterialParameter p) { return std::ranges::count(parameters, p); };
  const bool scale = parameters.size() == 1 && free(modulus) == 1;
  if (!scale && (parameters.empty() || free(youngs_modulus) > 1 || free(shear_modulus) > 1 ||
                 free(youngs_modulus) + free(shear_modulus) != std::ssize(parameters)))
    found.push_back({"parameters", std::to_string(parameters.size()) + " parameters",
                     "a table in Poisson's ratio depends on youngs_modulus and shear_modulus alone",
                     "name one or both of them, each once, or modulus alone"});
  if (free(youngs_modulus) == 0 &&
      !(held.youngs_modulus > 0.0 && std::isfinite(held.youngs_modulus)))
    found.push_back({"rubber.youngs_modulus", to_text(held.youngs_modulus) + " Pa",
                     "what is not sought must be known, and positive", "give its value"});
  if (free(shear_modulus) == 0 && !(held.shear_modulus > 0.0 && std::isfinite(held.shear_modulus)))
    found.push_back({"rubber.shear_modulus", to_text(held.shear_modulus) + " Pa",
                     "what is not sought must be known, and positive", "give its value"});
}

}  // namespace

std::vector<double> chebyshev_nodes(double lower, double upper, int count) {
  if (!(lower < upper) || count < 2)
    throw InvalidInput({"poissons_ratios",
                        std::to_string(count) + " nodes from " + range_text(lower, upper),
                        "nodes need an interval and are at least two", "widen the range"});
  std::vector<double> nodes;
  for (int k = 0; k < count; ++k) {
    // By the sine of a centred angle: symmetric to the last bit.
    const double angle = std::numbers::pi / 2.0 * (2 * k - (count - 1)) / (count - 1);
    nodes.push_back(0.5 * (lower + upper) + 0.5 * (upper - lower) * std::sin(angle));
  }
  nodes.front() = lower;
  nodes.back() = upper;
  return nodes;
}

ScaledTable::ScaledTable(const std::vector<double>& poissons_ratios, const MatrixXd& scaled,
                         std::vector<MaterialParameter> parameters, const meshes::Rubber& held)
    : parameters_(std::move(parameters)), held_(held) {
  std::vector<Violation> found;
  check_nodes(poissons_ratios, scaled, found);
  check_parameters(parameters_, held_, found);
  if (!found.empty()) throw InvalidInput(found);

  std::vector<Index> order(poissons_ratios.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](Index i) { return poissons_ratios[std::size_t(i)]; });
  std::vector<double> nodes;
  for (const Index i : order) nodes.push_back(poissons_ratios[std::size_t(i)]);
  lower_ = nodes.front();
  upper_ = nodes.back();
  const MatrixXd sorted = scaled(Eigen::all, order);
  coefficients_ = through(nodes, sorted);
  interpolation_error_ = error_of_half(nodes, sorted);
}

MatrixXd ScaledTable::through(const std::vector<double>& nodes, const MatrixXd& scaled) const {
  const Index count = Index(nodes.size());
  MatrixXd basis(count, count);
  for (Index i = 0; i < count; ++i) {
    const double t = (2.0 * nodes[std::size_t(i)] - lower_ - upper_) / (upper_ - lower_);
    basis.row(i) = chebyshev(t, count).value.transpose();
  }
  return basis.householderQr().solve(scaled.transpose()).transpose();
}

ScaledTable::ValueAndSlope ScaledTable::at(const MatrixXd& coefficients, double nu) const {
  const double t = (2.0 * nu - lower_ - upper_) / (upper_ - lower_);
  const Chebyshev basis = chebyshev(t, coefficients.cols());
  return {coefficients * basis.value, coefficients * basis.slope * (2.0 / (upper_ - lower_))};
}

VectorXd ScaledTable::error_of_half(const std::vector<double>& nodes,
                                    const MatrixXd& scaled) const {
  std::vector<double> kept;
  std::vector<Index> columns, left_out;
  for (Index i = 0; i < std::ssize(nodes); ++i)
    (i % 2 == 0 || i + 1 == std::ssize(nodes) ? columns : left_out).push_back(i);
  for (const Index column : columns) kept.push_back(nodes[std::size_t(column)]);
  const MatrixXd half = through(kept, scaled(Eigen::all, columns));
  VectorXd worst = VectorXd::Zero(scaled.rows());
  for (const Index column : left_out) {
    const VectorXd missed = at(half, nodes[std::size_t(column)]).value - scaled.col(column);
    for (Index i = 0; i < worst.size(); ++i)  // no force and none expected is no error
      if (missed(i) != 0.0) worst(i) = std::max(worst(i), std::abs(missed(i) / scaled(i, column)));
  }
  return worst;
}

double ScaledTable::inside(double nu) const {
  const double round_off = 1e-12 * (upper_ - lower_);
  if (!(nu >= lower_ - round_off && nu <= upper_ + round_off))
    throw InvalidInput({"poissons_ratio", to_text(nu),
                        "the table holds from " + range_text(lower_, upper_),
                        "bound E and G accordingly, or make a wider table"});
  return std::clamp(nu, lower_, upper_);
}

CurveSlopes ScaledTable::evaluate(const VectorXd& parameters) {
  const meshes::Rubber rubber = with_moduli(held_, parameters_, parameters);
  const double e = rubber.youngs_modulus, g = rubber.shear_modulus;
  if (!(e > 0.0 && g > 0.0))
    throw InvalidInput({"rubber", "E = " + to_text(e) + " Pa, G = " + to_text(g) + " Pa",
                        "moduli are positive", "bound E and G from below"});
  const double nu = inside(e / (2.0 * g) - 1.0);
  const ValueAndSlope phi = at(coefficients_, nu);
  MatrixXd by_moduli(phi.value.size(), 2);
  by_moduli << 0.5 * phi.slope, phi.value - (1.0 + nu) * phi.slope;
  CurveSlopes result{g * phi.value, MatrixXd(phi.value.size(), Index(parameters_.size()))};
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    result.jacobian.col(Index(i)) = by_moduli * moduli_slopes(parameters_[i], nu);
  return result;
}

}  // namespace fingertip::calibration
