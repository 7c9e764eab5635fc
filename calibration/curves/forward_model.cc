#include "calibration/curves/forward_model.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "lattice/press/static_press.h"
#include "meshes/errors.h"
#include "meshes/press_response.h"

namespace fingertip::calibration {

using lattice::ModelKind;
using lattice::PressParameter;
using lattice::PressSetup;

namespace {

/// The parameter of a press that is the same thing; none for E and G.
std::optional<PressParameter> press_parameter(MaterialParameter parameter) {
  switch (parameter) {
    case MaterialParameter::youngs_modulus:
    case MaterialParameter::shear_modulus:
    case MaterialParameter::modulus: return std::nullopt;
    case MaterialParameter::k1: return PressParameter::k1;
    case MaterialParameter::k2: return PressParameter::k2;
    case MaterialParameter::k3: return PressParameter::k3;
    case MaterialParameter::kappa: return PressParameter::kappa;
    case MaterialParameter::lame_shear: return PressParameter::shear_modulus;
    case MaterialParameter::lambda: return PressParameter::lambda;
    case MaterialParameter::bond: return PressParameter::bond;
    case MaterialParameter::contact: return PressParameter::contact;
    default: return std::nullopt;
  }
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
  if (setup.protocol.slides_after())
    found.push_back({"press.lateral_path", std::string(name(setup.protocol.lateral_path)),
                     "forces are fitted against indentation", "choose diagonal"});
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

/// To so many decimals two Poisson's ratios are one: what E/(2G) - 1 makes of round-off.
constexpr double ratio_steps = 1e13;

}  // namespace

bool is_modulus(MaterialParameter parameter) {
  return parameter == MaterialParameter::youngs_modulus ||
         parameter == MaterialParameter::shear_modulus || parameter == MaterialParameter::modulus;
}

bool is_of_the_rig(MaterialParameter parameter) {
  return std::ranges::find(rig_parameters, parameter) != rig_parameters.end();
}

bool is_of_the_relaxation(MaterialParameter parameter) {
  return std::ranges::find(relaxation_parameters, parameter) != relaxation_parameters.end();
}

bool is_behind_the_press(MaterialParameter parameter) {
  return is_of_the_rig(parameter) || is_of_the_relaxation(parameter);
}

bool is_of_the_rubber(MaterialParameter parameter) {
  return is_modulus(parameter) || parameter == MaterialParameter::lame_shear ||
         parameter == MaterialParameter::lambda;
}

meshes::Rubber with_moduli(meshes::Rubber rubber, const std::vector<MaterialParameter>& parameters,
                           const Eigen::VectorXd& values) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const double value = values(Eigen::Index(i));
    switch (parameters[i]) {
      case MaterialParameter::youngs_modulus: rubber.youngs_modulus = value; break;
      case MaterialParameter::shear_modulus: rubber.shear_modulus = value; break;
      case MaterialParameter::modulus:
        rubber.shear_modulus *= value / rubber.youngs_modulus;
        rubber.youngs_modulus = value;
        break;
      case MaterialParameter::lame_shear: rubber.set_lame(value, rubber.lame_lambda()); break;
      case MaterialParameter::lambda: rubber.set_lame(rubber.shear_modulus, value); break;
      default: break;
    }
  }
  return rubber;
}

Eigen::Vector2d moduli_slopes(MaterialParameter parameter, double poissons_ratio) {
  const double nu = poissons_ratio;
  switch (parameter) {
    case MaterialParameter::youngs_modulus: return {1.0, 0.0};
    case MaterialParameter::shear_modulus: return {0.0, 1.0};
    // E = G (3 lambda + 2G)/(lambda + G) and lambda = 2 G nu/(1 - 2 nu).
    case MaterialParameter::lame_shear: return {2.0 + 4.0 * nu * nu, 1.0};
    case MaterialParameter::lambda: return {(1.0 - 2.0 * nu) * (1.0 - 2.0 * nu), 0.0};
    default: return {1.0, 0.5 / (1.0 + nu)};
  }
}

