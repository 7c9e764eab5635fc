#include "studies/fits/models/travel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calibration/press_fit/rig_estimates.h"
#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "studies/files/shown_units.h"

namespace fingertip::studies::inline fits::inline models {

using calibration::Curve;
using meshes::InvalidInput;
using meshes::to_text;

namespace {

constexpr const char* rig_key_name = "calibration.rig";

/// So much deeper than the touch tells at first the press is known.
constexpr double reserve = 0.05;

/// Deviations of what nobody has told of a load cell, over the largest force: its zero, and how far
/// that drifts from the first row to the last.
constexpr double usual_zero = 0.001, usual_drift = 0.001;

std::vector<double> depths_of(const Travel& travel) {
  return calibration::depths_for_rig(
      travel.settings.touch_offset.fitted ? (1.0 + reserve) * travel.reach : travel.reach);
}

}  // namespace

std::vector<CurveSource> blanks_of(const RigSettings& rig, std::vector<CurveSource> others) {
  if (!rig.blank.empty()) std::ranges::move(curve_sources(rig.blank), std::back_inserter(others));
  return others;
}

RigSettings with_blank(RigSettings rig, const std::vector<CurveSource>& blanks,
                       MeasuredFiles& files, std::vector<std::string>& notes) {
  if (blanks.empty()) return rig;
  if (rig.compliance.given)
    throw InvalidInput({rig_key_name, "compliance beside blank",
                        "the blank tells the compliance of its machine", "leave one of them out"});
  const auto say = [&](const std::string& note) {
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
  };
  // Repeats of the blank: the mean of their lines, which scatter.
  std::vector<calibration::Prior> found;
  double largest = 0.0;
  for (const CurveSource& source : blanks)
    for (const MeasuredFile& file : files.of(source, {measured::travel})) {
      for (const std::string& note : file.notes) say("blank " + file.curve.name + ": " + note);
      found.push_back(calibration::compliance_of_blank(file.curve));
      largest = std::max(largest, *std::ranges::max_element(file.curve.y));
    }
  const auto count = double(found.size());
  rig.compliance = {true, 0.0, 0.0, true};
  for (const calibration::Prior& each : found) rig.compliance.value += each.mean / count;
  double variance = 0.0;
  for (const calibration::Prior& each : found) {
    variance += std::pow(each.deviation / count, 2);
    if (found.size() > 1)
      variance += std::pow(each.mean - rig.compliance.value, 2) / (count * (count - 1.0));
  }
  rig.compliance.deviation = std::sqrt(variance);
  const ShownUnits& units = shown_units();
  say(fmt::format("blank {}: the machine gives way by {:.4g} +- {:.2g} {} (95 %), a line up to {}",
                  blanks.front().path.filename().string(), units.compliance(rig.compliance.value),
                  units.compliance(calibration::normal_95() * rig.compliance.deviation),
                  units.compliance.ascii, units.force.text(largest)));
  return rig;
}

std::vector<double> Travel::indentations(const Curve& curve,
                                         const Eigen::VectorXd& parameters) const {
  std::vector<double> result;
  const double offset = rig.touch_offset.in(parameters), soft = rig.compliance.in(parameters),
               zero = rig.force_offset.in(parameters);
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    result.push_back(std::max(0.0, curve.x[i] - offset - soft * std::max(0.0, curve.y[i] - zero)));
  return result;
}

calibration::Rig rig_of(const RigSettings& settings) {
  return {{settings.touch_offset.value},
          {settings.compliance.value},
          {settings.force_offset.value},
          {settings.drift.value}};
}

Travel travel_of(const Curve& curve, const CalibrationSettings& settings) {
  Travel travel{settings.rig, settings.machine, 0.0, 0.0, 0.0, {}, {}};
  RigSettings& rig = travel.settings;
  if ((rig.drift.fitted || rig.drift.value != 0.0) && curve.time.empty())
    throw InvalidInput({rig_key_name, "drift", curve.name + " has no times",
                        "give its column time, or leave the drift out"});
  const bool sought = rig.force_offset.given
                          ? rig.force_offset.fitted && rig.force_offset.deviation == 0.0
                          : curve.zero_is_sought;
  const double zero = sought ? curve.y.front() : rig.force_offset.value,
               soft = rig.compliance.fitted ? 0.0 : rig.compliance.value;
  travel.force = *std::ranges::max_element(curve.y) - zero;
  if (!rig.force_offset.given)
    rig.force_offset = {true, 0.0, sought ? 0.0 : usual_zero * travel.force, sought};
  if (!rig.drift.given && !curve.time.empty())
    rig.drift = {true, 0.0, usual_drift * travel.force / (curve.time.back() - curve.time.front())};
  const bool known = !rig.touch_offset.fitted || rig.touch_offset.deviation > 0.0;
  travel.touch =
      known ? rig.touch_offset.value : calibration::apparent_touch(curve, zero, soft, travel.force);
  const double deepest = *std::ranges::max_element(curve.x);
  travel.reach = deepest - travel.touch - soft * travel.force;
  if (!(travel.force > 0.0) || !(travel.reach > 0.0))
    throw InvalidInput(
        {rig_key_name, "touch at " + to_text(1e3 * travel.touch) + " mm",
         curve.name + " ends at " + to_text(1e3 * deepest) + " mm with the force " +
             to_text(travel.force) + " N and does not press",
         "correct touch_offset and compliance, or the column position, which grows as the finger "
         "is pressed"});
  travel.depths = depths_of(travel);
  travel.rig = rig_of(rig);
  return travel;
}

Travel continued(Travel travel, const Curve& curve, const Travel& before,
                 const Curve& rows_before) {
  const double zero = std::ranges::max(rows_before.y) - before.force;
  const RigSetting& compliance = travel.settings.compliance;
  travel.touch = before.touch;
  travel.force = std::ranges::max(curve.y) - zero;
  travel.reach = std::ranges::max(curve.x) - travel.touch -
                 (compliance.fitted ? 0.0 : compliance.value) * travel.force;
  travel.depths = depths_of(travel);
  return travel;
}

}  // namespace fingertip::studies::inline fits::inline models
