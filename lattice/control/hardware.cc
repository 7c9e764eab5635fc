#include "lattice/control/hardware.h"

#include <algorithm>
#include <cmath>

#include "meshes/base/files.h"

namespace fingertip::lattice::inline control {

using meshes::Vector3;

namespace {

Vector3 limited(const Vector3& wanted, double limit) {
  return wanted.cwiseMin(limit).cwiseMax(-limit);
}

Vector3 slowed(const Vector3& wanted, const Vector3& last, double most) {
  return most > 0.0 ? Vector3(last + limited(wanted - last, most)) : wanted;
}

}  // namespace

Wrench limited(const Wrench& wanted, double force_limit, double torque_limit) {
  return {limited(wanted.force, force_limit), limited(wanted.torque, torque_limit)};
}

std::vector<meshes::Violation> HardwareSettings::violations() const {
  std::vector<meshes::Violation> found;
  const auto require = [&found](bool holds, const char* key, double value, const char* rule) {
    if (!holds) found.push_back({key, meshes::to_text(value), rule, "give such a value"});
  };
  const auto not_negative = [&](const char* key, double value) {
    require(std::isfinite(value) && value >= 0.0, key, value, "must be finite and not negative");
  };
  const auto channel = [&](const char* noise, const char* resolution, const SensorChannel& c) {
    not_negative(noise, c.noise);
    not_negative(resolution, c.resolution);
  };
  channel("hardware.position_noise", "hardware.position_resolution", position);
  channel("hardware.orientation_noise", "hardware.orientation_resolution", orientation);
  channel("hardware.velocity_noise", "hardware.velocity_resolution", velocity);
  channel("hardware.angular_velocity_noise", "hardware.angular_velocity_resolution",
          angular_velocity);
  channel("hardware.force_noise", "hardware.force_resolution", force);
  channel("hardware.torque_noise", "hardware.torque_resolution", torque);
  channel("sensor.noise", "sensor.resolution", taxel);
  not_negative("sensor.rate", taxel_rate);
  not_negative("sensor.latency", taxel_latency);
  append(found, skin.violations());
  not_negative("hardware.sensor_latency", sensor_latency);
  not_negative("hardware.actuator_latency", actuator_latency);
  not_negative("hardware.force_rate", force_rate);
  not_negative("hardware.torque_rate", torque_rate);
  return found;
}

Hardware::Hardware(const HardwareSettings& settings, double force_limit, double torque_limit)
    : settings_(settings),
      force_limit_(force_limit),
      torque_limit_(torque_limit),
      generator_(settings.seed),
      skin_generator_(~settings.seed) {}

void Hardware::reset() {
  generator_.seed(settings_.seed);
  skin_generator_.seed(~settings_.seed);
  last_ = {};
  skin_.clear();
}

Vector3 Hardware::read(const Vector3& truth, const SensorChannel& channel,
                       std::mt19937_64& generator) {
  Vector3 reading = truth;
  if (channel.noise > 0.0) {
    std::normal_distribution<double> normal(0.0, channel.noise);
    for (int axis = 0; axis < 3; ++axis) reading[axis] += normal(generator);
  }
  if (channel.resolution > 0.0) {
    reading = channel.resolution * (reading / channel.resolution).array().round().matrix();
  }
  return reading;
}

/// The newest reading that is old enough, else the first one.
const std::vector<meshes::TaxelReading>& Hardware::read_skin(const Measurement& truth) {
  constexpr double round_off = 1e-9;  // of a second
  const double rate = settings_.taxel_rate;
  const auto tick = [rate](double time) { return std::floor(rate * (time + round_off)); };
  if (skin_.empty() || rate == 0.0 || tick(truth.time) > tick(skin_.back().time)) {
    skin_.push_back({truth.time, truth.taxels});
    for (meshes::TaxelReading& taxel : skin_.back().taxels) {
      const Vector3 felt = read({taxel.shear_u, taxel.shear_v, taxel.normal_stress},
                                settings_.taxel, skin_generator_);
      taxel = {felt.z(), felt.x(), felt.y()};
    }
  }
  while (skin_.size() > 1 && skin_[1].time <= truth.time - settings_.taxel_latency + round_off)
    skin_.pop_front();
  return skin_.front().taxels;
}

Measurement Hardware::sense(const Measurement& truth) {
  Measurement m = truth;
  m.pose.position = read(truth.pose.position, settings_.position);
  const SensorChannel& angle = settings_.orientation;
  if (angle.noise > 0.0 || angle.resolution > 0.0) {
    m.pose.orientation = rotation_by(read(rotation_vector(truth.pose.orientation), angle));
  }
  m.twist.velocity = read(truth.twist.velocity, settings_.velocity);
  m.twist.angular_velocity = read(truth.twist.angular_velocity, settings_.angular_velocity);
  m.wrench.force = read(truth.wrench.force, settings_.force);
  m.wrench.torque = read(truth.wrench.torque, settings_.torque);
  if (!settings_.tactile) m.contact.reset();
  if (!truth.taxels.empty()) m.taxels = read_skin(truth);
  return m;
}

Wrench Hardware::act(const Wrench& commanded, double duration) {
  Wrench wrench = limited(commanded, force_limit_, torque_limit_);
  wrench.force = slowed(wrench.force, last_.force, duration * settings_.force_rate);
  wrench.torque = slowed(wrench.torque, last_.torque, duration * settings_.torque_rate);
  last_ = wrench;
  return wrench;
}

}  // namespace fingertip::lattice::inline control
