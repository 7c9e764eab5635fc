#include "fem_reference/press/press.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "fem_reference/job/processes.h"
#include "meshes/base/errors.h"
#include "meshes/press/no_equilibrium.h"

namespace fingertip::fem_reference::inline press {
namespace {

/// A step that does not converge is halved this often before giving up.
constexpr int max_halvings = 6;
/// What the steps of a known way may miss of the force where `tolerates_long_steps` is tolerated.
/// They and this are longer or shorter in proportion elsewhere, and double from mesh to mesh: what
/// they miss is how two ways differ, which halves.
constexpr double error_of_long_steps = 1.7e-3, tolerates_long_steps = 0.01, longest_share = 2.0;

double share_of_long_steps(const ReferenceJob& job) {
  return std::min(longest_share, job.tolerance / tolerates_long_steps);
}

}  // namespace

ContinuumPress::ContinuumPress(const ReferenceJob& job, std::function<bool()> stop_requested)
    : job_(job),
      course_(job.protocol, job.in_time()),
      stop_requested_(std::move(stop_requested)),
      // Where a node first touches is remembered: steps twice as long are off by up to 0.15 % where
      // no known way corrects them. Without friction only Newton's method asks for steps.
      steps_(frictionless() ? Steps{1.0, 1.0, 0.1} : Steps{0.1, 0.25, 0.01}) {}

double ContinuumPress::step_error(const ReferenceJob& job) {
  const bool sticks = job.protocol.contact == meshes::ContactMode::stick;
  return sticks && keeps_way(job) ? error_of_long_steps * share_of_long_steps(job) : 0.0;
}

bool ContinuumPress::keeps_way(const ReferenceJob& job) {
  return job.estimate_error && job.strain == Strain::finite && job.rubber.relaxation.empty() &&
         !job.axisymmetric();
}

ContinuumPress::Steps ContinuumPress::steps_to(double target) const {
  if (!keeps_way(job_) || job_.protocol.contact == meshes::ContactMode::coulomb) return steps_;
  const int meshes = meshes_before(target);
  constexpr double any = std::numeric_limits<double>::infinity();
  if (frictionless()) return meshes == 0 ? steps_ : Steps{1.0, 1.0, any};
  const double longer = std::ldexp(share_of_long_steps(job_), meshes);
  if (longer <= 1.0) return steps_;
  return {std::min(1.0, longer * steps_.first), longer * steps_.growth,
          meshes == 0 ? longer * steps_.longest : any};
}

double ContinuumPress::next_step(double target, double limit) const {
  if (one_step()) return target;
  const PressCourse::Leg& leg = course_.leg(target);
  const Steps steps = steps_to(target);
  const double longest = limit * steps.longest * job_.geometry.thickness();
  double step = std::min(longest, place_ > 0.0 ? limit * steps.growth * place_
                                               : limit * steps.first * std::min(target, longest));
  if (leg.rate > 1.0) step /= leg.rate;
  if (leg.rate == 0.0) step = target - place_;
  if (relaxes()) step = std::min(step, limit * steps.of_relaxing * (target - leg.begin));
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
    } catch (const meshes::Interrupted&) {
      abandon();
      throw;
    } catch (const meshes::NotConverged& error) {
      abandon();
      if (one_step() || limit < std::pow(0.5, max_halvings)) {
        throw meshes::NoEquilibrium("the continuum", course_.at(place_), error.what(),
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
