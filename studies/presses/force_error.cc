#include "studies/presses/force_error.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <memory>
#include <utility>

#include "meshes/cells/cubic_grid.h"
#include "studies/config/finger_defaults.h"
#include "studies/files/places.h"
#include "studies/files/shown_units.h"
#include "studies/presses/press_setup.h"
#include "studies/presses/reference_job.h"

namespace fingertip::studies::inline presses {
namespace {

using fem_reference::ReferenceJob;
using meshes::PressResponse;
using meshes::PressSample;

bool same_length(double a, double b) {
  constexpr double same = 1e-9;  // [m]
  return std::abs(a - b) <= same;
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
  const bool at_rest = config.press.protocol.mode == meshes::DriveMode::equilibrium &&
                       reference.rubber.relaxation.empty();
  if (!config.press.protocol.program.empty() && !at_rest)
    return estimated("the continuum beside a press knows no program in time");
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

ErrorSource source_at_hand(const LoadedConfig& loaded, const Cache& cache) {
  ErrorSource source = error_source(loaded);
  if (source.continuum && loaded.config.force_error == ForceErrorBy::automatic &&
      !std::filesystem::exists(reference_program()) &&
      !cache.keeps(reference_job(*source.continuum)))
    return estimated_source(loaded.config.press.lattice.model,
                            "the continuum is not built (`./fingertip reference` does it)");
  return source;
}

PressResponse pressed(const ReferenceJob& reference, const Cache& cache,
                      const std::function<bool()>& stop) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("fingertip-continuum-" + std::to_string(::getpid()));
  const auto remove = [&folder](void*) {
    std::error_code ignored;
    fs::remove_all(folder, ignored);
  };
  const std::shared_ptr<void> afterwards(nullptr, remove);
  const Job job = reference_job(reference);
  if (!cache.fetch(job, folder)) {
    const auto start = std::chrono::steady_clock::now();
    fs::create_directories(folder);
    job.run(folder,
            {[&](double, const std::string&) { return !stop(); }, [](const std::string&) {}});
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    mark(job, folder, finished, wall.count());
    cache.store(job, folder);
  }
  return PressResponse::read_csv(folder / "response.csv");
}

std::string error_words(const ForceErrorEntry& entry) {
  const std::string words = "force error " + entry.statement;
  if (std::isnan(entry.largest)) return words;
  return fmt::format("{}: at most {:.3g} %, at {}", words, 100.0 * entry.largest,
                     shown_units().length.text(entry.indentation));
}

namespace {

/// What makes the largest part of an error at `depth` [m] smaller than the tolerance.
std::string remedy(const Config& config, const lattice::ForceEstimator& estimator, double depth) {
  const lattice::ForceEstimate estimate = *estimator.at(depth);
  if (estimate.model > std::max(estimate.grid(), estimate.motion))
    return "lattice.model = hookean has no error of the model";
  if (estimate.motion > estimate.grid())
    return "press.mode = static or a smaller press.speed takes that of the motion away";
  const double spacing = estimator.spacing_for(depth, config.spacing_tolerance);
  if (!(spacing > 0.0)) return "no spacing keeps it there";
  const double radius = config.press.geometry.tip_radius, divisor = std::ceil(radius / spacing);
  return fmt::format(
      "lattice.spacing = tip_radius/{:.0f} keeps it there, too, by some {:.2g} masses", divisor,
      meshes::expected_particle_count(config.press.geometry, radius / divisor));
}

}  // namespace

std::string beyond_tolerance(const LoadedConfig& loaded, const ForceErrorEntry& entry) {
  const Config& config = loaded.config;
  if (!config.automatic_spacing || !(entry.largest > config.spacing_tolerance)) return "";
  const lattice::ForceEstimator estimator(config.press);
  if (!estimator.at(entry.indentation)) return "";
  const double from = first_kept_depth(loaded);
  const std::string kept = entry.indentation < from ? fmt::format(", which is kept from {} on",
                                                                  shown_units().length.text(from))
                                                    : "";
  return fmt::format("more than lattice.tolerance = {:.3g} %{}: {}",
                     100.0 * config.spacing_tolerance, kept,
                     remedy(config, estimator, entry.indentation));
}

namespace {

/// How far the sample is off another one, and that one's own errors.
void put_errors(PressSample& sample, const PressSample& truth) {
  sample.set_errors(truth.force_error / std::abs(truth.normal_force));
  const auto own = [](double told, double otherwise) {
    return std::isnan(told) ? otherwise : told;
  };
  sample.force_error = truth.force_error + std::abs(sample.normal_force - truth.normal_force);
  sample.lateral_force_error = own(truth.lateral_force_error, sample.lateral_force_error) +
                               (sample.force() - truth.force()).head<2>().norm();
  sample.torque_error =
      own(truth.torque_error, sample.torque_error) + (sample.torque() - truth.torque()).norm();
  const auto put = [&](double PressSample::*error, double PressSample::*value) {
    sample.*error = truth.*error + std::abs(sample.*value - truth.*value);
  };
  put(&PressSample::contact_radius_error, &PressSample::contact_radius);
  put(&PressSample::contact_area_error, &PressSample::contact_area);
  put(&PressSample::max_pressure_error, &PressSample::max_pressure);
}

/// The continuum's sample where the `i`-th of a lattice is; null without one.
const PressSample* sample_beside(const PressResponse& response, std::size_t i,
                                 const PressResponse& continuum) {
  const std::size_t loading = response.pressing().size(), pressed = continuum.pressing().size();
  const std::span all(continuum.samples());
  const auto among = i < loading ? all.first(pressed) : all.subspan(pressed);
  const PressSample& sample = response.samples()[i];
  const auto beside = std::ranges::find_if(among, [&](const PressSample& other) {
    return i < loading ? same_length(other.indentation, sample.indentation)
                       : other.is_beside(sample);
  });
  return beside == among.end() ? nullptr : &*beside;
}

}  // namespace

PressResponse with_force_error(const PressResponse& response, const PressResponse& continuum) {
  std::vector<PressSample> samples = response.samples();
  const auto pressed = continuum.pressing();
  const std::size_t loading = response.pressing().size();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    PressSample& sample = samples[i];
    sample.set_errors(meshes::unknown);
    if (continuum.empty()) continue;
    if (const PressSample* beside = sample_beside(response, i, continuum)) {
      put_errors(sample, *beside);
    } else if (i < loading && sample.indentation > pressed.front().indentation &&
               sample.indentation < continuum.depth()) {
      const double force = continuum.normal_force_at(sample.indentation);
      sample.force_error = std::abs(sample.normal_force - force) +
                           continuum.relative_error_at(sample.indentation) * force;
    }
  }
  return PressResponse(std::move(samples));
}

PressResponse with_pressure_error(const PressResponse& response,
                                  const lattice::ForceEstimator& estimator) {
  std::vector<PressSample> samples = response.samples();
  for (PressSample& sample : samples) {
    const auto estimate = estimator.of(sample);
    sample.set_pressure_error(estimate ? estimate->profile : meshes::unknown);
  }
  return PressResponse(std::move(samples));
}

PressResponse with_estimated_error(const PressResponse& response,
                                   const lattice::ForceEstimator& estimator) {
  std::vector<PressSample> samples = response.samples();
  for (PressSample& sample : samples) {
    const auto estimate = estimator.of(sample);
    sample.set_errors(estimate ? estimator.errors(sample, *estimate) : meshes::RelativeErrors());
  }
  return with_pressure_error(PressResponse(std::move(samples)), estimator);
}

std::vector<meshes::MarkerRow> with_estimated_error(std::vector<meshes::MarkerRow> markers,
                                                    const PressResponse& response,
                                                    const lattice::ForceEstimator& estimator) {
  for (meshes::MarkerRow& row : markers)
    row.error =
        estimator.displacement_error(response.samples().at(std::size_t(row.sample - 1)), row);
  return markers;
}

std::vector<meshes::MarkerRow> with_marker_error(std::vector<meshes::MarkerRow> markers,
                                                 const PressResponse& response,
                                                 const std::vector<meshes::MarkerRow>& of_continuum,
                                                 const PressResponse& continuum) {
  std::map<std::pair<int, int>, const meshes::MarkerRow*> known;
  for (const meshes::MarkerRow& row : of_continuum) known[{row.sample, row.marker}] = &row;
  for (meshes::MarkerRow& row : markers) {
    row.error = meshes::unknown;
    if (continuum.empty()) continue;
    const PressSample* beside = sample_beside(response, std::size_t(row.sample - 1), continuum);
    if (!beside) continue;
    const auto found = known.find({int(beside - continuum.samples().data()) + 1, row.marker});
    if (found == known.end()) continue;
    const meshes::MarkerRow& truth = *found->second;
    row.error = truth.error + (row.displacement - truth.displacement).norm();
  }
  return markers;
}

}  // namespace fingertip::studies::inline presses
