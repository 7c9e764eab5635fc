#include "lattice/control/force_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "meshes/base/files.h"

namespace fingertip::lattice::inline control {

namespace {

constexpr double full_turn = 2.0 * std::numbers::pi;
constexpr double filter_over_bandwidth = 8.0;

EstimatorLimits limits_of(const ForceSettings& settings, const ControlTask& task, double servo) {
  const double omega = full_turn * servo, mass = task.inertia(0, 0);
  // A fiftieth of the touch force: what counts as noise, and a third of the loop's time to forget.
  const double stiff = mass * omega * omega;
  return {100.0 * stiff, stiff, 3.0 * mass * omega, 0.02 * settings.touch_force,
          1.0 / (3.0 * full_turn * settings.bandwidth)};
}

}  // namespace

void check(const ForceSettings& settings, const PidSettings& servo) {
  auto broken = settings.violations();
  if (broken.empty() && settings.bandwidth > 0.1 * servo.natural_frequency) {
    broken.push_back({"controller.force_bandwidth", meshes::to_text(settings.bandwidth) + " Hz",
                      "must not exceed a tenth of controller.natural_frequency, or the servo does "
                      "not follow",
                      "lower it"});
  }
  if (!broken.empty()) throw meshes::InvalidInput(broken);
}

ForceLoop::ForceLoop(const ForceSettings& settings, const ControlTask& task, double servo)
    : settings_(settings),
      task_(task),
      omega_(full_turn * settings.bandwidth),
      acceleration_(0.25 * full_turn * servo * task.speed),
      estimator_(limits_of(settings, task, servo), task.period) {}

void ForceLoop::reset() {
  estimator_.reset();
  filtered_.reset();
  before_.reset();
  touch_.reset();
  stiffness_ = 0.0;
}

double ForceLoop::stiffness_at(double force, double position, double velocity) {
  if (settings_.stiffness) {
    return std::max(settings_.stiffness(std::max(position - task_.clearance, 0.0)), 0.0);
  }
  if (force < settings_.release_force) {
    touch_ = position;
    estimator_.reset();
    before_.reset();
    return 0.0;
  }
  if (!touch_) touch_ = position;
  const Reading now{force, position, velocity};
  if (before_) {
    estimator_.update(position - before_->position, velocity - before_->velocity,
                      force - before_->force);
  }
  before_ = now;
  const double way = position - *touch_;
  const double chord = way > 0.0 ? (force - settings_.release_force) / way : 0.0;
  return std::max(chord, estimator_.stiffness());
}

double ForceLoop::speed(double force, double position, double velocity, double speed_so_far) {
  const double cut = filter_over_bandwidth * omega_;
  if (!filtered_) filtered_ = force;
  *filtered_ += (1.0 - std::exp(-cut * task_.period)) * (force - *filtered_);
  stiffness_ = stiffness_at(force, position, velocity);
  const double wanted =
      omega_ * (1.0 - 1.0 / filter_over_bandwidth) * (settings_.force - *filtered_);
  const double most = std::min(task_.speed, std::abs(speed_so_far) + acceleration_ * task_.period);
  // Without stiffness there is no contact yet: as fast as allowed.
  if (std::abs(wanted) >= most * stiffness_) return std::copysign(most, wanted);
  return wanted / stiffness_;
}

ForceController::ForceController(const PidSettings& pid, const ForceSettings& settings,
                                 const ControlTask& task)
    : pid_(pid, task.inertia), loop_(settings, task, pid.natural_frequency), way_(task) {
  check(settings, pid);
}

void ForceController::reset() {
  pid_.reset();
  loop_.reset();
  way_.reset();
}

ControllerReport ForceController::report() const {
  return {ControlMode::force, loop_.stiffness(), loop_.settings().force};
}

Command ForceController::command(const Measurement& m) {
  const double speed = loop_.speed(way_.force(m), way_.position(m), way_.velocity(m), way_.speed());
  return pid_.follow(m, way_.go_on(speed, m, pid_.saturated()));
}

}  // namespace fingertip::lattice::inline control
