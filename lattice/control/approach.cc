#include "lattice/control/approach.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::lattice {

namespace {
constexpr double longest_rise = 0.030;  // [s]
}

Approach::Approach(double speed, double clearance)
    : speed_(speed), rise_time_(std::min(longest_rise, clearance / speed)) {}

SetPoint Approach::at(double time) const {
  constexpr double tau = 2.0 * std::numbers::pi;
  if (time <= 0.0) return {};
  if (time >= rise_time_) return {speed_ * (time - 0.5 * rise_time_), speed_, 0.0};
  const double s = time / rise_time_;
  return {speed_ * rise_time_ * (0.5 * s * s + (std::cos(tau * s) - 1.0) / (tau * tau)),
          speed_ * (s - std::sin(tau * s) / tau), speed_ / rise_time_ * (1.0 - std::cos(tau * s))};
}

}  // namespace fingertip::lattice
