#include "studies/fits/setup/fit_curves.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/base/files.h"
#include "studies/config/finger_defaults.h"
#include "studies/config/text/trimmed.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline fits::inline setup {

using calibration::Curve;

std::vector<std::string> settings_in(std::string_view condition) {
  std::vector<std::string> sets;
  std::size_t begin = 0;
  while (begin <= condition.size()) {
    const std::size_t end = std::min(condition.find(';', begin), condition.size());
    const std::string_view setting = trimmed(condition.substr(begin, end - begin));
    const auto equals = setting.find('=');
    if (equals != setting.npos)
      sets.push_back(std::string(trimmed(setting.substr(0, equals))) + "=" +
                     std::string(trimmed(setting.substr(equals + 1))));
    else if (!setting.empty())
      sets.emplace_back(setting);
    begin = end + 1;
  }
  return sets;
}

namespace {

/// A condition says how a press is done: what it is done with is common to all curves.
void check_condition(const LoadedConfig& loaded, const std::vector<std::string>& sets) {
  for (const std::string& setting : sets) {
    const std::string section = setting.substr(0, setting.find('.'));
    const std::string key(trimmed(std::string_view(setting).substr(0, setting.find('='))));
    const bool of_rig = key == "calibration.rig" || key == "calibration.machine";
    if (section != "press" && section != "geometry" && section != "reference" &&
        section != "obstacle" && !of_rig)
      throw refused(loaded, "calibration.conditions", setting,
                    "a curve's condition sets keys of press, obstacle, geometry and reference, "
                    "calibration.rig and calibration.machine",
                    "set rubber, lattice and calibration for the whole fit");
  }
}

}  // namespace

LoadedConfig under(const LoadedConfig& loaded, const std::vector<std::string>& condition,
                   const std::vector<std::string>& derived) {
  check_condition(loaded, condition);
  std::vector<std::string> sets = condition;
  sets.insert(sets.end(), derived.begin(), derived.end());
  LoadedConfig own = with_sets(loaded, sets);
  keep_spacing(own, loaded);  // one lattice for all curves, whatever samples they take
  return own;
}

std::string samples_setting(const std::vector<double>& depths) {
  std::string list;
  for (const double depth : depths)
    list += (list.empty() ? "\"" : ", \"") + meshes::to_text(depth) + " m\"";
  return "press.samples=[" + list + "]";
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
  const meshes::Obstacle& obstacle = setup.protocol.obstacle;
  if (obstacle.shape != meshes::ObstacleShape::plane)
    text += ", " + std::string(meshes::name(obstacle.shape)) + " of " +
            meshes::to_text(obstacle.radius) + " m";
  if (setup.protocol.lateral != 0.0)
    text += ", lateral " + meshes::to_text(setup.protocol.lateral) + " m";
  return text;
}

FitCurve& add_curve(FitInput& input, CurveKind kind, Curve curve, const std::string& condition) {
  const std::string name = curve.name.empty() ? condition : curve.name;
  curve.name = name;
  for (int copy = 2;
       std::ranges::find(input.curves, curve.name, &FitCurve::name) != input.curves.end(); ++copy)
    curve.name = name + " (" + std::to_string(copy) + ")";
  FitCurve& added = input.curves.emplace_back(std::move(curve));
  added.kind = kind;
  added.condition = condition;
  return added;
}

LatticeUse lattice_of_fit(const LoadedConfig& loaded) {
  return loaded.config.calibration.forward == ForwardKind::continuum ? LatticeUse::none
                                                                     : LatticeUse::press;
}

void refuse_motion(const LoadedConfig& own, const meshes::PressProtocol& protocol) {
  if (protocol.moves_after())
    throw own.locate(
        {{protocol.has_twist() ? "press.twist" : "press.lateral_path",
          protocol.has_twist() ? meshes::to_text(protocol.twist) + " rad" : "after",
          "a fit takes what a press does against indentation, and a motion at full depth has none",
          "choose press.lateral_path = diagonal, or leave press.lateral and press.twist at 0"}});
  if (!protocol.program.empty())
    throw own.locate(
        {{"press.program", "given", "a fit takes presses against the indentation of one loading",
          "leave it out, or give press.depth and press.speed"}});
}

FitCurve& add_press(FitSetup& fit, const LoadedConfig& own, CurveKind kind, Curve curve) {
  lattice::PressSetup press = press_setup(own, lattice_of_fit(own));
  press.slopes = false;  // a fit asks for those by what it seeks
  refuse_motion(own, press.protocol);
  FitCurve& added = add_curve(fit.input, kind, std::move(curve), described(press));
  added.press = press;
  added.continuum = continuum_beside(own, press.lattice.kinematics);
  return added;
}

CurveKind press_kind(const CalibrationSettings& settings) {
  return settings.forward == ForwardKind::continuum ? CurveKind::continuum : CurveKind::press;
}

namespace {

/// The start of a driven rod shakes the tip; this long a way dies the shaking out before touch.
constexpr double run_up = 0.1;  // [s]

/// A moving lattice beside the transient continuum. Its step is that of the largest retardation
/// time a fit may try, twice the configuration's.
void add_moving_press(FitSetup& fit, const LoadedConfig& own, Curve curve) {
  FitCurve& added = add_press(fit, own, CurveKind::moving_press, std::move(curve));
  added.press.protocol.clearance = run_up * added.press.protocol.speed;
  added.press.rubber.retardation_time *= 2.0;
  added.continuum.analysis = fem_reference::Analysis::transient;
  added.continuum.strain = fem_reference::Strain::linear;
}

}  // namespace

void add_continuum_curves(FitSetup& fit, const LoadedConfig& loaded) {
  const CalibrationSettings& settings = loaded.config.calibration;
  fit.data_from_continuum = true;
  fit.input.provenance = "forces of the continuum reference";
  fit.input.rubber_known = true;
  const bool moving = settings.problem == CalibrationProblem::damping;
  for (const std::string& condition : conditions_of(loaded)) {
    const LoadedConfig own =
        under(loaded, settings_in(condition),
              {moving ? "press.mode=quasi-static" : "press.mode=static",
               samples_setting(meshes::even_depths(settings.depth, std::size_t(settings.points)))});
    Curve curve;
    curve.x = own.config.press.protocol.samples;
    if (moving) {
      add_moving_press(fit, own, curve);
    } else {
      add_press(fit, own, CurveKind::press, curve);
    }
  }
}

}  // namespace fingertip::studies::inline fits::inline setup
