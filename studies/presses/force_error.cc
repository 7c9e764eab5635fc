#include "studies/presses/force_error.h"

#include <algorithm>
#include <cmath>

#include "studies/presses/press_setup.h"

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
  const auto unknown = [](const std::string& why) { return ErrorSource{{}, "not known: " + why}; };
  ReferenceJob reference;
  try {
    reference = continuum_at_rest(loaded, loaded.entries.at("reference.strain").given
                                              ? config.reference.strain
                                              : strain_of(config.press.lattice.kinematics));
  } catch (const ConfigError& error) {
    return unknown("the continuum refuses this press: " + error.violations().front().rule);
  }
  reference.estimate_error = true;
  if (!config.press.protocol.program.empty())
    return unknown("the continuum beside a press knows no program");
  if (config.force_error == ForceErrorBy::automatic) {
    const std::string found = "; run.error = \"continuum\" finds it";
    if (!reference.axisymmetric()) return unknown("the continuum is a solid" + found);
    if (!reference.rubber.relaxation.empty())
      return unknown("the continuum of a rubber that relaxes takes many steps" + found);
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
      const double depth = sample.indentation,
                   known = std::clamp(depth, pressed.front().indentation, continuum.depth());
      if (!same_length(depth, known)) continue;
      const double force = continuum.normal_force_at(known);
      sample.force_error =
          std::abs(sample.normal_force - force) + relative_error_at(pressed, depth) * force;
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
