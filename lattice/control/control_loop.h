/// A controller and a finger in lock step.
#pragma once

#include <deque>
#include <functional>

#include "lattice/control/controller.h"
#include "lattice/control/hardware.h"
#include "lattice/control/pid.h"
#include "lattice/control/virtual_finger.h"

namespace fingertip::lattice::inline control {

/// Runs the cycle of a robot's controller with a fixed period: at t_k = k T the controller gets the
/// measurement that was taken at t_k - sensor_latency, and its command, held until the next, acts
/// from t_k + actuator_latency on, after the actuators' limits. A command that is a set point goes
/// through the built-in servo (Pid) first.
class ControlLoop {
 public:
  /// Finger and controller must outlive the loop. `period` [s] > 0; `servo` tells the actuators'
  /// limits, too.
  ControlLoop(VirtualFinger& finger, Controller& controller, const HardwareSettings& hardware,
              const PidSettings& servo, double period);

  /// Asks the controller for its next command. Throws ControllerFailed when it has none, or one
  /// that is no number.
  void sample() { command(controller_->command(measure())); }
  /// The two halves of sample(), for whoever commands in the controller's place: what is measured
  /// in this cycle, taken once, and its command.
  const Measurement& measure();
  void command(const Command& command);
  /// Lets the finger go on for a period; returns whether it did, or `after_step` said stop.
  bool advance(const VirtualFinger::StepObserver& after_step = {});

  double period() const { return period_; }
  const Measurement& measured() const { return measured_; }  ///< what the controller saw last
  const Wrench& commanded() const { return commanded_; }  ///< by controller or servo, before limits
  const Wrench& applied() const { return applied_; }      ///< what acts at the moment
  Pid& servo() { return servo_; }
  /// Finger, controller, servo and hardware as in the beginning.
  void reset();
  /// Goes on with another finger, which has taken over (VirtualFinger).
  void go_on_with(VirtualFinger& finger) { finger_ = &finger; }

 private:
  void take_measurements(double now);
  bool wait_until(double time, const VirtualFinger::StepObserver& after_step);
  struct Pending {
    double time = 0.0;  ///< when it acts [s]
    Wrench wrench;
  };

  VirtualFinger* finger_;
  Controller* controller_;
  Hardware hardware_;
  Pid servo_;
  double period_;
  long cycle_ = 0;                    ///< number of the next sample
  long next_reading_ = 0;             ///< number of the next measurement to take
  bool is_measured_ = false;          ///< in this cycle
  std::deque<Measurement> readings_;  ///< taken, not yet due
  std::deque<Pending> pending_;       ///< commands that do not act yet
  Measurement measured_;
  Wrench commanded_, applied_;
};

}  // namespace fingertip::lattice::inline control
