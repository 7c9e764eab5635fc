#include "calibration/material_tests/material_test.h"

#include <algorithm>
#include <cmath>

#include "meshes/files.h"

namespace fingertip::calibration {

using meshes::to_text;
using meshes::Violation;

namespace {

/// Beyond it a deformation is a mistake of units.
constexpr double most_stretch = 20.0;

bool right_length(std::size_t length, std::size_t points) {
  return length == 0 || length == points;
}

}  // namespace

std::string_view name(TestKind kind) {
  switch (kind) {
    case TestKind::uniaxial: return "uniaxial";
    case TestKind::equibiaxial: return "equibiaxial";
    case TestKind::planar: return "planar";
    case TestKind::simple_shear: return "simple-shear";
    case TestKind::volumetric: return "volumetric";
  }
  return "unknown";
}

std::string_view name(StressMeasure measure) {
  return measure == StressMeasure::nominal ? "nominal" : "true";
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
    if (value > 0.0 && value <= most_stretch && (i == 0 || value > deformation[i - 1])) continue;
    refuse("deformation", to_text(value),
           "must be positive, at most 20 and increase from point to point",
           "sort the points, and look at the definition of strain and its unit");
    break;
  }
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
  if (rate && !positive(*rate))
    refuse("rate", to_text(*rate), "a rate must be positive", "leave it out where it is unknown");
  return found;
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

std::array<double, 2> stretch_range(const std::vector<MaterialTest>& tests) {
  std::array<double, 2> range = {1.0, 1.0};
  for (const MaterialTest& test : tests) {
    if (test.kind == TestKind::volumetric) continue;
    for (const double deformation : test.deformation)
      for (const double stretch : principal_stretches(test.kind, deformation))
        range = {std::min(range[0], stretch), std::max(range[1], stretch)};
  }
  return range;
}

}  // namespace fingertip::calibration
