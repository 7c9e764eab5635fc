#include "studies/presses/pace.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::inline presses {

Pace slowest_pace(const lattice::PressOutcome& outcome, double window) {
  const auto& trace = outcome.trace;
  Pace slowest;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < trace.size(); ++begin) {
    if (!(trace[begin].time >= outcome.first_touch_time)) continue;
    const double until = trace[begin].time + window * (1.0 - 1e-9);
    while (end < trace.size() && trace[end].time < until) ++end;
    if (end == trace.size()) break;
    const double simulated = trace[end].time - trace[begin].time;
    const lattice::ElapsedTime &from = outcome.elapsed[begin], &to = outcome.elapsed[end];
    slowest.wall = std::fmin(slowest.wall, simulated / (to.wall - from.wall));
    slowest.processor = std::fmin(slowest.processor, simulated / (to.processor - from.processor));
  }
  return slowest;
}

double worst_force_error(const meshes::PressResponse& response,
                         const meshes::PressResponse& reference, double from, double to) {
  constexpr double slack = 1e-6;
  const double reached = std::min(response.depth(), reference.depth());
  if (!(reached >= to * (1.0 - slack))) return meshes::unknown;
  double worst = meshes::unknown;
  for (const meshes::PressSample& sample : response.pressing()) {
    const double depth = sample.indentation;
    if (depth < from * (1.0 - slack) || depth > to * (1.0 + slack)) continue;
    const double wanted = reference.normal_force_at(std::min(depth, reference.depth()));
    worst = std::fmax(worst, std::abs(sample.normal_force / wanted - 1.0));
  }
  return worst;
}

}  // namespace fingertip::studies::inline presses
