/// Plants with known answers, moved by controllers with a sampling period and zero-order hold.
#pragma once

#include <cmath>
#include <deque>
#include <functional>
#include <random>

#include "lattice/control/task.h"
#include "meshes/press/press_motion.h"

namespace plants {

using namespace fingertip;
using lattice::Controller;
using lattice::ControlTask;
using lattice::Measurement;
using lattice::Target;
using lattice::Wrench;
using meshes::Vector3;

/// A mass that slides along +z toward a spring: F = spring(indentation) + damping * velocity where
/// the indentation is positive. Moved exactly but for steps of a hundredth of a period.
struct Slider {
  double mass = 7e-3;       ///< [kg]
  double clearance = 1e-3;  ///< at the start [m]
  std::function<double(double)> spring = [](double depth) { return 100.0 * depth; };
  double damping = 0.0;         ///< [N s/m]
  double load = 0.0;            ///< constant force along +z [N]
  double sensor_noise = 0.0;    ///< of the force, standard deviation [N]
  double velocity_noise = 0.0;  ///< standard deviation [m/s]
  int latency = 0;              ///< periods until a command acts
  double retreat = 0.0;         ///< by which the spring has been taken away [m]

  double position = 0.0, velocity = 0.0, time = 0.0;
  double applied = 0.0;  ///< force along +z [N]
  std::deque<double> waiting;
  std::mt19937 generator{1};

  double contact() const {
    const double depth = position - clearance - retreat;
    return depth > 0.0 ? spring(depth) + damping * velocity : 0.0;
  }

  Measurement measure() {
    std::normal_distribution<double> normal(0.0, 1.0);
    Measurement m;
    m.time = time;
    m.pose.position = Vector3(0.0, 0.0, position);
    m.twist.velocity = Vector3(0.0, 0.0, velocity + velocity_noise * normal(generator));
    m.wrench.force = Vector3(0.0, 0.0, -contact() + sensor_noise * normal(generator));
    return m;
  }

  /// One sampling period.
  void cycle(Controller& controller, double period) {
    const auto command = controller.command(measure());
    waiting.push_back(std::get<Wrench>(command).force.z());
    if (int(waiting.size()) > latency) {
      applied = waiting.front();
      waiting.pop_front();
    }
    constexpr int steps = 100;
    const double dt = period / steps;
    for (int i = 0; i < steps; ++i) {
      // Velocity Verlet.
      const double before = (applied + load - contact()) / mass;
      position += dt * velocity + 0.5 * dt * dt * before;
      velocity += dt * before;
      velocity += 0.5 * dt * ((applied + load - contact()) / mass - before);
    }
    time += period;
  }
};

/// An approach along +z at `speed` [m/s] to a plane `clearance` [m] away.
inline ControlTask task_for(const Slider& slider, double speed) {
  ControlTask task;
  task.inertia = slider.mass * Eigen::Matrix<double, 6, 6>::Identity();
  task.clearance = slider.clearance;
  task.speed = speed;
  task.path = [approach = meshes::PressMotion({.speed = speed, .clearance = slider.clearance})](
                  double time) {
    const meshes::SetPoint point = approach.at(time);
    Target target;
    target.pose.position.z() = point.distance;
    target.twist.velocity.z() = point.speed;
    target.acceleration.velocity.z() = point.acceleration;
    return target;
  };
  return task;
}

/// The task with a plant of the same kind to try.
inline ControlTask with_identification(ControlTask task, const Slider& slider) {
  task.identify = [slider, period = task.period](
                      Controller& trial, const std::function<bool()>& done, double longest) {
    Slider copy = slider;
    while (copy.time < longest && !done()) copy.cycle(trial, period);
  };
  return task;
}

}  // namespace plants
