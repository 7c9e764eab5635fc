#include "studies/run/fit_setup.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>

#include "calibration/curves/forward_model.h"
#include "meshes/files.h"
#include "studies/run/curve_file.h"
#include "studies/run/curve_text.h"
#include "studies/run/digest.h"
#include "studies/run/press_setup.h"
#include "studies/run/provenance.h"

namespace fingertip::studies {

using calibration::Curve;
using calibration::FreeParameter;
using calibration::MaterialParameter;
using lattice::ModelKind;

namespace {

/// Ties are known less well than constants by so much.
constexpr double ties_prior = 10.0;

/// A thousandth of a standard error is close enough for a model that takes seconds to answer.
constexpr double search_tolerance = 1e-3;

/// "press.contact = stick; press.tilt=20 deg" as --set texts.
std::vector<std::string> settings_in(std::string_view condition) {
  std::vector<std::string> sets;
  std::size_t begin = 0;
  while (begin <= condition.size()) {
    const std::size_t end = std::min(condition.find(';', begin), condition.size());
    const std::string_view one = trimmed(condition.substr(begin, end - begin));
    const auto equals = one.find('=');
    if (equals != one.npos)
      sets.push_back(std::string(trimmed(one.substr(0, equals))) + "=" +
                     std::string(trimmed(one.substr(equals + 1))));
    else if (!one.empty())
      sets.emplace_back(one);
    begin = end + 1;
  }
  return sets;
}

ConfigError refused(const LoadedConfig& loaded, const std::string& key, const std::string& value,
                    const std::string& rule, const std::string& remedy) {
  return loaded.locate({{key, value, rule, remedy}});
}

std::string words_of(const std::vector<MaterialParameter>& parameters) {
  std::string text;
  for (const MaterialParameter one : parameters)
    text += (text.empty() ? "" : ", ") + std::string(calibration::name(one));
  return text;
}

using enum MaterialParameter;

/// What may be free in a problem, the usual ones first.
std::vector<MaterialParameter> known_parameters(const CalibrationOrder& order) {
  switch (order.problem) {
    case CalibrationProblem::damping: return {retardation_time};
    case CalibrationProblem::finite_strain:
      return {youngs_modulus, shear_modulus, lame_shear, lambda};
    default:
      return {youngs_modulus, shear_modulus, k1, k2, k3, kappa, lame_shear, lambda, bond, contact};
  }
}

std::vector<MaterialParameter> usual_parameters(const CalibrationOrder& order, ModelKind model) {
  switch (order.problem) {
    case CalibrationProblem::damping: return {retardation_time};
    case CalibrationProblem::curve:
      if (model == ModelKind::network) return {lame_shear, lambda, bond, contact};
      // Forces see k1, k2, k3 through two combinations alone: k3 stays what the moduli made it.
      if (model == ModelKind::central) return {k1, k2, bond, contact};
      return {k1, k2, kappa, bond, contact};
    default: return {youngs_modulus, shear_modulus};
  }
}

std::vector<MaterialParameter> free_parameters(const LoadedConfig& loaded) {
  const CalibrationOrder& order = loaded.config.calibration;
  if (order.parameters.empty()) return usual_parameters(order, loaded.config.press.lattice.model);
  const std::vector<MaterialParameter> known = known_parameters(order);
  std::vector<MaterialParameter> chosen;
  for (const std::string& word : order.parameters) {
    const auto found = std::ranges::find(known, word, calibration::name);
    if (found == known.end())
      throw refused(
          loaded, "calibration.parameters", word,
          "the problem " + std::string(name(order.problem)) + " can free " + words_of(known),
          "name some of them, or none for the usual ones");
    chosen.push_back(*found);
  }
  return chosen;
}

double scale_of(MaterialParameter parameter, const lattice::PressSetup& base) {
  const double g = base.rubber.shear_modulus;
  switch (parameter) {
    case k1:
    case k2:
    case k3: return base.lattice.spacing * g;
    case kappa:
    case lambda: return std::max(std::abs(calibration::value_of(parameter, base)), g);
    default: return 0.0;  // its start
  }
}

std::vector<FreeParameter> free_list(const LoadedConfig& loaded, const lattice::PressSetup& base) {
  const CalibrationOrder& order = loaded.config.calibration;
  // A measurement speaks for itself unless its owner says what is known besides.
  const bool with_priors = order.prior > 0.0 && (order.problem == CalibrationProblem::curve ||
                                                 loaded.entries.at("calibration.prior").given);
  std::vector<FreeParameter> list;
  for (const MaterialParameter parameter : free_parameters(loaded)) {
    FreeParameter free;
    free.parameter = parameter;
    free.start = calibration::value_of(parameter, base);
    free.scale = scale_of(parameter, base);
    const double size = free.scale > 0.0 ? free.scale : std::abs(free.start);
    const double weight = parameter == bond || parameter == contact ? ties_prior : 1.0;
    // The energy of law A falls without bound for lambda < 0.
    if (parameter == lambda && base.lattice.kinematics == lattice::Kinematics::finite)
      free.lower = 0.0;
    if (with_priors) free.prior = calibration::Prior{free.start, weight * order.prior * size};
    if (parameter == retardation_time) free.start = 0.7 * std::max(free.start, 1e-4);
    list.push_back(free);
  }
  return list;
}

/// Samples 1/n, 2/n ... 1 of the depth.
std::string even_samples(double depth, int count) {
  std::string list;
  for (int i = 1; i <= count; ++i)
    list += (i > 1 ? ", \"" : "\"") + meshes::to_text(depth * i / count) + " m\"";
  return "press.samples=[" + list + "]";
}

/// A condition says how a press is done: what it is done with is common to all curves.
void check_condition(const LoadedConfig& loaded, const std::vector<std::string>& sets) {
  for (const std::string& one : sets) {
    const std::string section = one.substr(0, one.find('.'));
    if (section != "press" && section != "geometry" && section != "reference")
      throw refused(loaded, "calibration.conditions", one,
                    "a curve's condition sets keys of press, geometry and reference",
                    "set rubber, lattice and calibration for the whole fit");
  }
}

/// The press of one curve: the configuration, the condition's settings, then what the problem asks.
LoadedConfig under(const LoadedConfig& loaded, const std::vector<std::string>& condition,
                   const std::vector<std::string>& derived) {
  check_condition(loaded, condition);
  std::vector<std::string> sets = condition;
  sets.insert(sets.end(), derived.begin(), derived.end());
  return loaded.with(sets);
}

std::vector<std::string> conditions_of(const LoadedConfig& loaded) {
  const std::vector<std::string>& given = loaded.config.calibration.conditions;
  return given.empty() ? std::vector<std::string>{""} : given;
}

std::string described(const lattice::PressSetup& setup) {
  std::string text(meshes::name(setup.protocol.contact));
  if (setup.protocol.tilt != 0.0)
    text += ", tilt " +
            meshes::to_text(std::round(setup.protocol.tilt * 1.8e6 / std::numbers::pi) / 1e4) +
            " deg";
  if (setup.protocol.lateral != 0.0)
    text += ", lateral " + meshes::to_text(1e2 * setup.protocol.lateral) + " cm";
  return text;
}

/// Two files of one stem, or two fingers under one contact.
void name_once(const std::vector<Curve>& others, Curve& curve) {
  const std::string name = curve.name;
  for (int copy = 2; std::ranges::find(others, curve.name, &Curve::name) != others.end(); ++copy)
    curve.name = name + " (" + std::to_string(copy) + ")";
}

void add_press(FitSetup& fit, const LoadedConfig& own, CurveKind kind, Curve curve) {
  const lattice::PressSetup press = press_setup(own);
  fit.order.conditions.push_back(described(press));
  if (curve.name.empty()) curve.name = fit.order.conditions.back();
  name_once(fit.order.curves, curve);
  fit.order.curves.push_back(std::move(curve));
  fit.order.kinds.push_back(kind);
  fit.order.presses.push_back(press);
  fit.continua.push_back(continuum_beside(own, press.lattice.kinematics));
}

/// The start of a driven rod shakes the tip; this long a way dies the shaking out before touch.
constexpr double run_up = 0.1;  // [s]

/// A moving lattice beside the transient continuum. Its step is that of the largest retardation
/// time a fit may try, twice the configuration's.
void add_moving_press(FitSetup& fit, const LoadedConfig& own, Curve curve) {
  add_press(fit, own, CurveKind::moving_press, std::move(curve));
  lattice::PressSetup& press = fit.order.presses.back();
  press.protocol.clearance = run_up * press.protocol.speed;
  press.rubber.retardation_time *= 2.0;
  fit.continua.back().analysis = fem_reference::Analysis::transient;
  fit.continua.back().strain = fem_reference::Strain::linear;
}

void add_continuum_curves(FitSetup& fit, const LoadedConfig& loaded) {
  const CalibrationOrder& order = loaded.config.calibration;
  fit.data_from_continuum = true;
  fit.order.provenance = "forces of the continuum reference";
  fit.order.rubber_known = true;
  const bool moving = order.problem == CalibrationProblem::damping;
  for (const std::string& condition : conditions_of(loaded)) {
    const LoadedConfig own = under(loaded, settings_in(condition),
                                   {moving ? "press.mode=quasi-static" : "press.mode=static",
                                    even_samples(order.depth, order.points)});
    Curve curve;
    curve.x = own.config.press.protocol.samples;
    if (moving) {
      add_moving_press(fit, own, curve);
    } else {
      add_press(fit, own, CurveKind::press, curve);
    }
  }
}

std::vector<CurveQuantities> quantities_of(CalibrationProblem problem) {
  switch (problem) {
    case CalibrationProblem::finite_strain: return {measured::uniaxial, measured::simple_shear};
    case CalibrationProblem::damping:
      return {measured::vibration, measured::creep, measured::relaxation};
    default: return {measured::press};
  }
}

CurveKind kind_of(const MeasuredFile& file, const CalibrationOrder& order) {
  if (file.x_quantity == "stretch") return CurveKind::uniaxial;
  if (file.x_quantity == "shear") return CurveKind::simple_shear;
  if (file.x_quantity == "frequency") return CurveKind::loss_factor;
  if (file.y_quantity == "creep") return CurveKind::creep;
  if (file.x_quantity == "time") return CurveKind::ramp;
  return order.forward == ForwardKind::continuum ? CurveKind::table : CurveKind::press;
}

void add_measured_press(FitSetup& fit, const LoadedConfig& loaded, const MeasuredFile& file,
                        CurveKind kind, const std::vector<std::string>& further) {
  std::vector<std::string> condition;
  for (const MeasuredSetting& setting : file.settings) condition.push_back(setting.assignment());
  condition.insert(condition.end(), further.begin(), further.end());
  std::string samples;
  for (const double depth : file.curve.x)
    samples += (samples.empty() ? "\"" : ", \"") + meshes::to_text(depth) + " m\"";
  const bool ramp = kind == CurveKind::ramp;
  const LoadedConfig own =
      ramp ? under(loaded, condition, {"press.mode=static"})
           : under(loaded, condition, {"press.mode=static", "press.samples=[" + samples + "]"});
  add_press(fit, own, kind, file.curve);
}

std::string with_unit(const std::string& quantity) {
  for (const CurveQuantities& pair : {measured::press, measured::uniaxial, measured::simple_shear,
                                      measured::vibration, measured::creep, measured::relaxation})
    for (const Quantity& one : {pair.x, pair.y})
      if (one.name == quantity) return quantity + " [" + std::string(one.unit) + "]";
  return quantity;
}

std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void add_measured_curves(FitSetup& fit, const LoadedConfig& loaded) {
  const CalibrationOrder& order = loaded.config.calibration;
  if (order.data.empty())
    throw refused(loaded, "calibration.data", "[]",
                  "the problem " + std::string(name(order.problem)) + " needs measured data",
                  "name one CSV file per curve");
  if (!order.conditions.empty() && order.conditions.size() != order.data.size())
    throw refused(loaded, "calibration.conditions", "",
                  "there must be one per file of calibration.data, or none", "complete the list");
  fit.order.provenance = "measured data: ";
  for (std::size_t i = 0; i < order.data.size(); ++i) {
    MeasuredFile file = read_measured(order.data[i], quantities_of(order.problem));
    const CurveKind kind = kind_of(file, order);
    const bool press =
        kind == CurveKind::press || kind == CurveKind::table || kind == CurveKind::ramp;
    if (i > 0 && press == fit.order.presses.empty())
      throw refused(loaded, "calibration.data", order.data[i].string(),
                    "forces of presses and other tests do not go into one fit",
                    "fit them one by one");
    file.curve.x_quantity = with_unit(file.x_quantity);
    file.curve.y_quantity = with_unit(file.y_quantity);
    fit.notes.insert(fit.notes.end(), file.notes.begin(), file.notes.end());
    fit.order.provenance += (i > 0 ? ", " : "") + order.data[i].filename().string() + " (SHA-256 " +
                            sha256(content_of(order.data[i])) + ")";
    if (press) {
      const auto condition =
          order.conditions.empty() ? std::vector<std::string>{} : settings_in(order.conditions[i]);
      add_measured_press(fit, loaded, file, kind, condition);
      continue;
    }
    if (!order.conditions.empty())
      throw refused(loaded, "calibration.conditions", "",
                    "conditions are those of presses; a test on a coupon has none",
                    "leave them out");
    name_once(fit.order.curves, file.curve);
    fit.order.curves.push_back(file.curve);
    fit.order.conditions.push_back("");
    fit.order.kinds.push_back(kind);
  }
}

/// E and G enter together: whatever is fitted, a second rubber may look alike (calibration/README).
std::vector<double> further_starts(const FitOrder& order, const CalibrationOrder& wanted) {
  const auto frees = [&](MaterialParameter parameter) {
    return std::ranges::find(order.options.free, parameter, &FreeParameter::parameter) !=
           order.options.free.end();
  };
  std::vector<double> ratios;
  if (wanted.problem != CalibrationProblem::experiment || !frees(youngs_modulus) ||
      !frees(shear_modulus))
    return ratios;
  for (const double ratio : {0.45, 0.3, 0.1})
    if (ratio > wanted.poisson_range[0] && ratio < wanted.poisson_range[1]) ratios.push_back(ratio);
  return ratios;
}

void check_profile(const LoadedConfig& loaded, const FitOrder& order) {
  const auto known = [&](const std::string& word) {
    return std::ranges::any_of(order.options.free, [&](const FreeParameter& free) {
      return calibration::name(free.parameter) == word;
    });
  };
  const std::vector<std::string>& two = order.profile;
  if (two.empty()) return;
  if (two.size() != 2 || two[0] == two[1] || !known(two[0]) || !known(two[1]))
    throw refused(loaded, "calibration.profile", "",
                  "a profile is drawn over two different free parameters",
                  "name two of those that are free, or none");
}

void check_data(const LoadedConfig& loaded) {
  const CalibrationOrder& order = loaded.config.calibration;
  if (order.problem == CalibrationProblem::curve && !order.data.empty())
    throw refused(loaded, "calibration.data", "",
                  "the problem curve makes its data by the continuum",
                  "leave data out, or take the problem experiment");
}

/// Law A knows no nu < 0, a table none beyond its nodes.
void bound_poissons_ratio(const LoadedConfig& loaded, FitOrder& order) {
  const CalibrationOrder& wanted = loaded.config.calibration;
  calibration::CurveFitOptions& options = order.options;
  const bool finite = order.base.lattice.kinematics == lattice::Kinematics::finite ||
                      wanted.problem == CalibrationProblem::finite_strain;
  if (finite) options.lowest_poissons_ratio = 0.0;
  if (wanted.problem != CalibrationProblem::experiment || wanted.forward != ForwardKind::continuum)
    return;
  options.lowest_poissons_ratio = wanted.poisson_range[0];
  options.highest_poissons_ratio = wanted.poisson_range[1];
  const double ratio = order.base.rubber.poissons_ratio();
  if (ratio < wanted.poisson_range[0] || ratio > wanted.poisson_range[1])
    throw refused(loaded, "calibration.poisson_range", "",
                  "Poisson's ratio of the rubber, from which the search starts, is " +
                      meshes::to_text(ratio) + ", outside of the range",
                  "widen the range, or start from another rubber");
}

/// What a model would refuse is said before the continuum runs for it.
void check_models(const LoadedConfig& loaded, const FitOrder& order) {
  const auto is_modulus = [](MaterialParameter parameter) {
    return parameter == youngs_modulus || parameter == shear_modulus;
  };
  for (std::size_t i = 0; i < order.kinds.size(); ++i) {
    if (order.kinds[i] == CurveKind::table &&
        !std::ranges::all_of(parameters_of(order), is_modulus))
      throw refused(loaded, "calibration.parameters", "", "the continuum knows E and G alone",
                    "free youngs_modulus, shear_modulus or both");
    if (order.kinds[i] != CurveKind::press) continue;
    try {
      calibration::LatticeForwardModel(order.presses[i], parameters_of(order));
    } catch (const meshes::InvalidInput& error) {
      std::vector<meshes::Violation> broken = error.violations();
      for (meshes::Violation& one : broken)
        if (one.key == "parameters") one.key = "calibration.parameters";
      throw loaded.locate(broken);
    }
  }
}

/// The lattice is needed where constants are sought or the press is the lattice's.
lattice::PressSetup base_of(const LoadedConfig& loaded) {
  return press_setup(loaded.with({"press.mode=static"}));
}

void check_model(const LoadedConfig& loaded) {
  const CalibrationOrder& order = loaded.config.calibration;
  const ModelKind model = loaded.config.press.lattice.model;
  const bool by_press =
      order.problem == CalibrationProblem::curve || order.problem == CalibrationProblem::experiment;
  if (by_press && model == ModelKind::published)
    throw refused(loaded, "lattice.model", "published",
                  "the published model has a rule for its constants and is not calibrated",
                  "calibrate central, hookean or network");
}

}  // namespace

fem_reference::ReferenceJob continuum_beside(const LoadedConfig& loaded,
                                             lattice::Kinematics kinematics) {
  LoadedConfig own = loaded;
  fem_reference::ReferenceJob& order = own.config.reference;
  order.analysis = fem_reference::Analysis::static_press;
  order.strain = kinematics == lattice::Kinematics::finite ? fem_reference::Strain::finite
                                                           : fem_reference::Strain::linear;
  order.law = fem_reference::StrainEnergy::law_a;
  order.write_fields = false;
  return reference_order(own);
}

FitSetup fit_setup(const LoadedConfig& loaded) {
  const CalibrationOrder& wanted = loaded.config.calibration;
  check_model(loaded);
  check_data(loaded);
  FitSetup fit;
  fit.order.problem = wanted.problem;
  fit.order.base = base_of(loaded);
  fit.order.options.free = free_list(loaded, fit.order.base);
  fit.order.options.robust_width = wanted.robust_width;
  fit.order.options.tolerance = search_tolerance;
  fit.order.program = "fingertip " + program_version();
  fit.order.profile = wanted.profile;
  check_profile(loaded, fit.order);
  bound_poissons_ratio(loaded, fit.order);
  const bool from_continuum =
      wanted.problem == CalibrationProblem::curve ||
      (wanted.problem == CalibrationProblem::damping && wanted.data.empty());
  if (from_continuum) {
    add_continuum_curves(fit, loaded);
  } else {
    add_measured_curves(fit, loaded);
  }
  fit.order.start_ratios = further_starts(fit.order, wanted);
  check_models(loaded, fit.order);
  return fit;
}

}  // namespace fingertip::studies
