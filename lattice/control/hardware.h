/// What stands between a controller and the finger in real hardware: sensors and actuators.
#pragma once

#include <cstdint>
#include <deque>
#include <random>
#include <vector>

#include "lattice/control/controller.h"
#include "meshes/base/errors.h"

namespace fingertip::lattice::inline control {

/// One kind of sensor, per component.
struct SensorChannel {
  double noise = 0.0;       ///< standard deviation of white Gaussian noise, >= 0
  double resolution = 0.0;  ///< readings are multiples of it (round to nearest); 0: exact
};

/// Sensors and actuators of the robot; the defaults are perfect.
struct HardwareSettings {
  SensorChannel position;          ///< of the endpoint [m]
  SensorChannel orientation;       ///< rotation vector [rad]
  SensorChannel velocity;          ///< [m/s]
  SensorChannel angular_velocity;  ///< [rad/s]
  SensorChannel force;             ///< [N]
  SensorChannel torque;            ///< [N m]
  bool tactile = true;             ///< whether Measurement::contact is there
  meshes::TaxelSkin skin;          ///< whether Measurement::taxels are there
  SensorChannel taxel;             ///< of each of their three stresses [Pa]
  double taxel_rate = 0.0;         ///< of new readings [Hz], >= 0; 0: one each time they are asked
  double taxel_latency = 0.0;      ///< and their age, besides sensor_latency [s], >= 0

  double sensor_latency = 0.0;    ///< age of a measurement when the controller gets it [s], >= 0
  double actuator_latency = 0.0;  ///< until a command acts [s], >= 0
  double force_rate = 0.0;        ///< largest change of a force component [N/s]; 0: no limit
  double torque_rate = 0.0;       ///< largest change of a torque component [N m/s]; 0: no limit
  std::uint64_t seed = 1;         ///< of the noise: the same seed gives the same run

  std::vector<meshes::Violation> violations() const;
};

/// What an actuator makes of a wrench that may exceed its limits [N], [N m]: each component for
/// itself, for one that can push no harder must still be able to steer.
Wrench limited(const Wrench& wanted, double force_limit, double torque_limit);

/// Turns true measurements into readings and commanded wrenches into those that act. Latencies are
/// the control loop's matter, which knows the times.
class Hardware {
 public:
  /// The actuators push and twist at most so much along each axis [N], [N m].
  Hardware(const HardwareSettings& settings, double force_limit, double torque_limit);

  Measurement sense(const Measurement& truth);
  /// `duration` [s] since the last call, for the limits of rate.
  Wrench act(const Wrench& commanded, double duration);
  /// Noise and rate limits start again as in the beginning.
  void reset();
  const HardwareSettings& settings() const { return settings_; }

 private:
  meshes::Vector3 read(const meshes::Vector3& truth, const SensorChannel& channel) {
    return read(truth, channel, generator_);
  }
  static meshes::Vector3 read(const meshes::Vector3& truth, const SensorChannel& channel,
                              std::mt19937_64& generator);
  const std::vector<meshes::TaxelReading>& read_skin(const Measurement& truth);

  HardwareSettings settings_;
  double force_limit_, torque_limit_;
  /// The skin's own: what others read does not depend on whether there is one.
  std::mt19937_64 generator_, skin_generator_;
  Wrench last_;
  struct SkinReading {
    double time = 0.0;  ///< when it was taken [s]
    std::vector<meshes::TaxelReading> taxels;
  };
  std::deque<SkinReading> skin_;  ///< the one that is told, and those that are not yet due
};

}  // namespace fingertip::lattice::inline control
