#include "calibration/material_tests/material_test.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "meshes/base/files.h"

namespace fingertip::calibration::inline material_tests {

using meshes::to_text;
using meshes::Violation;

namespace {

/// Beyond it, and its inverse, a deformation is a mistake of units.
constexpr double max_stretch = 20.0;

bool is_possible(TestKind kind, double deformation) {
  if (kind == TestKind::simple_shear) return std::abs(deformation) <= max_stretch;
  return deformation >= 1.0 / max_stretch && deformation <= max_stretch;
}

bool right_length(std::size_t length, std::size_t points) {
  return length == 0 || length == points;
}

}  // namespace

DeformationMode mode_of(TestKind kind, double deformation) {
  if (kind != TestKind::uniaxial && kind != TestKind::equibiaxial) return DeformationMode::shear;
  return (kind == TestKind::uniaxial) == (deformation > 1.0) ? DeformationMode::tension
                                                             : DeformationMode::compression;
}

double StrainPath::at(double when) const {
  const auto next = std::ranges::upper_bound(time, when);
  if (next == time.begin()) return deformation.front();
  const std::size_t i = std::size_t(next - time.begin()) - 1;
  if (i + 1 == time.size() || time[i] == when) return deformation[i];
  const double part = (when - time[i]) / (time[i + 1] - time[i]);
  return deformation[i] + part * (deformation[i + 1] - deformation[i]);
}

double StrainPath::held_from(double rest) const {
  const double held = deformation.back(), close = 0.02 * std::abs(held - rest);
  std::size_t i = deformation.size() - 1;
  while (i > 0 && std::abs(deformation[i - 1] - held) <= close) --i;
  return time[i];
}

std::vector<Violation> MaterialTest::violations() const {
  std::vector<Violation> found;
  const auto refuse = [&](const char* what, const std::string& value, const std::string& rule,
                          const char* remedy) {
    found.push_back({"test " + name + ", " + what, value, rule, remedy});
  };
  if (deformation.empty()) refuse("deformation", "none", "a test needs points", "give its points");
  if (stress.size() != deformation.size() || !right_length(sigma.size(), stress.size()) ||
      !right_length(constraint.size(), stress.size()))
    refuse("stress", std::to_string(stress.size()) + " values",
           "every deformation has a stress, and all or none have a deviation and a factor",
           "complete the lists");
  for (std::size_t i = 0; i < deformation.size(); ++i) {
    const double value = deformation[i];
    if (course != TestCourse::slow ||
        (value > 0.0 && is_possible(kind, value) && (i == 0 || value > deformation[i - 1])))
      continue;
    refuse(
        "deformation", to_text(value),
        "must be positive, at most 20 (a stretch at least 1/20) and increase from point to point",
        "look at the definition of strain and its unit (per cent have unit = \"%\"), and sort the "
        "points");
    break;
  }
  if (course != TestCourse::slow) append(found, time_violations());
  const auto finite = [](double value) { return std::isfinite(value); };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  if (!std::ranges::all_of(stress, finite))
    refuse("stress", "nan", "stresses must be finite", "remove the point");
  if (!stress.empty() && std::ranges::all_of(stress, [](double value) { return value == 0.0; }))
    refuse("stress", "0", "at least one stress must differ from 0", "give another column");
  if (!std::ranges::all_of(sigma, positive))
    refuse("sigma", "not positive", "deviations must be finite and positive", "give none, or all");
  if (!std::ranges::all_of(constraint, positive))
    refuse("constraint", "not positive", "factors on the force must be finite and positive",
           "give none, or all");
  // Beyond, times are no numbers.
  if (rate && !(*rate >= 1e-12 && *rate <= 1e12))
    refuse("rate", to_text(*rate), "a rate must be positive, from 1e-12 to 1e12 1/s",
           "leave it out where it is unknown");
  return found;
}

std::vector<Violation> MaterialTest::time_violations() const {
  std::vector<Violation> found;
  const auto refuse = [&](const char* what, const std::string& value, const char* rule,
                          const char* remedy) {
    found.push_back({"test " + name + ", " + what, value, rule, remedy});
  };
  if (kind == TestKind::volumetric)
    refuse("kind", "volumetric", "a change of volume is told in equilibrium alone",
           "give the test without times");
  if (time.size() != stress.size() || path.empty() || path.time.size() != path.deformation.size()) {
    refuse("time", std::to_string(time.size()) + " values",
           "every stress has its time, and the specimen a deformation in time",
           "complete the lists");
    return found;
  }
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::ranges::all_of(time, finite) || !std::ranges::all_of(path.time, finite) ||
      std::ranges::adjacent_find(time, std::greater_equal()) != time.end() ||
      !std::ranges::is_sorted(path.time))
    refuse("time", "", "times must be finite and increase", "sort the points by their time");
  else if (!time.empty() && (time.front() < path.time.front() || time.back() > path.time.back()))
    refuse("time", to_text(time.front()) + " s to " + to_text(time.back()) + " s",
           "the deformation must be known as long as stresses are", "complete its course");
  for (const double value : all_deformations()) {
    if (is_possible(kind, value)) continue;
    refuse("deformation", to_text(value),
           "a stretch is positive, at least 1/20, and no deformation exceeds 20",
           "look at the definition of strain and its unit");
    break;
  }
  const auto rests = [&](double value) { return value == rest_of(kind); };
  if (std::ranges::all_of(all_deformations(), rests))
    refuse("deformation", to_text(rest_of(kind)), "the specimen is never deformed",
           "give another column");
  if (!constraint.empty())
    refuse("constraint", "given", "what plates hold is known in equilibrium alone",
           "give a test between plates that slip");
  return found;
}

