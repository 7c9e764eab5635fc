#include "studies/fits/models/travel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/statistics/fit_statistics.h"
#include "meshes/base/errors.h"
#include "meshes/base/files.h"
#include "studies/files/shown_units.h"
#include "studies/measurements/curve_file.h"

namespace fingertip::studies {

using calibration::Curve;
using meshes::InvalidInput;
using meshes::to_text;

namespace {

constexpr const char* rig_key_name = "calibration.rig";

/// Shares of the largest force between which F^(2/3) is taken as straight.
constexpr double lowest_share = 0.05, highest_share = 0.4;
/// So much deeper than the touch tells at first the press is known.
constexpr double reserve = 0.05;
/// Where the regression of F^(2/3) on the travel, less what the machine gives way, has no force.
double apparent_touch(const Curve& curve, double zero, double compliance, double force) {
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    const double f = curve.y[i] - zero;
    if (f < lowest_share * force || f > highest_share * force) continue;
    const double x = curve.x[i] - compliance * f - curve.x.front(), y = std::cbrt(f * f);
    n += 1.0;
    sx += x;
    sy += y;
    sxx += x * x;
    sxy += x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  if (n < 2.0 || !(slope > 0.0)) return curve.x.front();
  return curve.x.front() + (sx - sy / slope) / n;
}

/// A line y = a + s x, and the standard error of s.
struct Regression {
  std::size_t count = 0;
  double slope = 0.0, error = 0.0;
};

Regression line_through(const std::vector<double>& x, const std::vector<double>& y) {
  const auto n = double(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n,
               mean_y = std::accumulate(y.begin(), y.end(), 0.0) / n;
  double sxx = 0.0, sxy = 0.0, left = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    sxx += (x[i] - mean_x) * (x[i] - mean_x);
    sxy += (x[i] - mean_x) * (y[i] - mean_y);
  }
  const double slope = sxy / sxx;
  for (std::size_t i = 0; i < x.size(); ++i)
    left += std::pow(y[i] - mean_y - slope * (x[i] - mean_x), 2);
  return {x.size(), slope, std::sqrt(left / ((n - 2.0) * sxx))};
}

}  // namespace

RigSetting compliance_of_blank(const Curve& curve) {
  constexpr double lowest_of_line = 0.1, least_known = 1e-4;
  constexpr std::size_t least_forces = 6;
  const double zero = curve.y.front(), largest = *std::ranges::max_element(curve.y) - zero;
  std::vector<double> x, y;
  for (std::size_t i = 0; i < curve.y.size(); ++i)
    if (curve.y[i] - zero >= lowest_of_line * largest)
      x.push_back(curve.x[i]), y.push_back(curve.y[i]);
  const auto refuse = [&](const std::string& value, const char* rule, const char* remedy) {
    throw InvalidInput({rig_key_name, "blank " + curve.name + ": " + value, rule, remedy});
  };
  if (x.size() < least_forces)
    refuse(std::to_string(x.size()) + " forces above a tenth of the largest",
           "a line needs six or more", "press the blank again, in smaller steps");
  const auto middle = std::ptrdiff_t(x.size() / 2);
  const Regression whole = line_through(x, y),
                   lower = line_through({x.begin(), x.begin() + middle},
                                        {y.begin(), y.begin() + middle}),
                   upper =
                       line_through({x.begin() + middle, x.end()}, {y.begin() + middle, y.end()});
  if (!(whole.slope > 0.0))
    refuse("the force does not grow with the travel", "a blank is pressed as a finger is",
           "turn the sign of position or force (studies/manual/your_press.md)");
  const double c = 1.0 / whole.slope;
  const double error = c * whole.error / whole.slope * calibration::student_95(int(x.size()) - 2) /
                       calibration::normal_95();
  // Of a c that is equally likely anywhere between those of the halves.
  double bent = 0.0;
  if (lower.slope > 0.0 && upper.slope > 0.0) {
    const double noise = std::hypot(lower.error / (lower.slope * lower.slope),
                                    upper.error / (upper.slope * upper.slope)),
                 apart = std::abs(1.0 / lower.slope - 1.0 / upper.slope);
    if (apart > 3.0 * noise) bent = apart / std::sqrt(12.0);
  }
  return {true, c, std::max(std::hypot(error, bent), least_known * c), true};
}

RigSettings with_blank(RigSettings rig, std::vector<CurveSource> others,
                       std::vector<std::string>& notes) {
  if (!rig.blank.empty()) std::ranges::move(curve_sources(rig.blank), std::back_inserter(others));
  if (others.empty()) return rig;
  if (rig.compliance.given)
    throw InvalidInput({rig_key_name, "compliance beside blank",
                        "the blank tells the compliance of its machine", "leave one of them out"});
  const auto say = [&](const std::string& note) {
    if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
  };
  // Repeats of the blank: the mean of their lines, which scatter.
  std::vector<RigSetting> found;
  double largest = 0.0;
  for (const CurveSource& source : others)
    for (const MeasuredFile& file : read_measured(source, {measured::travel})) {
      for (const std::string& note : file.notes) say("blank " + file.curve.name + ": " + note);
      found.push_back(compliance_of_blank(file.curve));
      largest = std::max(largest, *std::ranges::max_element(file.curve.y));
    }
  const auto count = double(found.size());
  rig.compliance = {true, 0.0, 0.0, true};
  for (const RigSetting& each : found) rig.compliance.value += each.value / count;
  double variance = 0.0;
  for (const RigSetting& each : found) {
    variance += std::pow(each.deviation / count, 2);
    if (found.size() > 1)
      variance += std::pow(each.value - rig.compliance.value, 2) / (count * (count - 1.0));
  }
  rig.compliance.deviation = std::sqrt(variance);
  const ShownUnits& units = shown_units();
  say(fmt::format("blank {}: the machine gives way by {:.4g} +- {:.2g} {} (95 %), a line up to {}",
                  others.front().path.filename().string(), units.compliance(rig.compliance.value),
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
  const RigSettings& rig = travel.settings;
  if ((rig.drift.fitted || rig.drift.value != 0.0) && curve.time.empty())
    throw InvalidInput({rig_key_name, "drift", curve.name + " has no times",
                        "give its column time, or leave the drift out"});
  const double zero = rig.force_offset.fitted && rig.force_offset.deviation == 0.0
                          ? curve.y.front()
                          : rig.force_offset.value,
               soft = rig.compliance.fitted ? 0.0 : rig.compliance.value;
  travel.force = *std::ranges::max_element(curve.y) - zero;
  const bool known = !rig.touch_offset.fitted || rig.touch_offset.deviation > 0.0;
  travel.touch = known ? rig.touch_offset.value : apparent_touch(curve, zero, soft, travel.force);
  const double deepest = *std::ranges::max_element(curve.x);
  travel.reach = deepest - travel.touch - soft * travel.force;
  if (!(travel.force > 0.0) || !(travel.reach > 0.0))
    throw InvalidInput(
        {rig_key_name, "touch at " + to_text(1e3 * travel.touch) + " mm",
         curve.name + " ends at " + to_text(1e3 * deepest) + " mm with the force " +
             to_text(travel.force) + " N and does not press",
         "correct touch_offset and compliance, or the column position, which grows as the finger "
         "is pressed"});
  const double early = rig.touch_offset.fitted ? (1.0 + reserve) * travel.reach : travel.reach;
  travel.depths = calibration::depths_for_rig(early);
  travel.rig = rig_of(rig);
  return travel;
}

}  // namespace fingertip::studies
