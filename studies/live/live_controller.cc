#include "studies/live/live_controller.h"

namespace fingertip::studies::inline live {

using lattice::Command;
using lattice::Target;
using lattice::Wrench;

LiveController::LiveController(std::unique_ptr<lattice::Controller> inner,
                               const lattice::ControlTask& task, const lattice::PidSettings& servo)
    : inner_(std::move(inner)),
      force_loop_(dynamic_cast<lattice::HoldsForce*>(inner_.get())),
      task_(task),
      servo_settings_(servo),
      servo_(servo, task.inertia),
      hand_(task.inertia) {}

Command LiveController::command(const lattice::Measurement& measurement) {
  Wrench wrench;
  if (on_) {
    const Command order =
        inner_ ? inner_->command(measurement) : Command(task_.path(measurement.time));
    const Target* target = std::get_if<Target>(&order);
    wrench = target ? servo_.follow(measurement, *target) : std::get<Wrench>(order);
  }
  const Wrench pull = hand_.wrench(measurement);
  return Wrench{wrench.force + pull.force, wrench.torque + pull.torque};
}

void LiveController::reset() {
  if (inner_) inner_->reset();
  servo_.reset();
  hand_.release();
}

void LiveController::switch_on(bool on) {
  if (on && !on_) {
    if (inner_) inner_->reset();
    servo_.reset();
  }
  on_ = on;
}

void LiveController::set_servo(const lattice::PidSettings& settings) {
  servo_settings_ = settings;
  servo_.set_settings(settings);
}

}  // namespace fingertip::studies::inline live
