#include "studies/cases/force_comparison.h"

#include <algorithm>
#include <cmath>

#include "studies/presses/program_summary.h"
#include "studies/report/results/comparison_data.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::inline cases {

using meshes::PressResponse;

namespace {

/// What followed the first loading.
void compare_later(const PressResponse& response, const PressResponse& reference,
                   ForceComparison& result) {
  if (reference.following().empty() || response.empty() ||
      !report::same_stages(response, reference))
    return;
  const double most =
      std::ranges::max(reference.samples(), {}, &meshes::PressSample::normal_force).normal_force;
  for (std::size_t i = 0; i < reference.following().size(); ++i) {
    const meshes::PressSample& wanted = reference.following()[i];
    const double force = response.following()[i].normal_force;
    result.later.push_back({wanted.stage, response.following()[i].time, wanted.indentation, force,
                            wanted.normal_force, (force - wanted.normal_force) / most});
  }
  result.loop_error = work_along(response) / work_along(reference) - 1.0;
}

}  // namespace

double larger(double a, double b) {
  return std::isnan(a) || std::isnan(b) ? meshes::unknown : std::max(a, b);
}

double largest(const std::vector<double>& values) {
  double result = values.empty() ? meshes::unknown : 0.0;
  for (const double value : values) result = larger(result, std::abs(value));
  return result;
}

ForceComparison compare_forces(const PressResponse& response, const PressResponse& reference,
                               const std::vector<double>& depths) {
  ForceComparison result;
  result.depth = depths;
  for (const double depth : depths) {
    const double force = report::force_at(response, depth);
    const double wanted = report::force_at(reference, depth);
    result.force.push_back(force);
    result.reference_force.push_back(wanted);
    result.reference_error.push_back(reference.relative_error_at(depth));
    result.error.push_back(force / wanted - 1.0);
  }
  const double reached =
      response.empty() || reference.empty() ? 0.0 : std::min(response.depth(), reference.depth());
  if (reached > 0.0) result.l2_error = relative_l2_force_error(response, reference, 0.0, reached);
  compare_later(response, reference, result);
  return result;
}

std::vector<double> verdict_depths(double depth) {
  return {depth / 6.0, depth / 3.0, depth / 2.0, depth * 2.0 / 3.0, depth};
}

PressResponse response_in(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "response.csv";
  return std::filesystem::exists(file) ? PressResponse::read_csv(file) : PressResponse();
}

}  // namespace fingertip::studies::inline cases
