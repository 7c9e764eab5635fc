#include "studies/fits/setup/fit_plan.h"

#include <fmt/format.h>

#include <algorithm>

#include "calibration/press_fit/model_error.h"
#include "meshes/base/files.h"
#include "meshes/shape/geometry.h"
#include "studies/config/keys/key_table.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/fits/models/travel.h"
#include "studies/fits/setup/fit_curves.h"
#include "studies/fits/setup/fit_tolerances.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline fits::inline setup {

using calibration::Curve;

namespace {

/// Of the finger's radius at its pole, and of the ball's radius.
constexpr double ball_share = 0.4, ball_depth = 0.5;
constexpr double deep_factor = 1.5, shallow_factor = 0.5;

std::string in_words(const std::string& press, double depth) {
  return fmt::format("{}, to {:.3g} m", press, depth);
}

/// A press of which nothing is measured: its touch is where the settings say, else at zero.
Travel planned_travel(const RigSettings& rig, const std::string& machine, double deepest,
                      const std::vector<double>& depths) {
  return {rig, machine, rig.touch_offset.value, deepest, 1.0, depths, rig_of(rig)};
}

/// Indentations are travels of a rig that is known.
RigSettings rigid() {
  RigSettings settings;
  settings.touch_offset.fitted = false;
  return settings;
}

/// The searches of a plan would start where its rig is: free compliances without a prior at zero.
void start_at_the_rig(FitInput& input) {
  for (calibration::FreeParameter& free : input.options.free)
    if (calibration::is_of_the_rig(free.parameter))
      free.start = free.prior ? free.prior->mean : 0.0;
}

std::vector<double> times_of(const std::vector<double>& depths, double speed) {
  std::vector<double> times;
  for (const double depth : depths) times.push_back(depth / speed);
  return times;
}

}  // namespace

void add_planned_curves(FitSetup& fit, const LoadedConfig& loaded) {
  const CalibrationSettings& settings = loaded.config.calibration;
  const std::vector<std::string> conditions = settings.conditions.empty() && !settings.data.empty()
                                                  ? std::vector<std::string>(settings.data.size())
                                                  : conditions_of(loaded);
  if (!settings.data.empty() && settings.data.size() != conditions.size())
    throw refused(loaded, "calibration.conditions", "",
                  "there must be one per file of calibration.data, or none", "complete the list");
  FitInput& input = fit.input;
  input.provenance = "a plan";
  bool any_travel = false;
  for (std::size_t i = 0; i < conditions.size(); ++i) {
    const std::vector<std::string> condition = settings_in(conditions[i]);
    const LoadedConfig asked = under(loaded, condition, {"press.mode=static"});
    const meshes::PressProtocol& protocol = asked.config.press.protocol;
    Curve curve;
    if (!settings.data.empty()) curve.name = settings.data[i].stem().string();
    curve.x = asked.entries.at("press.samples").given
                  ? protocol.samples
                  : meshes::even_depths(protocol.depth, std::size_t(settings.points));
    curve.is_travel = asked.entries.at("calibration.rig").given;
    curve.time = times_of(curve.x, protocol.speed);
    any_travel = any_travel || curve.is_travel;
    RigSettings rig = rigid();
    try {
      const RigSettings& own = asked.config.calibration.rig;
      if (curve.is_travel) rig = with_blank(own, blanks_of(own), *fit.files, fit.notes);
    } catch (const meshes::InvalidInput& error) {
      throw asked.locate(error.violations());
    }
    const std::vector<double> depths =
        curve.is_travel ? calibration::depths_for_rig(curve.x.back()) : curve.x;
    add_press(fit, under(loaded, condition, {"press.mode=static", samples_setting(depths)}),
              press_kind(settings), curve)
        .travel = planned_travel(
        rig, curve.is_travel ? asked.config.calibration.machine : "indentation of " + curve.name,
        curve.x.back(), depths);
    fit.settings.push_back(condition);
    fit.contact_known = fit.contact_known && asked.entries.at("press.contact").given;
  }
  if (!any_travel) {
    for (FitCurve& curve : input.curves) curve.time.clear(), curve.travel.reset();
    return;
  }
  try {
    free_rigs(input);
  } catch (const meshes::InvalidInput& error) {
    throw loaded.locate(error.violations());
  }
  start_at_the_rig(input);
}

namespace {

/// What candidates are made of: the fit's first press.
struct FirstPress {
  const LoadedConfig& loaded;
  const FitSetup& fit;
  const lattice::PressSetup& press;
  std::vector<std::string> settings;
  double depth;  ///< of its values

