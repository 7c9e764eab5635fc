#include "lattice/control/hybrid_controller.h"

#include <algorithm>
#include <cmath>

namespace fingertip::lattice::inline control {

namespace {
constexpr double swinging = 0.010;     // of the tip, to fade by 1/e after an acceleration [s]
constexpr double speeding_up = 0.030;  // to the approach's speed, when it is resumed [s]
}  // namespace

HybridController::HybridController(const PidSettings& pid, const ForceSettings& settings,
                                   const ControlTask& task)
    : task_(task),
      pid_(pid, task.inertia),
      loop_(settings, task, pid.natural_frequency),
      way_(task) {
  check(settings, pid);
}

void HybridController::reset() {
  pid_.reset();
  loop_.reset();
  way_.reset();
  mode_ = ControlMode::position;
  switches_ = 0;
  changed_ = otherwise_ = inertial_ = 0.0;
}

ControllerReport HybridController::report() const {
  if (mode_ == ControlMode::position) return {};
  return {mode_, loop_.stiffness(), loop_.settings().force};
}

double HybridController::touch_threshold(double time) {
  const double accelerating =
      switches_ == 0 ? task_.path(time).acceleration.velocity.dot(task_.normal) : 0.0;
  inertial_ = std::max(inertial_ * std::exp(-task_.period / swinging),
                       task_.inertia(0, 0) * std::abs(accelerating));
  return loop_.settings().touch_force + inertial_;
}

void HybridController::choose_mode(const Measurement& m, double force) {
  const bool approaching = mode_ == ControlMode::position;
  const double threshold = touch_threshold(m.time);
  const bool may_touch = !m.contact || m.contact->touching > 0;
  const bool speaks =
      approaching ? may_touch && force > threshold : force < loop_.settings().release_force;
  otherwise_ = speaks ? otherwise_ + task_.period : 0.0;
  const bool rested = approaching || m.time - changed_ >= loop_.settings().dwell;
  if (!rested || !speaks || otherwise_ < loop_.settings().confirmation) return;
  mode_ = approaching ? ControlMode::force : ControlMode::position;
  ++switches_;
  changed_ = m.time;
  otherwise_ = 0.0;
}

/// The task's way at first; later at a speed that grows again.
Target HybridController::approach(double time) {
  if (switches_ == 0) {
    const Target target = task_.path(time);
    way_.take_over(target);
    return target;
  }
  return way_.go_on(std::min(way_.speed() + task_.speed * task_.period / speeding_up, task_.speed));
}

Command HybridController::command(const Measurement& m) {
  const double force = way_.force(m);
  choose_mode(m, force);
  // The loop watches the approach, too, so that it knows where the force began to rise.
  const double speed = loop_.speed(force, way_.position(m), way_.velocity(m), way_.speed());
  if (mode_ == ControlMode::position) return pid_.follow(m, approach(m.time));
  return pid_.follow(m, way_.go_on(speed, m, pid_.saturated()));
}

}  // namespace fingertip::lattice::inline control
