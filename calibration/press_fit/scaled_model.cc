#include "calibration/press_fit/scaled_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using meshes::InvalidInput;
using meshes::to_text;

namespace {

constexpr double node_distance = 0.25;  // in xi
constexpr int stencil = 4;

double xi_of(double poissons_ratio) {
  return -std::log1p(-2.0 * poissons_ratio);
}

double ratio_at(int node) {
  return -0.5 * std::expm1(-node_distance * node);
}

void check_parameters(const std::vector<MaterialParameter>& parameters,
                      const meshes::Rubber& held) {
  using enum MaterialParameter;
  const auto are_of = [&](std::initializer_list<MaterialParameter> ways) {
    return std::ranges::all_of(parameters, [&](MaterialParameter parameter) {
      return std::ranges::count(parameters, parameter) == 1 &&
             std::ranges::find(ways, parameter) != ways.end();
    });
  };
  if (parameters.empty() || !(are_of({youngs_modulus, shear_modulus}) ||
                              are_of({lame_shear, lambda}) || are_of({modulus})))
    throw InvalidInput(
        {"parameters", std::to_string(parameters.size()) + " parameters",
         "forces of an elastic body depend on its moduli alone, described in one way",
         "name youngs_modulus, shear_modulus or both, or lame_shear, lambda or both, or modulus"});
  if (const auto broken = held.violations(); !broken.empty()) throw InvalidInput(broken);
}

}  // namespace

ScaledModel::ScaledModel(Solver solver, std::vector<MaterialParameter> parameters,
                         const meshes::Rubber& held, double lowest_ratio)
    : solver_(std::move(solver)),
      parameters_(std::move(parameters)),
      held_(held),
      lowest_ratio_(lowest_ratio),
      lowest_node_(int(std::ceil(xi_of(lowest_ratio) / node_distance))) {
  check_parameters(parameters_, held_);
}

void ScaledModel::ask(int first) {
  std::vector<int> unknown;
  std::vector<double> ratios;
  for (int node = first; node < first + stencil; ++node)
    if (!nodes_.contains(node)) {
      unknown.push_back(node);
      ratios.push_back(ratio_at(node));
    }
  if (unknown.empty()) return;
  std::vector<VectorXd> answers = solver_(ratios);
  for (std::size_t i = 0; i < unknown.size(); ++i) nodes_[unknown[i]] = std::move(answers.at(i));
}

ScaledModel::ValueAndSlope ScaledModel::at(double nu) {
  if (parameters_ == std::vector{MaterialParameter::modulus}) {
    if (held_forces_.size() == 0) held_forces_ = solver_({held_.poissons_ratio()}).at(0);
    return {held_forces_, VectorXd::Zero(held_forces_.size())};  // no slope is felt at held nu
  }
  const double t = xi_of(nu) / node_distance;
  const int first = std::max(int(std::floor(t)) - 1, lowest_node_);
  ask(first);
  // Lagrange's polynomials and their derivatives by t.
  ValueAndSlope result;
  for (int i = 0; i < stencil; ++i) {
    double value = 1.0, slope = 0.0;
    for (int j = 0; j < stencil; ++j) {
      if (j == i) continue;
      const double factor = (t - (first + j)) / (i - j);
      slope = slope * factor + value / (i - j);
      value *= factor;
    }
    const VectorXd& phi = nodes_.at(first + i);
    if (i == 0) result.value = result.slope = VectorXd::Zero(phi.size());
    result.value += value * phi;
    result.slope += slope * phi;
  }
  result.slope *= 2.0 / ((1.0 - 2.0 * nu) * node_distance);  // dt/dnu
  return result;
}

CurveSlopes ScaledModel::evaluate(const VectorXd& parameters) {
  const meshes::Rubber rubber = with_moduli(held_, parameters_, parameters);
  const double e = rubber.youngs_modulus, g = rubber.shear_modulus;
  if (!(e > 0.0 && g > 0.0))
    throw InvalidInput({"rubber", "E = " + to_text(e) + " Pa, G = " + to_text(g) + " Pa",
                        "moduli are positive", "bound them from below"});
  const double round_off = 1e-12;
  const double nu = e / (2.0 * g) - 1.0;
  if (!(nu >= lowest_ratio_ - round_off && nu <= highest_ratio + round_off))
    throw InvalidInput(
        {"poissons_ratio", to_text(nu),
         "the model holds from " + to_text(lowest_ratio_) + " to " + to_text(highest_ratio),
         "bound the moduli accordingly"});
  const ValueAndSlope phi = at(std::clamp(nu, lowest_ratio_, highest_ratio));
  MatrixXd by_moduli(phi.value.size(), 2);
  by_moduli << 0.5 * phi.slope, phi.value - (1.0 + nu) * phi.slope;
  CurveSlopes result{g * phi.value, MatrixXd(phi.value.size(), Index(parameters_.size()))};
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    result.jacobian.col(Index(i)) = by_moduli * moduli_slopes(parameters_[i], nu);
  return result;
}

}  // namespace fingertip::calibration::inline press_fit
