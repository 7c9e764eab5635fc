#include "lattice/control/hybrid_controller.h"

#include <algorithm>
#include <cmath>

namespace fingertip::lattice {

using meshes::Vector3;

namespace {
constexpr double swinging = 0.010;     // of the tip, to fade by 1/e after an acceleration [s]
constexpr double speeding_up = 0.030;  // to the approach's speed, when it is resumed [s]
}  // namespace

HybridController::HybridController(const PidSettings& pid, const ForceSettings& settings,
                                   const ControlTask& task)
    : task_(task),
      settings_(settings),
      pid_(pid, task.inertia),
      loop_(settings, task, pid.natural_frequency),
      start_(task.path(0.0)) {
  check(settings, pid);
}

void HybridController::reset() {
  pid_.reset();
  loop_.reset();
  mode_ = ControlMode::position;
  switches_ = 0;
  changed_ = otherwise_ = inertial_ = reference_ = speed_ = 0.0;
}

ControllerReport HybridController::report() const {
  if (mode_ == ControlMode::position) return {};
  return {mode_, loop_.stiffness(), settings_.force};
}

double HybridController::touch_threshold(double time) {
  const double accelerating =
      switches_ == 0 ? task_.path(time).acceleration.velocity.dot(task_.normal) : 0.0;
  inertial_ = std::max(inertial_ * std::exp(-task_.period / swinging),
                       task_.inertia(0, 0) * std::abs(accelerating));
  return settings_.touch_force + inertial_;
}

void HybridController::choose_mode(const Measurement& m, double force) {
  const bool approaching = mode_ == ControlMode::position;
  const double threshold = touch_threshold(m.time);
  const bool may_touch = !m.contact || m.contact->touching > 0;
  const bool speaks =
      approaching ? may_touch && force > threshold : force < settings_.release_force;
  otherwise_ = speaks ? otherwise_ + task_.period : 0.0;
  const bool rested = approaching || m.time - changed_ >= settings_.dwell;
  if (!rested || !speaks || otherwise_ < settings_.confirmation) return;
  mode_ = approaching ? ControlMode::force : ControlMode::position;
  ++switches_;
  changed_ = m.time;
  otherwise_ = 0.0;
}

/// The task's way at first; later at a speed that grows again.
Target HybridController::approach(double time) {
  const Vector3 toward = -task_.normal;
  if (switches_ == 0) {
    Target target = task_.path(time);
    speed_ = toward.dot(target.twist.velocity);
    reference_ = toward.dot(target.pose.position - start_.pose.position) + task_.period * speed_;
    return target;
  }
  Target target = start_;
  speed_ = std::min(speed_ + task_.speed * task_.period / speeding_up, task_.speed);
  target.pose.position += reference_ * toward;
  target.twist.velocity = speed_ * toward;
  reference_ += task_.period * speed_;
  return target;
}

Command HybridController::command(const Measurement& m) {
  const Vector3 toward = -task_.normal;
  const double force = task_.normal.dot(m.wrench.force);
  choose_mode(m, force);
  const double position = toward.dot(m.pose.position - start_.pose.position);
  // The loop watches the approach, too, so that it knows where the force began to rise.
  const double wanted = loop_.speed(force, position, toward.dot(m.twist.velocity), speed_);
  if (mode_ == ControlMode::position) return pid_.follow(m, approach(m.time));
  const bool runs_away = pid_.saturated() && wanted * (reference_ - position) > 0.0;
  speed_ = runs_away ? 0.0 : wanted;
  Target target = start_;
  target.pose.position += reference_ * toward;
  target.twist.velocity = speed_ * toward;
  reference_ += task_.period * speed_;
  return pid_.follow(m, target);
}

}  // namespace fingertip::lattice
