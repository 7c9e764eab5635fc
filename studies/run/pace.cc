#include "studies/run/pace.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies {

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
  constexpr int steps = 40;
  const double reached = std::min(response.depth(), reference.depth());
  if (!(reached >= to * (1.0 - 1e-6))) return meshes::unknown;
  double worst = 0.0;
  for (int i = 0; i <= steps; ++i) {
    const double depth = std::min(from + (to - from) * i / steps, reached);
    const double error = response.normal_force_at(depth) / reference.normal_force_at(depth) - 1.0;
    worst = std::max(worst, std::abs(error));
  }
  return worst;
}

}  // namespace fingertip::studies