std::vector<double> MaterialTest::all_deformations() const {
  std::vector<double> all = deformation;
  all.insert(all.end(), path.deformation.begin(), path.deformation.end());
  return all;
}

double rest_of(TestKind kind) {
  return kind == TestKind::simple_shear ? 0.0 : 1.0;
}

std::array<double, 2> observed_times(const MaterialTest& test) {
  const double start = test.path.time.front(), last = test.time.back() - start;
  if (test.course == TestCourse::cycles || test.time.size() < 2)
    return {last / double(std::max<std::size_t>(1, test.time.size() - 1)), last};
  const double held = test.path.held_from(rest_of(test.kind)), ramp = held - start;
  const auto before = std::ranges::upper_bound(test.time, start),
             after = std::ranges::upper_bound(test.time, held);
  // Rows of the ramp tell of it as those of cycles do; two are its ends.
  if (const auto rows = after - before; rows > 2)
    return {(*(after - 1) - start) / double(rows), last};
  const double first = after == test.time.end() ? last : *after - held;
  return {std::max(ramp, first), last};
}

double loop_area(const MaterialTest& test, const std::vector<double>& stress) {
  const std::size_t n = stress.size();
  const auto nominal = [&](std::size_t i) {
    const bool force =
        test.measure == StressMeasure::nominal || test.kind == TestKind::simple_shear;
    return force ? stress[i] : stress[i] / test.deformation[i];
  };
  double area = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + 1) % n;
    area += 0.5 * (nominal(i) + nominal(next)) * (test.deformation[next] - test.deformation[i]);
  }
  return area;
}

std::array<double, 3> principal_stretches(TestKind kind, double deformation) {
  const double l = deformation;
  switch (kind) {
    case TestKind::uniaxial: return {l, 1.0 / std::sqrt(l), 1.0 / std::sqrt(l)};
    case TestKind::equibiaxial: return {l, l, 1.0 / (l * l)};
    case TestKind::planar: return {l, 1.0, 1.0 / l};
    case TestKind::simple_shear: {
      const double longest = std::exp(std::asinh(0.5 * l));
      return {longest, 1.0, 1.0 / longest};
    }
    case TestKind::volumetric: return {std::cbrt(l), std::cbrt(l), std::cbrt(l)};
  }
  return {1.0, 1.0, 1.0};
}

/// Largest logarithmic strain [1].
double strain_size(TestKind kind, double deformation) {
  double size = 0.0;
  for (const double stretch : principal_stretches(kind, deformation))
    size = std::max(size, std::abs(std::log(stretch)));
  return size;
}

namespace {

/// What a test does on one side of rest counts by itself where it goes so far, of all its strain.
constexpr double min_side = 0.1;

std::string way_of(TestKind kind, DeformationMode mode) {
  if (kind == TestKind::planar) return "planar tension";
  if (kind == TestKind::simple_shear) return std::string(name(kind));
  if (kind != TestKind::equibiaxial) return std::string(name(mode));
  return mode == DeformationMode::compression ? "biaxial tension" : "biaxial compression";
}

}  // namespace

std::vector<TestPart> parts_of(const MaterialTest& test) {
  std::map<DeformationMode, TestPart> sides;
  for (std::size_t i = 0; i < test.deformation.size(); ++i) {
    const DeformationMode mode = mode_of(test.kind, test.deformation[i]);
    TestPart& side = sides[mode];
    side.mode = mode;
    side.way = way_of(test.kind, mode);
    side.name = test.name + " in " + side.way;
    side.points.push_back(i);
    side.strain = std::max(side.strain, strain_size(test.kind, test.deformation[i]));
  }
  std::vector<TestPart> parts;
  for (auto& [mode, side] : sides) parts.push_back(std::move(side));
  std::ranges::stable_sort(parts, std::greater(), &TestPart::strain);
  if (parts.size() == 2 && parts[1].strain < min_side * parts[0].strain) {
    parts[0].points.insert(parts[0].points.end(), parts[1].points.begin(), parts[1].points.end());
    parts.pop_back();
  }
  if (parts.size() == 1) parts[0].name = test.name;
  return parts;
}

std::array<double, 2> stretch_range(const std::vector<MaterialTest>& tests) {
  std::array<double, 2> range = {1.0, 1.0};
  for (const MaterialTest& test : tests) {
    if (test.kind == TestKind::volumetric) continue;
    for (const double deformation : test.all_deformations())
      for (const double stretch : principal_stretches(test.kind, deformation))
        range = {std::min(range[0], stretch), std::max(range[1], stretch)};
  }
  return range;
}

}  // namespace fingertip::calibration::inline material_tests