std::string_view name(MaterialParameter parameter) {
  switch (parameter) {
    case MaterialParameter::youngs_modulus: return "youngs_modulus";
    case MaterialParameter::shear_modulus: return "shear_modulus";
    case MaterialParameter::modulus: return "modulus";
    case MaterialParameter::k1: return "k1";
    case MaterialParameter::k2: return "k2";
    case MaterialParameter::k3: return "k3";
    case MaterialParameter::kappa: return "kappa";
    case MaterialParameter::lame_shear: return "lame_shear";
    case MaterialParameter::lambda: return "lambda";
    case MaterialParameter::bond: return "bond";
    case MaterialParameter::contact: return "contact";
    case MaterialParameter::retardation_time: return "retardation_time";
    case MaterialParameter::yeoh_c1: return "yeoh_c1";
    case MaterialParameter::yeoh_c2: return "yeoh_c2";
    case MaterialParameter::yeoh_c3: return "yeoh_c3";
    case MaterialParameter::mooney_c10: return "mooney_c10";
    case MaterialParameter::mooney_c01: return "mooney_c01";
    case MaterialParameter::ogden_mu1: return "ogden_mu1";
    case MaterialParameter::ogden_alpha1: return "ogden_alpha1";
    case MaterialParameter::ogden_mu2: return "ogden_mu2";
    case MaterialParameter::ogden_alpha2: return "ogden_alpha2";
    case MaterialParameter::ogden_mu3: return "ogden_mu3";
    case MaterialParameter::ogden_alpha3: return "ogden_alpha3";
    case MaterialParameter::gent_jm: return "gent_jm";
    case MaterialParameter::bulk_modulus: return "bulk_modulus";
    case MaterialParameter::relaxation_g1: return "relaxation_g1";
    case MaterialParameter::relaxation_tau1: return "relaxation_tau1";
    case MaterialParameter::relaxation_g2: return "relaxation_g2";
    case MaterialParameter::relaxation_tau2: return "relaxation_tau2";
    case MaterialParameter::relaxation_g3: return "relaxation_g3";
    case MaterialParameter::relaxation_tau3: return "relaxation_tau3";
    case MaterialParameter::relaxation_g4: return "relaxation_g4";
    case MaterialParameter::relaxation_tau4: return "relaxation_tau4";
    case MaterialParameter::relaxation_g5: return "relaxation_g5";
    case MaterialParameter::relaxation_tau5: return "relaxation_tau5";
    case MaterialParameter::touch_offset: return "touch_offset";
    case MaterialParameter::compliance: return "compliance";
    case MaterialParameter::force_offset: return "force_offset";
    case MaterialParameter::drift: return "drift";
  }
  return "unknown";
}

std::string_view unit(MaterialParameter parameter) {
  switch (parameter) {
    case MaterialParameter::k1:
    case MaterialParameter::k2:
    case MaterialParameter::k3: return "N/m";
    case MaterialParameter::bond:
    case MaterialParameter::contact:
    case MaterialParameter::ogden_alpha1:
    case MaterialParameter::ogden_alpha2:
    case MaterialParameter::ogden_alpha3:
    case MaterialParameter::gent_jm:
    case MaterialParameter::relaxation_g1:
    case MaterialParameter::relaxation_g2:
    case MaterialParameter::relaxation_g3:
    case MaterialParameter::relaxation_g4:
    case MaterialParameter::relaxation_g5: return "1";
    case MaterialParameter::retardation_time:
    case MaterialParameter::relaxation_tau1:
    case MaterialParameter::relaxation_tau2:
    case MaterialParameter::relaxation_tau3:
    case MaterialParameter::relaxation_tau4:
    case MaterialParameter::relaxation_tau5: return "s";
    case MaterialParameter::touch_offset: return "m";
    case MaterialParameter::compliance: return "m/N";
    case MaterialParameter::force_offset: return "N";
    case MaterialParameter::drift: return "N/s";
    default: return "Pa";
  }
}

