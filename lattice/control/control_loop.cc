#include "lattice/control/control_loop.h"

#include <algorithm>
#include <utility>

namespace fingertip::lattice::inline control {

ControlLoop::ControlLoop(VirtualFinger& finger, Controller& controller,
                         const HardwareSettings& hardware, const PidSettings& servo, double period)
    : finger_(&finger),
      controller_(&controller),
      hardware_(hardware, servo.force_limit, servo.torque_limit),
      servo_(servo, finger.rod_body().inertia_at_endpoint()),
      period_(period) {}

void ControlLoop::reset() {
  finger_->reset();
  controller_->reset();
  hardware_.reset();
  servo_.reset();
  cycle_ = next_reading_ = 0;
  is_measured_ = false;
  readings_.clear();
  pending_.clear();
  measured_ = {};
  commanded_ = applied_ = {};
}

/// Those due by now; the first ones, which would lie before the start, are taken at the start.
void ControlLoop::take_measurements(double now) {
  const double latency = hardware_.settings().sensor_latency;
  while (double(next_reading_) * period_ - latency <= now + 1e-9 * period_) {
    readings_.push_back(hardware_.sense(finger_->read()));
    ++next_reading_;
  }
}

const Measurement& ControlLoop::measure() {
  if (std::exchange(is_measured_, true)) return measured_;
  take_measurements(finger_->time());
  measured_ = readings_.front();
  readings_.pop_front();
  return measured_;
}

void ControlLoop::command(const Command& command) {
  if (!std::visit([](const auto& value) { return finite(value); }, command)) {
    throw ControllerFailed("the controller commanded what is not a finite number");
  }
  if (const Target* target = std::get_if<Target>(&command)) {
    commanded_ = servo_.follow(measured_, *target);
  } else {
    commanded_ = std::get<Wrench>(command);
  }
  const double now = double(cycle_) * period_;
  pending_.push_back(
      {now + hardware_.settings().actuator_latency, hardware_.act(commanded_, period_)});
  ++cycle_;
  is_measured_ = false;
}

/// Passes through the moments at which a command begins to act or a measurement is taken.
bool ControlLoop::wait_until(double time, const VirtualFinger::StepObserver& after_step) {
  const double negligible = 1e-9 * period_;
  const double latency = hardware_.settings().sensor_latency;
  while (true) {
    const double now = finger_->time();
    while (!pending_.empty() && pending_.front().time <= now + negligible) {
      applied_ = pending_.front().wrench;
      finger_->write(applied_);
      pending_.pop_front();
    }
    if (latency > 0.0) take_measurements(now);
    if (now >= time - negligible) return true;
    double next = time;
    if (!pending_.empty()) next = std::min(next, pending_.front().time);
    if (latency > 0.0) next = std::min(next, double(next_reading_) * period_ - latency);
    if (!finger_->do_step(next - now, after_step)) return false;
  }
}

bool ControlLoop::advance(const VirtualFinger::StepObserver& after_step) {
  return wait_until(double(cycle_) * period_, after_step);
}

}  // namespace fingertip::lattice::inline control
