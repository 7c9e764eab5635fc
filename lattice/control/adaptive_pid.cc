#include "lattice/control/adaptive_pid.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fingertip::lattice::inline control {

using meshes::Vector3;

namespace {

constexpr double turn = 2.0 * std::numbers::pi;
constexpr int whole_periods = 2;  // after the touch, before both of two increments are in contact

EstimatorLimits limits_for(const AdaptiveSettings& settings, double mass, double omega) {
  const double stiff = mass * omega * omega;
  return {100.0 * stiff, settings.stiffness ? 0.1 * stiff : stiff, 3.0 * mass * omega,
          settings.force_noise, settings.memory};
}

}  // namespace

AdaptivePid::Tuning AdaptivePid::tune(const PidSettings& pid, const AdaptiveSettings& settings,
                                      const ControlTask& task) {
  const auto broken = settings.violations();
  if (!broken.empty()) throw meshes::InvalidInput(broken);
  // Without experiment: the hold's own delay and the mass as told.
  Tuning tuning{std::nullopt, 0.5 * task.period, 0.5 * task.period, task.inertia(0, 0), pid};
  if (settings.relay && task.identify) {
    const double share = pid.bond_compensation;
    tuning.relay = relay_experiment(task, share);
    if (!tuning.relay || !(tuning.relay->delay > 0.0 && tuning.relay->mass > 0.0)) {
      throw meshes::NotConverged("the relay experiment found no oscillation of the free finger");
    }
    tuning.delay = std::max(tuning.delay, tuning.relay->delay);
    tuning.mass = tuning.relay->mass;
    // What is fed forward slows the loop down, but not the way from a measurement to the rod.
    const auto bare = share > 0.0 ? relay_experiment(task, 0.0) : tuning.relay;
    tuning.latency = bare ? bare->delay : tuning.delay;
  }
  tuning.pid.natural_frequency = tuned_delay_angle(settings.sensitivity) / tuning.delay / turn;
  return tuning;
}

AdaptivePid::AdaptivePid(const PidSettings& pid, const AdaptiveSettings& settings,
                         const ControlTask& task)
    : tuning_(tune(pid, settings, task)),
      task_(task),
      settings_(settings),
      pid_(tuning_.pid, tuning_.mass / task.inertia(0, 0) * task.inertia),
      omega_(turn * tuning_.pid.natural_frequency),
      estimator_(limits_for(settings, tuning_.mass, omega_), task.period),
      start_(task.path(0.0).pose.position) {}

void AdaptivePid::reset() {
  pid_.reset();
  estimator_.reset();
  commanded_.clear();
  before_.reset();
  mean_.reset();
  touched_ = 0;
  stiffness_ = damping_ = softening_ = error_ = 0.0;
}

ControllerReport AdaptivePid::report() const {
  ControllerReport report;
  report.stiffness = stiffness_;
  return report;
}

/// Between the last two measurements: commands act delay - T/2 after they were computed from one.
double AdaptivePid::force_that_acted() const {
  const double late = std::max(tuning_.latency / task_.period - 0.5, 0.0);
  const std::size_t whole = std::min(std::size_t(late), commanded_.size() - 1);
  const std::size_t next = std::min(whole + 1, commanded_.size() - 1);
  const double part = late - std::floor(late);
  return (1.0 - part) * commanded_[whole] + part * commanded_[next];
}

void AdaptivePid::learn(const Motion& now, double scheduled) {
  if (before_ && !commanded_.empty()) {
    const double sped_up = now.velocity - before_->velocity;
    const double moved = now.position - before_->position;
    const Increment mean{0.5 * (now.position + before_->position) - task_.period * sped_up / 12.0,
                         moved / task_.period,
                         force_that_acted() - tuning_.mass * sped_up / task_.period};
    if (mean_ && touched_ > whole_periods && !pid_.saturated() && settings_.estimate) {
      estimator_.update(mean.position - mean_->position, mean.velocity - mean_->velocity,
                        mean.force - mean_->force, scheduled);
    }
    mean_ = mean;
  }
  before_ = now;
}

Command AdaptivePid::command(const Measurement& m) {
  const Target target = task_.path(m.time);
  const Vector3 toward = -task_.normal;
  const Motion now{toward.dot(m.pose.position - start_), toward.dot(m.twist.velocity)};
  const double indentation = now.position - task_.clearance;
  const bool touches = m.contact ? m.contact->touching > 0 : indentation > 0.0;
  const double scheduled =
      touches && settings_.stiffness ? settings_.stiffness(std::max(indentation, 0.0)) : 0.0;
  learn(now, scheduled);
  if (touches != (touched_ > 0)) estimator_.reset();
  touched_ = touches ? touched_ + 1 : 0;

  const double share = pid_.settings().bond_compensation;
  const double speed = toward.dot(target.twist.velocity);
  const double stiffness = touches ? estimator_.stiffness(scheduled) : 0.0;
  damping_ = touches ? estimator_.damping() : 0.0;
  // More than M w² is not taken off 3 M w²: the loop would lean on what it believes.
  const double softening = std::min((1.0 - share) * stiffness, tuning_.mass * omega_ * omega_);
  const double shift = (softening - softening_) * error_;
  softening_ = softening;
  stiffness_ = stiffness;
  const double rise = (1.0 - share) * stiffness_ * speed * task_.period;
  if (!pid_.saturated()) pid_.carry({(shift + rise) * toward, Vector3::Zero()});

  error_ = toward.dot(target.pose.position - m.pose.position);
  const double lag = speed - now.velocity;
  const double extra = share * stiffness_ * speed * tuning_.latency -
                       (softening_ * error_ + (1.0 - share) * damping_ * lag);
  const Wrench wrench = pid_.follow(m, target, {extra * toward, Vector3::Zero()});
  commanded_.push_front(toward.dot(wrench.force));
  if (double(commanded_.size()) > tuning_.latency / task_.period + 2.0) commanded_.pop_back();
  return wrench;
}

}  // namespace fingertip::lattice::inline control
