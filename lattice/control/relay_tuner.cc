#include "lattice/control/relay_tuner.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace fingertip::lattice::inline control {

using meshes::Vector3;

namespace {

constexpr std::size_t quiet_samples = 6;
constexpr double longest_experiment = 1000.0;  // periods
constexpr std::size_t transient_halves = 3, measured_halves = 12;

/// Standard deviation of white noise on a straight line: second differences have six times its
/// variance.
double noise_of(const std::vector<double>& v) {
  double sum = 0.0;
  for (std::size_t i = 2; i < v.size(); ++i) sum += std::pow(v[i] - 2.0 * v[i - 1] + v[i - 2], 2);
  return std::sqrt(sum / (6.0 * double(v.size() - 2)));
}

double peak_of_sensitivity(double delay_angle) {
  double peak = 0.0;
  for (int i = 0; i < 600; ++i) {
    const std::complex<double> s(0.0, std::pow(10.0, -1.0 + 2.5 * i / 600.0));
    const auto loop = (3.0 * s * s + 3.0 * s + 1.0) / (s * s * s) * std::exp(-delay_angle * s);
    peak = std::max(peak, 1.0 / std::abs(1.0 + loop));
  }
  return peak;
}

}  // namespace

double tuned_delay_angle(double sensitivity) {
  double slow = 0.0, fast = 0.35;  // at 0.40 the loop is no longer stable
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (slow + fast);
    (peak_of_sensitivity(middle) < sensitivity ? slow : fast) = middle;
  }
  return slow;
}

/// Velocities lie on a grid of d T/M that may contain zero; a hair off it, round-off does not
/// decide.
RelayTuner::RelayTuner(const ControlTask& task, double share, double level)
    : task_(task),
      share_(share),
      level_(level),
      hair_(0.01 * level * task.period / task.inertia(0, 0)) {
  reset();
}

void RelayTuner::reset() {
  sign_ = 1.0;
  sample_ = last_turn_ = 0;
  hysteresis_ = highest_ = lowest_ = 0.0;
  quiet_.clear();
  halves_.clear();
  start_.reset();
  lost_ = false;
}

void RelayTuner::listen(double velocity) {
  quiet_.push_back(velocity);
  if (quiet_.size() < quiet_samples) return;
  hysteresis_ = 3.0 * noise_of(quiet_);
  highest_ = lowest_ = velocity;
  last_turn_ = sample_;
}

/// A half is complete when the relay turns; its peak came before the turn's delay had passed, so it
/// is only known at the next turn and belongs to the half before.
void RelayTuner::turn(double velocity, long sample) {
  highest_ = std::max(highest_, velocity);
  lowest_ = std::min(lowest_, velocity);
  const bool falls = sign_ > 0.0 && velocity >= hair_ + hysteresis_;
  const bool rises = sign_ < 0.0 && velocity < hair_ - hysteresis_;
  if (!falls && !rises) return;
  halves_.push_back({falls ? lowest_ : highest_, sample - last_turn_});
  sign_ = -sign_;
  last_turn_ = sample;
  highest_ = lowest_ = velocity;
}

Command RelayTuner::command(const Measurement& m) {
  if (!start_) start_ = m.pose.position;
  const double velocity = -task_.normal.dot(m.twist.velocity);
  const Wrench answer{-share_ * m.wrench.force, -share_ * m.wrench.torque};
  ++sample_;
  if (quiet_.size() < quiet_samples) {
    listen(velocity);
    return answer;
  }
  turn(velocity, sample_);
  lost_ = lost_ || (m.pose.position - *start_).norm() > 0.75 * task_.clearance;
  return Wrench{answer.force - sign_ * level_ * task_.normal, answer.torque};
}

std::optional<RelayResult> RelayTuner::result() const {
  if (halves_.size() < transient_halves + measured_halves) return std::nullopt;
  // Halves 0, 2, ... end with a turn to falling: the velocity rose in them, from their lowest.
  double rise = 0.0, fall = 0.0, lowest = 0.0, highest = 0.0;
  for (std::size_t i = halves_.size() - measured_halves; i < halves_.size(); ++i) {
    const bool rose = i % 2 == 0;
    (rose ? rise : fall) += double(halves_[i].samples);
    (rose ? lowest : highest) += halves_[i].peak;
  }
  const double count = double(measured_halves / 2);
  const double height = (highest - lowest) / count;
  const double up = rise / count * task_.period, down = fall / count * task_.period;
  RelayResult found;
  found.level = level_;
  found.hysteresis = hysteresis_;
  found.mass = 2.0 * level_ / (height * (1.0 / up + 1.0 / down));
  found.delay = (height - 2.0 * hysteresis_) * found.mass / (2.0 * level_);
  found.ultimate_gain = 8.0 * level_ / (std::numbers::pi * height);
  found.ultimate_period = up + down;
  return found;
}

std::optional<RelayResult> relay_experiment(const ControlTask& task, double share) {
  if (!task.identify) return std::nullopt;
  for (const double part : {1e-3, 1e-2, 1e-1}) {
    RelayTuner tuner(task, share, part * task.force_limit);
    task.identify(
        tuner, [&tuner] { return tuner.finished(); }, longest_experiment * task.period);
    if (const auto found = tuner.result()) return found;
  }
  return std::nullopt;
}

}  // namespace fingertip::lattice::inline control