double value_of(MaterialParameter parameter, const PressSetup& setup) {
  const lattice::SpringConstants& constants = setup.lattice.constants;
  switch (parameter) {
    case MaterialParameter::youngs_modulus:
    case MaterialParameter::modulus: return setup.rubber.youngs_modulus;
    case MaterialParameter::shear_modulus:
    case MaterialParameter::lame_shear: return setup.rubber.shear_modulus;
    case MaterialParameter::lambda: return setup.rubber.lame_lambda();
    case MaterialParameter::k1: return constants.k1;
    case MaterialParameter::k2: return constants.k2;
    case MaterialParameter::k3: return constants.k3;
    case MaterialParameter::kappa: return constants.kappa;
    case MaterialParameter::bond: return setup.lattice.ligament_stiffness;
    case MaterialParameter::contact: return setup.lattice.contact_stiffness;
    case MaterialParameter::retardation_time: return setup.rubber.retardation_time;
    default: return meshes::unknown;
  }
}

Eigen::RowVector2d lambda_slopes(double e, double g) {
  const double denominator = (3.0 * g - e) * (3.0 * g - e);
  return Eigen::RowVector2d(g * g, 4.0 * e * g - e * e - 6.0 * g * g) / denominator;
}

LatticeForwardModel::LatticeForwardModel(PressSetup setup,
                                         std::vector<MaterialParameter> parameters,
                                         std::function<bool()> go_on)
    : setup_(std::move(setup)), parameters_(std::move(parameters)), go_on_(std::move(go_on)) {
  check(setup_, parameters_);
  if (by_moduli()) {
    using enum PressParameter;
    press_parameters_ = setup_.lattice.model == ModelKind::network
                            ? std::vector{shear_modulus, lambda}
                            : std::vector{k1, k2, kappa};
  }
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
  const double a = setup.lattice.spacing;
  const Eigen::RowVector2d lambda =
      lambda_slopes(setup.rubber.youngs_modulus, setup.rubber.shear_modulus);
  for (Eigen::Index j = 0; j < chain.cols(); ++j) {
    const MaterialParameter parameter = parameters_[std::size_t(j)];
    if (const auto same = press_parameter(parameter)) {
      const auto row = std::ranges::find(press_parameters_, *same) - press_parameters_.begin();
      chain(row, j) = 1.0;
      continue;
    }
    const Eigen::Vector2d moduli = moduli_slopes(parameter, setup.rubber.poissons_ratio());
    const double of_shear = moduli(1), of_lambda = lambda.dot(moduli);
    if (setup.lattice.model == ModelKind::network)
      chain.col(j).head<2>() << of_shear, of_lambda;
    else
      chain.col(j).head<3>() << a * of_shear, a * of_shear, of_lambda - of_shear;
  }
  return chain;
}

CurveSlopes LatticeForwardModel::press(const PressSetup& setup) const {
  lattice::StaticObserver observer;
  if (go_on_) observer = [this](const lattice::StaticOutcome&, double) { return go_on_(); };
  const auto press = lattice::run_static_press_with_slopes(setup, press_parameters_, observer);
  const auto& samples = press.outcome.response.samples();
  CurveSlopes result;
  result.value.resize(Eigen::Index(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i)
    result.value(Eigen::Index(i)) = samples[i].normal_force;
  result.jacobian = press.slopes.normal_force * chain(setup);
  return result;
}

const CurveSlopes& LatticeForwardModel::at_ratio(double poissons_ratio) {
  const auto known = by_ratio_.find(poissons_ratio);
  if (known != by_ratio_.end()) return known->second;
  PressSetup setup = setup_;
  setup.rubber.youngs_modulus = 2.0 * setup.rubber.shear_modulus * (1.0 + poissons_ratio);
  if (setup.lattice.model == ModelKind::hookean)
    setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  return by_ratio_[poissons_ratio] = press(setup);
}

CurveSlopes LatticeForwardModel::evaluate(const Eigen::VectorXd& parameters) {
  const PressSetup setup = setup_with(parameters);
  if (!std::ranges::all_of(parameters_, is_modulus)) return press(setup);
  const double ratio = std::round(setup.rubber.poissons_ratio() * ratio_steps) / ratio_steps;
  CurveSlopes result = at_ratio(ratio);
  result.value *= setup.rubber.shear_modulus / setup_.rubber.shear_modulus;
  return result;
}

}  // namespace fingertip::calibration
