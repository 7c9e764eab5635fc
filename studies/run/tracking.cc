#include "studies/run/tracking.h"

#include <cmath>

namespace fingertip::studies {

namespace {

/// The larger one, where NaN means "none so far".
double larger(double so_far, double value) {
  return std::isnan(so_far) || value > so_far ? value : so_far;
}

/// The contact force at the end, where the controller holds one then.
void measure_force(const std::vector<lattice::TraceRow>& trace, Tracking& tracking) {
  if (trace.empty() || !trace.back().force_mode) return;
  double sum = 0.0, count = 0.0;
  for (const lattice::TraceRow& row : trace) {
    if (!row.force_mode) {
      sum = count = 0.0;
      continue;
    }
    if (row.wanted_force > 0.0)
      tracking.force_overshoot =
          larger(tracking.force_overshoot, row.normal_force / row.wanted_force - 1.0);
    if (row.time <= trace.back().time - holding_time) continue;
    sum += row.normal_force;
    count += 1.0;
  }
  tracking.held_force = sum / count;
  tracking.wanted_force = trace.back().wanted_force;
}

}  // namespace

Tracking measure_tracking(const std::vector<lattice::TraceRow>& trace, double first_touch) {
  Tracking tracking;
  for (const lattice::TraceRow& row : trace) {
    tracking.tilt = larger(tracking.tilt, std::abs(row.tilt));
    if (row.time < settling_time || row.commanded_speed == 0.0 || row.force_mode) continue;
    const double deviation =
        std::abs(row.speed - row.commanded_speed) / std::abs(row.commanded_speed);
    const bool touching = row.time >= first_touch && row.time < first_touch + touch_time;
    double& worst = touching ? tracking.speed_deviation_at_touch : tracking.speed_deviation;
    worst = larger(worst, deviation);
  }
  measure_force(trace, tracking);
  return tracking;
}

}  // namespace fingertip::studies
