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

ErrorSource estimated_source(lattice::ModelKind model, const std::string& why) {
  if (model == lattice::ModelKind::published)
    return {{}, false, "not known: " + why + ", and the published model has no estimate"};
  return {{}, true, "estimated" + (why.empty() ? why : ", for " + why)};
}

ErrorSource error_source(const LoadedConfig& loaded) {
  const Config& config = loaded.config;
  const ForceErrorBy by = config.force_error;
  if (by == ForceErrorBy::nothing) return {};
  const auto estimated = [&](const std::string& why) {
    return estimated_source(config.press.lattice.model, why);
  };
  if (by == ForceErrorBy::estimate)
    return estimated(config.press.lattice.model == lattice::ModelKind::published
                         ? "the continuum is not asked"
                         : "");
  ReferenceJob reference;
  try {
    reference = continuum_at_rest(loaded, loaded.entries.at("reference.strain").given
                                              ? config.reference.strain
                                              : strain_of(config.press.lattice.kinematics));
  } catch (const ConfigError& error) {
    return estimated("the continuum refuses this press (" + error.violations().front().rule + ")");
  }
  reference.estimate_error = true;
  if (!config.press.protocol.program.empty())
    return estimated("the continuum beside a press knows no program");
  if (by == ForceErrorBy::automatic) {
    const std::string found = " (run.error = \"continuum\" presses it)";
    if (!reference.axisymmetric()) return estimated("the continuum is a solid" + found);
    if (!reference.rubber.relaxation.empty())
      return estimated("the continuum of a rubber that relaxes takes many steps" + found);
  }
  const bool linear = reference.strain == fem_reference::Strain::linear;
  return {reference, false,
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

PressResponse with_estimated_error(const PressResponse& response,
                                   const lattice::ForceEstimator& estimator) {
  std::vector<PressSample> samples = response.samples();
  for (PressSample& sample : samples) {
    const auto estimate = estimator.of(sample);
    sample.force_error = estimate ? estimate->sum() * sample.normal_force : meshes::unknown;
  }
  return PressResponse(std::move(samples));
}

}  // namespace fingertip::studies::inline presses
