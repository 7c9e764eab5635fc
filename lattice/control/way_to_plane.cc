#include "lattice/control/way_to_plane.h"

namespace fingertip::lattice::inline control {

WayToPlane::WayToPlane(const ControlTask& task)
    : start_(task.path(0.0)), toward_(-task.normal), period_(task.period) {}

double WayToPlane::position(const Measurement& m) const {
  return toward_.dot(m.pose.position - start_.pose.position);
}

double WayToPlane::velocity(const Measurement& m) const {
  return toward_.dot(m.twist.velocity);
}

double WayToPlane::force(const Measurement& m) const {
  return -toward_.dot(m.wrench.force);
}

Target WayToPlane::go_on(double speed) {
  speed_ = speed;
  Target target = start_;
  target.pose.position += reference_ * toward_;
  target.twist.velocity = speed_ * toward_;
  reference_ += period_ * speed_;
  return target;
}

Target WayToPlane::go_on(double speed, const Measurement& m, bool saturated) {
  const bool runs_away = saturated && speed * (reference_ - position(m)) > 0.0;
  return go_on(runs_away ? 0.0 : speed);
}

void WayToPlane::take_over(const Target& target) {
  speed_ = toward_.dot(target.twist.velocity);
  reference_ = toward_.dot(target.pose.position - start_.pose.position) + period_ * speed_;
}

}  // namespace fingertip::lattice::inline control
