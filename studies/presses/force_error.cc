#include "studies/presses/force_error.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::inline presses {
namespace {

using fem_reference::ReferenceJob;
using meshes::PressResponse;
using meshes::PressSample;

bool same_length(double a, double b) {
  constexpr double same = 1e-9;  // [m]
  return std::abs(a - b) <= same;
}

/// Relative error of the continuum between its samples around `depth`.
double relative_error_at(std::span<const PressSample> samples, double depth) {
  const auto after = std::ranges::lower_bound(samples, depth, {}, &PressSample::indentation);
  const auto relative = [](const PressSample& sample) {
    return sample.force_error / sample.normal_force;
  };
  if (after == samples.end()) return relative(samples.back());
  if (after == samples.begin() || same_length(after->indentation, depth)) return relative(*after);
  return std::max(relative(*after), relative(*(after - 1)));
}

}  // namespace

ErrorSource error_source(const LoadedConfig& loaded) {
  const Config& config = loaded.config;
  if (config.force_error == ForceErrorBy::nothing) return {};
  ReferenceJob reference = config.continuum();
  reference.analysis = fem_reference::Analysis::static_press;
  reference.write_fields = false;
  reference.estimate_error = true;
  const bool small = config.press.lattice.kinematics == lattice::Kinematics::small;
  if (!loaded.entries.at("reference.strain").given)
    reference.strain = small ? fem_reference::Strain::linear : fem_reference::Strain::finite;
  const auto unknown = [](const std::string& why) { return ErrorSource{{}, "not known: " + why}; };
  if (const auto broken = reference.violations(); !broken.empty())
    return unknown("the continuum refuses this press: " + broken.front().rule);
  if (!config.press.protocol.program.empty())
    return unknown("the continuum beside a press knows no program");
  if (config.force_error == ForceErrorBy::automatic) {
    const char* found = "; run.error = \"continuum\" finds it";
    if (!reference.axisymmetric()) return unknown(std::string("the continuum is a solid") + found);
    if (!reference.rubber.relaxation.empty())
      return unknown(std::string("the continuum of a rubber that relaxes takes many steps") +
                     found);
  }
  const bool linear = reference.strain == fem_reference::Strain::linear;
  return {reference,
          std::string("from the continuum at ") + (linear ? "small" : "large") + " strain"};
}

PressResponse with_force_error(const PressResponse& response, const PressResponse& continuum) {
  std::vector<PressSample> samples = response.samples();
  const auto pressed = continuum.pressing();
  const std::size_t loading = response.pressing().size();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    PressSample& sample = samples[i];
    sample.force_error = meshes::unknown;
    if (continuum.empty()) continue;
    if (i < loading) {
      const double depth = sample.indentation, first = pressed.front().indentation;
      if (same_length(depth, first) || (depth > first && depth <= continuum.depth()) ||
          same_length(depth, continuum.depth())) {
        const double force = continuum.normal_force_at(std::clamp(depth, first, continuum.depth()));
        sample.force_error =
            std::abs(sample.normal_force - force) + relative_error_at(pressed, depth) * force;
      }
    } else {
      const auto beside = std::ranges::find_if(continuum.sliding(), [&](const PressSample& other) {
        return same_length(other.lateral_displacement, sample.lateral_displacement);
      });
      if (beside != continuum.sliding().end())
        sample.force_error =
            std::abs(sample.normal_force - beside->normal_force) + beside->force_error;
    }
  }
  return PressResponse(std::move(samples));
}

}  // namespace fingertip::studies::inline presses
