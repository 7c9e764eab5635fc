#include "studies/fits/models/fit_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "meshes/base/errors.h"
#include "meshes/tables/interpolation.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::Curve;
using calibration::FitQuantity;
using calibration::FreeParameter;
using calibration::MaterialParameter;
using meshes::InvalidInput;

namespace {

/// The touch may turn out so much earlier, or later, than it seems; over the reach.
constexpr double touch_range = 0.3;
/// Compliances over reach/force: where a search starts, and between which it stays. Noise makes an
/// estimate negative where there is none.
constexpr double start_compliance = 0.05, lowest_compliance = -0.1;
/// Bounds about the mean of a prior, in deviations: of one that was told, and of the usual.
constexpr double prior_range = 6.0, usual_range = 300.0;

/// What is fitted has its start and bounds from `usual`, unless a prior gives them.
FreeParameter free_of(MaterialParameter parameter, const RigSetting& setting, FreeParameter usual,
                      const std::string& of) {
  usual.parameter = parameter;
  usual.of = of;
  if (setting.deviation > 0.0) {
    const double range = setting.given ? prior_range : usual_range;
    usual.start = setting.value;
    usual.lower = setting.value - range * setting.deviation;
    usual.upper = std::min(usual.upper, setting.value + range * setting.deviation);
    // Who forgot to tare has forgotten it altogether.
    usual.prior = calibration::Prior{setting.value, setting.deviation, !setting.given};
    // Nobody has told it, and no machine has less than none.
    if (parameter == MaterialParameter::compliance && !setting.given)
      usual.lower = 0.0, usual.start = std::min(0.5 * setting.deviation, 0.1 * usual.upper);
  }
  return usual;
}

bool same(const RigSetting& a, const RigSetting& b) {
  return a.fitted == b.fitted && a.value == b.value && a.deviation == b.deviation;
}

/// Appends one and says where.
FitQuantity append(FitInput& input, FreeParameter free) {
  input.options.free.push_back(std::move(free));
  return {0.0, Eigen::Index(input.options.free.size() - 1)};
}

/// What one file says of the compliance holds for all of its machine.
void share_compliances(std::vector<FitCurve>& curves) {
  std::map<std::string, RigSetting> known;
  for (const FitCurve& curve : curves)
    if (curve.travel->settings.compliance.given)
      known.emplace(curve.travel->machine, curve.travel->settings.compliance);
  for (FitCurve& curve : curves) {
    RigSetting& own = curve.travel->settings.compliance;
    const auto other = known.find(curve.travel->machine);
    if (other == known.end()) continue;
    if (!own.given) own = other->second, curve.travel->rig.compliance.value = own.value;
    if (!same(other->second, own))
      throw InvalidInput({"calibration.rig", "two compliances",
                          "files of one machine have one compliance",
                          "name the machines: calibration.machine in calibration.conditions"});
  }
}

}  // namespace

void free_rigs(FitInput& input) {
  share_compliances(input.curves);
  using enum MaterialParameter;
  std::map<std::string, FitQuantity> compliances;
  for (const FitCurve& curve : input.curves) compliances[curve.travel->machine];
  const std::size_t machines = compliances.size();
  compliances.clear();
  for (FitCurve& curve : input.curves) {
    Travel& travel = *curve.travel;
    const RigSettings& rig = travel.settings;
    const std::string of = input.curves.size() > 1 ? curve.name : "";
    const Travel* before = curve.continues ? &*input.curves[*curve.continues].travel : nullptr;
    if (before != nullptr) {
      travel.rig.touch_offset = before->rig.touch_offset;
      travel.rig.force_offset = before->rig.force_offset;
    } else if (rig.touch_offset.fitted)
      travel.rig.touch_offset =
          append(input, free_of(touch_offset, rig.touch_offset,
                                {.start = travel.touch,
                                 .lower = travel.touch - touch_range * travel.reach,
                                 .upper = travel.touch + touch_range * travel.reach,
                                 .scale = travel.reach},
                                of));
    const double soft = travel.reach / travel.force;
    if (rig.compliance.fitted) {
      if (!compliances.contains(travel.machine))
        compliances[travel.machine] = append(input, free_of(compliance, rig.compliance,
                                                            {.start = start_compliance * soft,
                                                             .lower = lowest_compliance * soft,
                                                             .upper = highest_compliance * soft,
                                                             .scale = soft},
                                                            machines > 1 ? travel.machine : ""));
      travel.rig.compliance = compliances[travel.machine];
    }
    if (rig.force_offset.fitted && before == nullptr)
      travel.rig.force_offset = append(
          input,
          free_of(force_offset, rig.force_offset,
                  {.start = curve.y.empty() ? 0.0 : curve.y.front(), .scale = travel.force}, of));
    if (rig.drift.fitted) {
      const double span = curve.time.back() - curve.time.front();
      travel.rig.drift = append(
          input, free_of(drift, rig.drift, {.start = 0.0, .scale = travel.force / span}, of));
    }
  }
}

std::size_t material_parameters(const FitInput& input) {
  return std::size_t(std::ranges::count_if(input.options.free, [](const FreeParameter& free) {
    return !calibration::is_behind_the_press(free.parameter);
  }));
}

std::vector<calibration::RigValue> rig_values(const FitInput& input) {
  std::vector<calibration::RigValue> values;
  const auto add = [&](MaterialParameter parameter, const std::string& of, const FitQuantity& own,
                       bool given) {
    values.push_back({parameter, of, own.value, {}, given});
    if (own.place) values.back().place = std::size_t(*own.place);
  };
  // Files of one machine share what one of them says of it.
  const auto machine_given = [&](const std::string& machine) {
    return std::ranges::any_of(input.curves, [&](const FitCurve& curve) {
      return curve.travel->machine == machine && curve.travel->settings.compliance.given;
    });
  };
  std::vector<std::string> machines;
  using enum MaterialParameter;
  if (!has_travels(input)) return values;
  for (const FitCurve& curve : input.curves) {
    const Travel& travel = *curve.travel;
    const RigSettings& settings = travel.settings;
    add(touch_offset, curve.name, travel.rig.touch_offset, settings.touch_offset.given);
    add(force_offset, curve.name, travel.rig.force_offset, settings.force_offset.given);
    if (!curve.time.empty()) add(drift, curve.name, travel.rig.drift, settings.drift.given);
    if (std::ranges::find(machines, travel.machine) != machines.end()) continue;
    machines.push_back(travel.machine);
    add(compliance, travel.machine, travel.rig.compliance, machine_given(travel.machine));
  }
  return values;
}

std::vector<double> depths_of_values(const FitCurve& curve, const Eigen::VectorXd& start) {
  if (!curve.travel) return curve.x;
  std::vector<double> depths = curve.travel->indentations(curve, start);
  for (double& depth : depths) depth = std::max(depth, 0.01 * curve.travel->depths.front());
  return depths;
}

std::vector<double> at_values(const FitCurve& curve, const Eigen::VectorXd& start,
                              const std::vector<double>& at_samples) {
  if (!curve.travel) return at_samples;
  std::vector<double> result;
  for (const double depth : depths_of_values(curve, start))
    result.push_back(meshes::interpolated(curve.travel->depths, at_samples, depth));
  return result;
}

}  // namespace fingertip::studies::inline fits::inline models
