#include "calibration/press_fit/scaled_model.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;
using meshes::InvalidInput;
using meshes::to_text;

namespace {

constexpr int nodes_per_unit = 8;
constexpr int highest_node = 4 * nodes_per_unit;
const std::vector<int> first_nodes = {0, 8, 16, 24};
/// Distances of nodes that are added. Closer ones are for a confined finger, where phi is off by
/// more than that of neighbouring meshes.
constexpr int usual_distance = nodes_per_unit / 2;
constexpr int closer_distances[] = {nodes_per_unit / 4, nodes_per_unit / 8};
constexpr double confined_error = 3.0 * ScaledModel::tolerance;
/// exp(-4) (1 + eps) - eps = 1 - 2 highest_ratio.
const double bend = (std::exp(-4.0) - 1.0 + 2.0 * ScaledModel::highest_ratio) / -std::expm1(-4.0);

/// u of a Poisson's ratio, in nodes.
double place_of(double poissons_ratio) {
  return nodes_per_unit * std::log((1.0 + bend) / (1.0 - 2.0 * poissons_ratio + bend));
}

double ratio_at(int node) {
  return 0.5 * (1.0 + bend) * -std::expm1(-double(node) / nodes_per_unit);
}

/// What a polynomial through values at nodes takes of each: for its value and slope at a place, and
/// for its error within an eighth of u from there, as large as the next divided difference by u is,
/// half the last.
struct Weights {
  Weights(const std::vector<double>& nodes, double place)
      : value(Index(nodes.size())), slope(value.size()), error(value.size()) {
    double distances = 1.0, growth = 0.0;  // of the product of distances to all nodes
    for (Index i = 0; i < value.size(); ++i) {
      double v = 1.0, s = 0.0, difference = 1.0;
      for (Index j = 0; j < value.size(); ++j) {
        if (j == i) continue;
        const double apart = nodes[std::size_t(i)] - nodes[std::size_t(j)],
                     factor = (place - nodes[std::size_t(j)]) / apart;
        s = s * factor + v / apart;
        v *= factor;
        difference /= apart;
      }
      value(i) = v, slope(i) = s, error(i) = difference;
      const double distance = place - nodes[std::size_t(i)];
      growth = growth * distance + distances;
      distances *= distance;
    }
    constexpr double next = 0.5, around = 0.125;
    error *= next * (std::abs(distances) / nodes_per_unit + around * std::abs(growth));
  }
  VectorXd value, slope, error;
};

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
                         const meshes::Rubber& held, double lowest_ratio, Use use,
                         Interpolation interpolation)
    : solver_(std::move(solver)),
      parameters_(std::move(parameters)),
      held_(held),
      lowest_ratio_(lowest_ratio),
      use_(use),
      interpolation_(interpolation) {
  check_parameters(parameters_, held_);
}

bool ScaledModel::holds_ratio() const {
  return parameters_ == std::vector{MaterialParameter::modulus};
}

double ScaledModel::ratio_of(const meshes::Rubber& rubber) const {
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
  return std::clamp(nu, lowest_ratio_, highest_ratio);
}

void ScaledModel::ask(const std::vector<int>& nodes) {
  std::vector<double> ratios;
  for (const int node : nodes) ratios.push_back(ratio_at(node));
  std::vector<VectorXd> answers = solver_(ratios);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes_[nodes[i]] = std::move(answers.at(i));
}

void ScaledModel::ask_first(double nu) {
  std::vector<int> first = first_nodes;
  if (use_ == Use::near_one_ratio) {
    const double least = std::ceil(place_of(lowest_ratio_) / usual_distance) + 1.0,
                 below = std::floor(place_of(nu) / usual_distance);
    const int node =
        usual_distance * int(std::clamp(below, least, double(highest_node / usual_distance - 2)));
    first = {node - usual_distance, node, node + usual_distance, node + 2 * usual_distance};
  }
  try {
    ask(first);
  } catch (const meshes::NotConverged&) {
    for (const int node : first) try {
        ask({node});
      } catch (const meshes::NotConverged&) {
        continue;
      }
    if (nodes_.size() >= 2) return;
    nodes_.clear();
    throw;
  }
}

ScaledModel::Answer ScaledModel::at(double nu) {
  if (holds_ratio()) {
    if (held_forces_.size() == 0) held_forces_ = solver_({held_.poissons_ratio()}).at(0);
    return {held_forces_, VectorXd::Zero(held_forces_.size())};  // no slope is felt at held nu
  }
  if (nodes_.empty()) ask_first(nu);
  std::vector<double> places;
  MatrixXd known(nodes_.begin()->second.size(), Index(nodes_.size()));
  for (const auto& [node, phi] : nodes_) {
    known.col(Index(places.size())) = phi;
    places.push_back(node);
  }
  const Weights weights(places, place_of(nu));
  Answer answer{VectorXd(known.rows()), VectorXd(known.rows())};
  VectorXd errors(known.rows());
  for (Index i = 0; i < known.rows(); ++i) {
    RowVectorXd y = known.row(i);
    const bool positive = interpolation_ == Interpolation::logarithmic &&
                          y.minCoeff() > 0.0;  // else it has no logarithm
    if (positive) y = y.array().log();
    const double value = y * weights.value;
    answer.value(i) = positive ? std::exp(value) : value;
    const double unit = positive ? answer.value(i) : 1.0;
    answer.slope(i) = unit * (y * weights.slope).value();
    errors(i) = unit * (y * weights.error).value();
  }
  answer.slope *= 2.0 * nodes_per_unit / (1.0 - 2.0 * nu + bend);  // d(place)/dnu
  answer.error = errors.norm() / answer.value.norm();
  return answer;
}

CurveSlopes ScaledModel::evaluate(const VectorXd& parameters) {
  const meshes::Rubber rubber = with_moduli(held_, parameters_, parameters);
  const double nu = ratio_of(rubber);
  const Answer phi = at(nu);
  MatrixXd by_moduli(phi.value.size(), 2);
  by_moduli << 0.5 * phi.slope, phi.value - (1.0 + nu) * phi.slope;
  CurveSlopes result{rubber.shear_modulus * phi.value,
                     MatrixXd(phi.value.size(), Index(parameters_.size()))};
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    result.jacobian.col(Index(i)) = by_moduli * moduli_slopes(parameters_[i], nu);
  return result;
}

std::optional<int> ScaledModel::nearest_unknown(double place, int apart) const {
  const double from = std::max(place - 2 * apart, place_of(lowest_ratio_)),
               to = std::min<double>(place + 2 * apart, highest_node);
  std::optional<int> nearest;
  for (int node = apart * int(std::ceil(from / apart)); node <= to; node += apart)
    if (!nodes_.contains(node) && (!nearest || std::abs(node - place) < std::abs(*nearest - place)))
      nearest = node;
  return nearest;
}

bool ScaledModel::refine(const VectorXd& parameters) {
  if (holds_ratio() || use_ == Use::near_one_ratio) return false;
  const double nu = ratio_of(with_moduli(held_, parameters_, parameters)), place = place_of(nu);
  const double error = at(nu).error;
  // The last difference of the first few may be next to nothing by chance.
  if (error <= tolerance && nodes_.size() > first_nodes.size()) return false;
  std::optional<int> node = nearest_unknown(place, usual_distance);
  for (const int closer : closer_distances)
    if (!node && error > confined_error) node = nearest_unknown(place, closer);
  if (!node) return false;
  try {
    ask({*node});
  } catch (const meshes::NotConverged&) {
    return false;
  }
  return true;
}

}  // namespace fingertip::calibration::inline press_fit
