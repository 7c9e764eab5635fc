#include "fem_reference/press/force_error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <vector>

namespace fingertip::fem_reference::inline press {
namespace {

constexpr double assumed_order = 1.5;
constexpr double safety_of_three = 1.25, safety_of_two = 3.0;
constexpr double highest_order = 20.0;

void require_refinement(std::span<const MeshForce> sequence) {
  double before = 0.0;
  for (const MeshForce& mesh : sequence) {
    if (!(mesh.unknowns > before))
      throw std::invalid_argument("the unknowns of a mesh sequence must be positive and increase");
    before = mesh.unknowns;
  }
}

/// h_coarse / h_fine
double refinement_ratio(const MeshForce& coarse, const MeshForce& fine) {
  return std::cbrt(fine.unknowns / coarse.unknowns);
}

/// p with (F3 - F2)/(F2 - F1) = (1 - s^-p)/(r^p - 1), where r = h1/h2, s = h2/h3. The right side
/// falls from ln s/ln r at p = 0 to zero, so bisection finds the only one.
double observed_order(double ratio, double r, double s) {
  double low = 0.0, high = highest_order;
  for (int i = 0; i < 60; ++i) {
    const double p = (low + high) / 2;
    (-std::expm1(-p * std::log(s)) > ratio * std::expm1(p * std::log(r)) ? low : high) = p;
  }
  return high;
}

/// Fills in convergence and order from three meshes.
void classify(std::span<const MeshForce> meshes, ForceError& error) {
  const double first = meshes[1].force - meshes[0].force;
  const double second = meshes[2].force - meshes[1].force;
  if (first == 0.0 && second == 0.0) return;
  error.convergence = MeshConvergence::irregular;
  if (first == 0.0 || second == 0.0) return;
  const double r = refinement_ratio(meshes[0], meshes[1]);
  const double s = refinement_ratio(meshes[1], meshes[2]);
  const double ratio = second / first;
  if (std::abs(ratio) >= std::log(s) / std::log(r)) return;
  error.convergence = ratio > 0.0 ? MeshConvergence::monotone : MeshConvergence::oscillatory;
  if (ratio > 0.0) error.order = observed_order(ratio, r, s);
}

}  // namespace

ForceError estimate_force_error(std::span<const MeshForce> sequence) {
  require_refinement(sequence);
  ForceError error;
  if (sequence.empty() || !std::isfinite(sequence.back().force)) return error;
  std::vector<MeshForce> known;
  for (const MeshForce& mesh : sequence)
    if (std::isfinite(mesh.force)) known.push_back(mesh);
  const std::size_t count = std::min<std::size_t>(3, known.size());
  const std::span<const MeshForce> meshes = std::span<const MeshForce>(known).last(count);
  if (count < 2) return error;

  double extrapolated = 0.0;
  for (const MeshForce& coarse : meshes.first(count - 1)) {
    const double decay = std::pow(refinement_ratio(coarse, meshes.back()), assumed_order);
    const double difference = std::abs(meshes.back().force - coarse.force);
    extrapolated = std::max(extrapolated, difference / (decay - 1.0));
  }
  error.value = (count == 3 ? safety_of_three : safety_of_two) * extrapolated;
  if (count == 3) classify(meshes, error);
  return error;
}

}  // namespace fingertip::fem_reference::inline press