  std::string words() const { return fit.input.curves.front().condition; }
};

/// Of values that are known over the travel what their start makes of it.
double deepest_value(const FitInput& input) {
  const FitCurve& first = input.curves.front();
  return first.y.empty() ? first.x.back() : depths_of_values(first, start_of(input.options)).back();
}

/// One curve over the indentations of a press, behind a rig like the first one's.
std::shared_ptr<const FitInput> input_of(const FirstPress& first, const LoadedConfig& own,
                                         const std::string& name, double depth) {
  FitSetup further;
  const FitInput& input = first.fit.input;
  const FitCurve& like = input.curves.front();
  Curve curve;
  curve.name = name;
  curve.x = meshes::even_depths(depth, like.x.size());
  curve.is_travel = like.travel.has_value();
  curve.time = times_of(curve.x, own.config.press.protocol.speed);
  FitCurve& added = add_press(further, own, like.kind, curve);
  FitInput& result = further.input;
  result.problem = input.problem;
  result.base = input.base;
  result.place = "next_" + name;
  result.with_lattice_error = input.with_lattice_error;
  result.known_errors = input.known_errors;
  added.known_errors = known_errors_of(input, added.press);
  const std::size_t rubber = material_parameters(input);
  result.options.free.assign(input.options.free.begin(),
                             input.options.free.begin() + std::ptrdiff_t(rubber));
  added.travel =
      planned_travel(like.travel ? like.travel->settings : rigid(),
                     like.travel ? like.travel->machine : "", depth, added.press.protocol.samples);
  free_rigs(result);
  return std::make_shared<const FitInput>(std::move(result));
}

/// A press that has to be computed.
Candidate pressed(const FirstPress& first, const std::string& name,
                  const std::vector<std::string>& further, double depth) {
  Candidate candidate{.name = name, .depth = depth};
  std::vector<std::string> condition = first.settings;
  condition.insert(condition.end(), further.begin(), further.end());
  try {
    const LoadedConfig own =
        under(first.loaded, condition,
              {"press.mode=static", samples_setting(calibration::depths_for_rig(depth))});
    candidate.input = input_of(first, own, name, depth);
    candidate.press = in_words(candidate.input->curves.front().condition, depth);
  } catch (const meshes::InvalidInput& error) {
    candidate.refused = to_string(error.violations().front());
  }
  return candidate;
}

/// A continuum in three dimensions takes minutes: only on request.
bool is_expensive(const FirstPress& first, const Candidate& candidate) {
  return by_continuum(first.fit.input) && candidate.input &&
         !candidate.input->curves.front().continuum.axisymmetric();
}

std::string length_setting(const char* key, double metres) {
  return std::string(key) + "=" + meshes::to_text(metres) + " m";
}

/// One of the words; none where the first press is it already.
std::optional<Candidate> named_candidate(const FirstPress& first, const std::string& word) {
  using meshes::ObstacleShape;
  const meshes::PressProtocol& protocol = first.press.protocol;
  const meshes::Obstacle& obstacle = protocol.obstacle;
  if (word == "repeat" || word == "shallow") {
    const double depth = (word == "repeat" ? 1.0 : shallow_factor) * first.depth;
    return Candidate{.name = word, .press = in_words(first.words(), depth), .depth = depth};
  }
  if (word == "blank") {
    const bool fitted = std::ranges::any_of(first.fit.input.options.free, [](const auto& free) {
      return free.parameter == calibration::MaterialParameter::compliance;
    });
    if (!fitted) return std::nullopt;
    return Candidate{.name = word,
                     .press = "a rigid blank in the finger's place, to the same forces",
                     .blank = true};
  }
  if (word == "deep") return pressed(first, word, {}, deep_factor * first.depth);
  if (word == "ball") {
    if (obstacle.shape == ObstacleShape::sphere) return std::nullopt;
    const double radius = ball_share * meshes::shape_of(first.press.geometry)->pole_radius();
    return pressed(
        first, word,
        {"obstacle.shape=sphere", length_setting("obstacle.radius", radius), "obstacle.offset=0 m"},
        std::min(first.depth, ball_depth * radius));
  }
  if (word == "plane") {
    if (obstacle.shape == ObstacleShape::plane) return std::nullopt;
    return pressed(first, word, {"obstacle.shape=plane"}, first.depth);
  }
  const bool sticks = protocol.contact == meshes::ContactMode::stick;
  return pressed(first, word, {std::string("press.contact=") + (sticks ? "frictionless" : "stick")},
                 first.depth);
}

constexpr const char* words[] = {"repeat", "shallow", "deep", "blank", "ball", "plane", "contact"};

Candidate conditioned(const FirstPress& first, const std::string& name,
                      const std::string& condition) {
  const std::vector<std::string> further = settings_in(condition);
  double depth = first.depth;
  try {
    const LoadedConfig own = under(first.loaded, further, {"press.mode=static"});
    if (std::ranges::any_of(further,
                            [](const std::string& set) { return set.starts_with("press.depth"); }))
      depth = own.config.press.protocol.depth;
  } catch (const ConfigError& error) {
    return {.name = name,
            .press = condition,
            .depth = depth,
            .refused = to_string(error.violations().front())};
  }
  return pressed(first, name, further, depth);
}

}  // namespace

std::vector<Candidate> candidates_of(const LoadedConfig& loaded, const FitSetup& fit) {
  std::vector<Candidate> candidates;
  const FitInput& input = fit.input;
  if (input.problem != CalibrationProblem::experiment || !has_presses(input)) return candidates;
  const FirstPress first{loaded, fit, input.curves.front().press, fit.settings.front(),
                         deepest_value(input)};
  int conditions = 0;
  for (const std::string& entry : loaded.config.calibration.candidates) {
    if (entry.find('=') != entry.npos) {
      candidates.push_back(conditioned(first, "press_" + std::to_string(++conditions), entry));
      continue;
    }
    if (std::ranges::find(words, entry) == std::end(words))
      throw refused(
          loaded, "calibration.candidates", entry,
          "a candidate is repeat, shallow, deep, blank, ball, plane, contact or a "
          "condition",
          "did you mean " + nearest_word(entry, {std::begin(words), std::end(words)}) + "?");
    std::optional<Candidate> candidate = named_candidate(first, entry);
    if (candidate && !is_expensive(first, *candidate)) candidates.push_back(std::move(*candidate));
  }
  return candidates;
}

}  // namespace fingertip::studies::inline fits::inline setup
