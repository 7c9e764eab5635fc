#include "calibration/press_fit/stretch_models.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "meshes/base/errors.h"
#include "meshes/base/files.h"

namespace fingertip::calibration::inline press_fit {

using Eigen::Index;
using meshes::InvalidInput;
using meshes::to_text;
using enum MaterialParameter;

namespace {

bool is_of_the_law(MaterialParameter p) {
  return p == lame_shear || p == lambda;
}

void check(const std::vector<MaterialParameter>& parameters, const meshes::Rubber& rubber) {
  std::vector<meshes::Violation> found = rubber.violations();
  if (parameters.empty())
    found.push_back({"parameters", "none", "a fit needs a free parameter", "name at least one"});
  for (auto it = parameters.begin(); it != parameters.end(); ++it) {
    if (!is_modulus(*it) && !is_of_the_law(*it))
      found.push_back({"parameters", std::string(name(*it)),
                       "stretch and shear of a rubber do not depend on it",
                       "choose youngs_modulus and shear_modulus, or lame_shear and lambda"});
    if (std::find(parameters.begin(), it, *it) != it)
      found.push_back({"parameters", std::string(name(*it)), "a parameter is named once",
                       "remove the second one"});
  }
  if (std::ranges::any_of(parameters, is_modulus) && std::ranges::any_of(parameters, is_of_the_law))
    found.push_back({"parameters", "E or G beside lame_shear or lambda",
                     "the rubber is described in one way: by E and G, or by G and lambda",
                     "choose one of them"});
  if (!found.empty()) throw InvalidInput(found);
}

/// ln t of the free sides at ln s; `g` > 0, `lambda` >= 0. The condition in y = ln t,
/// g (e^2y - 1) + lambda (ln s + 2y) = 0, rises and is convex, and its root lies between 0 (sides
/// at rest) and -ln(s)/2 (volume at rest). Newton's method from the right end comes down on the
/// root and passes it only by round-off.
double lateral(double log_stretch, double g, double lambda) {
  double y = std::max(0.0, -0.5 * log_stretch);
  while (true) {
    const double excess = g * std::expm1(2.0 * y) + lambda * (log_stretch + 2.0 * y);
    const double next = y - 0.5 * excess / (g * std::exp(2.0 * y) + lambda);
    if (!(next < y)) return y;
    y = next;
  }
}

struct Stress {
  double value = 0.0, by_shear = 0.0, by_lambda = 0.0;
};

Stress uniaxial(double stretch, double g, double lambda) {
  const double x = std::log(stretch), y = lateral(x, g, lambda);
  const double squared = std::exp(2.0 * y);  // t²
  // ln J twice: as it stands, or by the condition, where the sum would cancel.
  const double log_j = lambda > g ? -g * std::expm1(2.0 * y) / lambda : x + 2.0 * y;
  const double slope = 2.0 * (g * squared + lambda);
  const double y_by_shear = -std::expm1(2.0 * y) / slope, y_by_lambda = -log_j / slope;
  const double difference = squared * std::expm1(2.0 * (x - y)) / stretch;  // s - t²/s
  const double by_y = -2.0 * g * squared / stretch;
  return {g * difference, difference + by_y * y_by_shear, by_y * y_by_lambda};
}

}  // namespace

LawParameters::LawParameters(std::vector<MaterialParameter> parameters,
                             const meshes::Rubber& rubber)
    : parameters_(std::move(parameters)), rubber_(rubber) {
  check(parameters_, rubber_);
}

LawParameters::Values LawParameters::at(const Eigen::VectorXd& parameters) const {
  meshes::Rubber rubber = rubber_;
  Values values{rubber.shear_modulus, rubber.lame_lambda(),
                Eigen::MatrixXd::Zero(2, Index(parameters_.size()))};
  const bool by_moduli = std::ranges::any_of(parameters_, is_modulus);
  for (Index i = 0; i < values.chain.cols(); ++i) {
    const MaterialParameter parameter = parameters_[std::size_t(i)];
    if (parameter == lame_shear) values.shear = parameters(i);
    if (parameter == lambda) values.lambda = parameters(i);
    values.chain(parameter == lame_shear ? 0 : 1, i) = 1.0;
  }
  if (by_moduli) {
    rubber = with_moduli(rubber, parameters_, parameters);
    const auto broken = rubber.violations();
    if (!broken.empty()) throw InvalidInput(broken);
    values.shear = rubber.shear_modulus;
    values.lambda = rubber.lame_lambda();
    const auto slopes = lambda_slopes(rubber.youngs_modulus, rubber.shear_modulus);
    for (Index i = 0; i < values.chain.cols(); ++i) {
      const Eigen::Vector2d moduli =
          moduli_slopes(parameters_[std::size_t(i)], rubber.poissons_ratio());
      values.chain.col(i) << moduli(1), slopes.dot(moduli);
    }
  }
  if (!std::isfinite(values.shear) || values.shear <= 0.0)
    throw InvalidInput({"rubber.shear_modulus", to_text(values.shear) + " Pa",
                        "G must be finite and positive", "give the shear modulus"});
  if (!std::isfinite(values.lambda) || values.lambda < 0.0)
    throw InvalidInput({"rubber.lambda", to_text(values.lambda) + " Pa",
                        "law A needs lambda >= 0, that is nu >= 0: below, its energy falls without "
                        "bound as the volume goes to zero",
                        "raise youngs_modulus to 2 G or more"});
  return values;
}

UniaxialModel::UniaxialModel(std::vector<double> stretches,
                             std::vector<MaterialParameter> parameters,
                             const meshes::Rubber& rubber)
    : stretches_(std::move(stretches)), law_(std::move(parameters), rubber) {
  for (const double stretch : stretches_)
    if (!(stretch >= min_stretch && stretch <= largest_stretch))
      throw InvalidInput({"stretch", to_text(stretch), "a stretch lies between 0.01 and 100",
                          "give length over length at rest, 1 for the bar at rest"});
}

CurveSlopes UniaxialModel::evaluate(const Eigen::VectorXd& parameters) {
  const auto law = law_.at(parameters);
  const Index count = Index(stretches_.size());
  CurveSlopes result{Eigen::VectorXd(count), Eigen::MatrixXd(count, law.chain.cols())};
  for (Index i = 0; i < count; ++i) {
    const Stress stress = uniaxial(stretches_[std::size_t(i)], law.shear, law.lambda);
    result.value(i) = stress.value;
    result.jacobian.row(i) = Eigen::RowVector2d(stress.by_shear, stress.by_lambda) * law.chain;
  }
  return result;
}

SimpleShearModel::SimpleShearModel(std::vector<double> shears,
                                   std::vector<MaterialParameter> parameters,
                                   const meshes::Rubber& rubber)
    : shears_(Eigen::VectorXd::Map(shears.data(), Index(shears.size()))),
      law_(std::move(parameters), rubber) {
  for (const double shear : shears)
    if (!std::isfinite(shear))
      throw InvalidInput(
          {"shear", to_text(shear), "a shear must be finite", "give displacement over height"});
}

CurveSlopes SimpleShearModel::evaluate(const Eigen::VectorXd& parameters) {
  const auto law = law_.at(parameters);
  return {law.shear * shears_, shears_ * law.chain.row(0)};
}

}  // namespace fingertip::calibration::inline press_fit
