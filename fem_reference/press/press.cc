#include "fem_reference/press/press.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "fem_reference/job/processes.h"
#include "meshes/base/errors.h"
#include "meshes/press/no_equilibrium.h"

namespace fingertip::fem_reference::inline press {
namespace {

/// A step that does not converge is halved this often before giving up.
constexpr int max_halvings = 6;

}  // namespace

ContinuumPress::ContinuumPress(const ReferenceJob& job, std::function<bool()> stop_requested)
    : job_(job),
      course_(job.protocol, job.in_time()),
      stop_requested_(std::move(stop_requested)),
      // Where a node first touches is remembered: at nu = 0.49 steps twice as long are off by
      // 0.15 %. Without friction only Newton's method asks for steps.
      steps_(frictionless() ? Steps{1.0, 1.0, 0.1} : Steps{0.1, 0.25, 0.01}) {}

double ContinuumPress::next_step(double target, double limit) const {
  if (one_step()) return target;
  const PressCourse::Leg& leg = course_.leg(target);
  const double longest = limit * steps_.longest * job_.geometry.thickness();
  double step = std::min(longest, place_ > 0.0 ? limit * steps_.growth * place_
                                               : limit * steps_.first * std::min(target, longest));
  if (leg.rate > 1.0) step /= leg.rate;
  if (leg.rate == 0.0) step = target - place_;
  if (relaxes()) step = std::min(step, limit * steps_.of_relaxing * (target - leg.begin));
  const double pieces = std::ceil((target - place_) / step - 1e-9);
  return pieces <= 1.0 ? target
                       : std::min(target, place_ + std::min(step, (target - place_) / pieces));
}

PressState ContinuumPress::advance(double place) {
  const auto start = std::chrono::steady_clock::now();
  PressEffort effort;
  double limit = 1.0;  // shrinks after a failure, recovers after successes
  while (place_ < place) {
    stop_if_asked(stop_requested_);
    try {
      const double next = next_step(place, limit);
      step(next, next == place, effort);
      ++effort.steps;
      limit = std::min(1.0, 1.5 * limit);
    } catch (const meshes::NotConverged& error) {
      abandon();
      if (one_step() || limit < std::pow(0.5, max_halvings)) {
        const meshes::PressPose pose = course_.at(place_);
        throw meshes::NoEquilibrium("the continuum", pose.indentation, pose.lateral, error.what(),
                                    "take another first mesh (reference.refinement)");
      }
      limit /= 2;
    }
  }
  PressState state = evaluate();
  static_cast<PressEffort&>(state) = effort;
  state.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return state;
}

}  // namespace fingertip::fem_reference::inline press
