#include "studies/live/moving_set_point.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::inline live {

namespace {

constexpr double min_acceleration = 0.5;  // [m/s²]
constexpr double landing_periods = 3.0;
constexpr double negligible = 1e-10;  // [m]

}  // namespace

MovingSetPoint::MovingSetPoint(double speed, double goal, double clearance, double period)
    : speed_(speed), goal_(goal), clearance_(clearance), period_(period) {
  plan();
}

void MovingSetPoint::want(double speed, double goal) {
  speed_ = speed;
  goal_ = goal;
}

double MovingSetPoint::acceleration_limit() const {
  return std::max(min_acceleration, speed_ * speed_ / clearance_);
}

void MovingSetPoint::plan() {
  const double most = acceleration_limit(), landing = landing_periods * period_;
  // The speed chosen here is reached a period from now, and so much further on.
  const double remaining = goal_ - now_.distance - now_.speed * period_, way = std::abs(remaining);
  const double stopping = way < most * landing * landing
                              ? way / landing
                              : std::sqrt(most * (2.0 * way - most * landing * landing));
  const double wanted = std::copysign(std::min(speed_, stopping), remaining);
  now_.acceleration = std::clamp((wanted - now_.speed) / period_, -most, most);
}

void MovingSetPoint::advance() {
  now_.distance += (now_.speed + 0.5 * now_.acceleration * period_) * period_;
  now_.speed += now_.acceleration * period_;
  if (std::abs(goal_ - now_.distance) < negligible) {
    now_ = {goal_, 0.0, 0.0};
  } else {
    plan();
  }
}

void MovingSetPoint::restart(double distance) {
  now_ = {distance, 0.0, 0.0};
  plan();
}

}  // namespace fingertip::studies::inline live
