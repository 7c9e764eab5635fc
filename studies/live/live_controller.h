/// The controller of the live view: the configured one, or none, and the hand.
#pragma once

#include <memory>

#include "lattice/control/force_controller.h"
#include "lattice/control/task.h"
#include "studies/live/hand.h"

namespace fingertip::studies::inline live {

/// Commands what the configured controller does (set points go through a servo whose gains may
/// change), plus the hand's wrench. The built-in PID is the servo on the way of the press.
class LiveController final : public lattice::Controller {
 public:
  /// `inner` may be null: the built-in PID.
  LiveController(std::unique_ptr<lattice::Controller> inner, const lattice::ControlTask& task,
                 const lattice::PidSettings& servo);

  lattice::Command command(const lattice::Measurement& measurement) override;
  /// Forgets what it has seen and lets go of the rod.
  void reset() override;

  /// Whether the controller acts; without it the rod is free, but for the hand. Switched on again
  /// it starts as from its first sample.
  void switch_on(bool on);
  bool on() const { return on_; }
  const lattice::PidSettings& servo() const { return servo_settings_; }
  void set_servo(const lattice::PidSettings& settings);
  /// What holds a contact force, or null.
  lattice::HoldsForce* force_loop() const { return force_loop_; }
  Hand& hand() { return hand_; }
  const Hand& hand() const { return hand_; }

 private:
  std::unique_ptr<lattice::Controller> inner_;
  lattice::HoldsForce* force_loop_;  ///< of inner_
  lattice::ControlTask task_;
  lattice::PidSettings servo_settings_;
  lattice::Pid servo_;
  Hand hand_;
  bool on_ = true;
};

}  // namespace fingertip::studies::inline live
