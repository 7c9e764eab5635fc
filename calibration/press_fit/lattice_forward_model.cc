#include "calibration/press_fit/lattice_forward_model.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "lattice/model/constants.h"
#include "lattice/press/static_press.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "meshes/press/press_response.h"

namespace fingertip::calibration::inline press_fit {

using lattice::ModelKind;
using lattice::PressParameter;
using lattice::PressSetup;

namespace {

/// The parameter of a press that is the same thing; none for E and G.
std::optional<PressParameter> press_parameter(MaterialParameter parameter) {
  using M = MaterialParameter;
  using P = PressParameter;
  static constexpr std::pair<M, P> same[] = {{M::k1, P::k1},
                                             {M::k2, P::k2},
                                             {M::k3, P::k3},
                                             {M::kappa, P::kappa},
                                             {M::lame_shear, P::shear_modulus},
                                             {M::lambda, P::lambda},
                                             {M::bond, P::bond},
                                             {M::contact, P::contact}};
  const auto found = std::ranges::find(same, parameter, &std::pair<M, P>::first);
  return found == std::end(same) ? std::nullopt : std::optional(found->second);
}

bool is_tie(MaterialParameter parameter) {
  return parameter == MaterialParameter::bond || parameter == MaterialParameter::contact;
}

bool model_has(const lattice::LatticeSettings& settings, MaterialParameter parameter) {
  if (is_modulus(parameter))
    return settings.model == ModelKind::hookean || settings.model == ModelKind::network;
  const auto known = lattice::press_parameters(settings);
  const auto same = press_parameter(parameter);
  return same && std::ranges::find(known, *same) != known.end();
}

void check(const PressSetup& setup, const std::vector<MaterialParameter>& parameters) {
  std::vector<meshes::Violation> found;
  if (parameters.empty())
    found.push_back({"parameters", "none", "a fit needs a free parameter", "name at least one"});
  if (setup.protocol.moves_after())
    found.push_back({setup.protocol.has_twist() ? "press.twist" : "press.lateral_path",
                     setup.protocol.has_twist() ? meshes::to_text(setup.protocol.twist) + " rad"
                                                : std::string(name(setup.protocol.lateral_path)),
                     "forces are fitted against indentation",
                     "choose press.lateral_path = diagonal and no twist"});
  if (setup.protocol.contact == meshes::ContactMode::coulomb &&
      setup.protocol.mode == meshes::DriveMode::equilibrium)
    found.push_back({"press.contact", "coulomb",
                     "slopes of a static press are known where it sticks or is free of friction",
                     "choose stick or frictionless"});
  if (!setup.protocol.program.empty())
    found.push_back({"press.program", "given",
                     "forces are fitted against the indentation of one press", "leave it out"});
  for (auto it = parameters.begin(); it != parameters.end(); ++it) {
    if (!model_has(setup.lattice, *it))
      found.push_back({"parameters", std::string(name(*it)),
                       "the " + std::string(lattice::name(setup.lattice.model)) +
                           " model does not depend on it, or not by a closed form",
                       "hookean and network know E and G; others see press_parameters"});
    if (std::find(parameters.begin(), it, *it) != it)
      found.push_back({"parameters", std::string(name(*it)), "a parameter is named once",
                       "remove the second one"});
  }
  const auto constant = [](MaterialParameter p) { return !is_modulus(p) && !is_tie(p); };
  if (std::ranges::any_of(parameters, is_modulus) && std::ranges::any_of(parameters, constant))
    found.push_back(
        {"parameters", "a modulus beside a constant of the lattice",
         "the rubber is described in one way: by E and G, or by the lattice's constants",
         "choose one of them"});
  if (std::ranges::find(parameters, MaterialParameter::modulus) != parameters.end() &&
      std::ranges::count_if(parameters, is_modulus) > 1)
    found.push_back({"parameters", "modulus beside E or G",
                     "modulus is E at held Poisson's ratio, which E and G change",
                     "free modulus alone, or E and G"});
  if (!found.empty()) throw meshes::InvalidInput(found);
}

/// Forces at the samples and their slopes in these directions.
CurveSlopes pressed(const PressSetup& setup, const lattice::PressDirections& directions,
                    const std::function<bool()>& go_on) {
  lattice::StaticObserver observer;
  if (go_on) observer = [&](const lattice::StaticOutcome&, double) { return go_on(); };
  const auto press = lattice::run_static_press_with_slopes(setup, directions, observer);
  const auto& samples = press.outcome.response.samples();
  CurveSlopes result;
  result.value.resize(Eigen::Index(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    result.value(Eigen::Index(i)) = samples[i].normal_force;
  result.jacobian = press.slopes.normal_force;
  return result;
}

}  // namespace

double value_of(MaterialParameter parameter, const PressSetup& setup) {
  if (const auto same = press_parameter(parameter)) return lattice::value_of(*same, setup);
  switch (parameter) {
    case MaterialParameter::youngs_modulus:
    case MaterialParameter::modulus: return setup.rubber.youngs_modulus;
    case MaterialParameter::shear_modulus: return setup.rubber.shear_modulus;
    case MaterialParameter::retardation_time: return setup.rubber.retardation_time;
    default: return meshes::unknown;
  }
}

LatticeForwardModel::LatticeForwardModel(PressSetup setup,
                                         std::vector<MaterialParameter> parameters,
                                         std::function<bool()> go_on)
    : setup_(std::move(setup)), parameters_(std::move(parameters)), go_on_(std::move(go_on)) {
  check(setup_, parameters_);
  if (by_moduli()) press_parameters_ = lattice::lame_directions(setup_.lattice).parameters;
  for (const MaterialParameter parameter : parameters_)
    if (const auto same = press_parameter(parameter)) press_parameters_.push_back(*same);
}

bool LatticeForwardModel::by_moduli() const {
  return std::ranges::any_of(parameters_, is_modulus);
}

PressSetup LatticeForwardModel::setup_with(const Eigen::VectorXd& parameters) const {
  PressSetup setup = setup_;
  if (by_moduli()) setup.rubber = with_moduli(setup.rubber, parameters_, parameters);
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    if (const auto same = press_parameter(parameters_[i]))
      set_value(*same, parameters(Eigen::Index(i)), setup);
  // The closed form divides by 3G - E.
  const auto broken = setup.rubber.violations();
  if (!broken.empty()) throw meshes::InvalidInput(broken);
  if (by_moduli() && setup.lattice.model == ModelKind::hookean)
    setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  return setup;
}

Eigen::MatrixXd LatticeForwardModel::chain(const PressSetup& setup) const {
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(Eigen::Index(press_parameters_.size()),
                                                Eigen::Index(parameters_.size()));
  const Eigen::MatrixXd by_lame = lattice::lame_directions(setup.lattice).rates;
  const Eigen::RowVector2d lambda = setup.rubber.lambda_slopes();
  for (Eigen::Index j = 0; j < chain.cols(); ++j) {
    const MaterialParameter parameter = parameters_[std::size_t(j)];
    if (const auto same = press_parameter(parameter)) {
      const auto row = std::ranges::find(press_parameters_, *same) - press_parameters_.begin();
      chain(row, j) = 1.0;
      continue;
    }
    const Eigen::Vector2d moduli = moduli_slopes(parameter, setup.rubber.poissons_ratio());
    chain.col(j).head(by_lame.rows()) = by_lame * Eigen::Vector2d(moduli(1), lambda.dot(moduli));
  }
  return chain;
}

CurveSlopes LatticeForwardModel::evaluate(const Eigen::VectorXd& parameters) {
  const PressSetup setup = setup_with(parameters);
  return pressed(setup, {press_parameters_, chain(setup)}, go_on_);
}

CurveSlopes LatticeByRatio::evaluate(const Eigen::VectorXd& poissons_ratio) {
  PressSetup setup = setup_;
  const double g = setup.rubber.shear_modulus;
  setup.rubber.youngs_modulus = 2.0 * g * (1.0 + poissons_ratio(0));
  if (setup.lattice.model == ModelKind::hookean)
    setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  CurveSlopes result = pressed(setup, {}, go_on_);
  result.value /= g;
  result.jacobian.resize(result.value.size(), 0);
  return result;
}

}  // namespace fingertip::calibration::inline press_fit
