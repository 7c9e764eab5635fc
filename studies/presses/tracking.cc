#include "studies/presses/tracking.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::studies::inline presses {

namespace {

/// The larger one, where NaN means "none so far".
double larger(double so_far, double value) {
  return std::isnan(so_far) || value > so_far ? value : so_far;
}

void measure_held_force(const std::vector<lattice::TraceRow>& trace, TrackingEntry& tracking) {
  if (trace.empty() || !trace.back().force_mode) return;
  tracking.wanted_force = trace.back().wanted_force;
  double sum = 0.0;
  int rows = 0;
  for (auto row = trace.rbegin(); row != trace.rend(); ++row) {
    if (!row->force_mode || row->time < trace.back().time - held_time) break;
    sum += row->normal_force;
    ++rows;
    if (row->wanted_force > 0.0)
      tracking.force_deviation =
          larger(tracking.force_deviation,
                 std::abs(row->normal_force - row->wanted_force) / row->wanted_force);
  }
  tracking.held_force = sum / rows;
}

}  // namespace

TrackingEntry measure_tracking(const std::vector<lattice::TraceRow>& trace, double first_touch) {
  TrackingEntry tracking;
  // Of a press without stages the commanded speed of every row that counts.
  double fastest = 0.0;
  for (const lattice::TraceRow& row : trace)
    fastest = std::max(fastest, std::abs(row.commanded_speed));
  for (const lattice::TraceRow& row : trace) {
    tracking.tilt_deg = larger(tracking.tilt_deg, std::abs(row.tilt) * 180.0 / std::numbers::pi);
    if (row.time < settling_time || fastest == 0.0 || row.force_mode) continue;
    const double deviation = std::abs(row.speed - row.commanded_speed) / fastest;
    const bool touching = row.time >= first_touch && row.time < first_touch + touch_time;
    double& worst = touching ? tracking.speed_deviation_at_touch : tracking.speed_deviation;
    worst = larger(worst, deviation);
  }
  measure_held_force(trace, tracking);
  return tracking;
}

}  // namespace fingertip::studies::inline presses
