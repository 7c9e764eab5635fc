/// The keys of [controller] and [hardware].
#include "studies/config/key_builders.h"
#include "studies/config/key_sections.h"

namespace fingertip::studies {

namespace {

/// Noise and resolution of one kind of sensor.
void add_sensor(std::vector<Key>& keys, const char* noise, const char* resolution, const char* unit,
                const char* what, lattice::SensorChannel lattice::HardwareSettings::*channel) {
  const std::string none = std::string("0 ") + unit;
  const std::string help = std::string("of the sensor of ") + what;
  Key one = quantity(
      "hardware", noise, none.c_str(), unit, not_negative, "",
      [channel](Config& config) -> double& { return (config.press.hardware.*channel).noise; });
  one.help = "standard deviation of the white noise " + help;
  Key other = quantity(
      "hardware", resolution, none.c_str(), unit, not_negative, "",
      [channel](Config& config) -> double& { return (config.press.hardware.*channel).resolution; });
  other.help = "smallest step of the reading " + help + "; 0: exact";
  keys.push_back(std::move(one));
  keys.push_back(std::move(other));
}

void assign_controller(Config& config, const Value& value) {
  ControllerKind& kind = config.controller.kind;
  if (value.word == "pid") kind = ControllerKind::pid;
  if (value.word == "adaptive") kind = ControllerKind::adaptive;
  if (value.word == "force") kind = ControllerKind::force;
  if (value.word == "hybrid") kind = ControllerKind::hybrid;
  if (value.word == "library") kind = ControllerKind::library;
  if (value.word == "socket") kind = ControllerKind::socket;
}

std::vector<Key> of_types(const std::vector<std::string>& types, std::vector<Key> keys) {
  for (Key& key : keys) key = only_with("controller.type", types, key);
  return keys;
}

std::vector<Key> adaptation_keys() {
  using lattice::AdaptiveSettings;
  const auto flag = [](const char* name, bool AdaptiveSettings::*member, const char* help) {
    return plain("controller", name, Kind::boolean, "true", any, help,
                 [member](Config& config, const Value& value) {
                   config.controller.adaptive.*member = value.number != 0.0;
                 });
  };
  const auto member = [](double AdaptiveSettings::*value) {
    return [value](Config& config) -> double& { return config.controller.adaptive.*value; };
  };
  Key schedule = choice("controller", "schedule", "none",
                        {{"none", "the contact's stiffness is only estimated"}},
                        "stiffness of the contact over the indentation: a surrogate.json written "
                        "by calibrate",
                        [](Config& config, const Value& value) {
                          config.controller.schedule.clear();
                          if (value.word != "none") config.controller.schedule = value.word;
                        });
  schedule.kind = Kind::source;
  std::vector<Key> keys = of_types(
      {"adaptive"},
      {
          plain("controller", "sensitivity", Kind::number, "2.0", {1.2, 3.0, true},
                "peak of the sensitivity that the relay's tuning leaves",
                [](Config& config, const Value& value) {
                  config.controller.adaptive.sensitivity = value.number;
                }),
          flag("relay", &AdaptiveSettings::relay,
               "whether a relay on the free finger finds the loop's delay first"),
          flag("adaptation", &AdaptiveSettings::estimate,
               "whether the contact's stiffness and damping are estimated"),
          quantity("controller", "memory", "10 ms", "s", positive,
                   "time constant of the estimate's forgetting", member(&AdaptiveSettings::memory)),
      });
  keys.push_back(only_with("controller.type", {"adaptive", "force", "hybrid"}, schedule));
  return keys;
}

std::vector<Key> force_keys() {
  using lattice::ForceSettings;
  const auto member = [](double ForceSettings::*value) {
    return [value](Config& config) -> double& { return config.controller.force.*value; };
  };
  std::vector<Key> keys = of_types(
      {"force", "hybrid"},
      {
          quantity("controller", "force", "0.1 N", "N", positive, "contact force to be held",
                   member(&ForceSettings::force)),
          with_rule(quantity("controller", "force_bandwidth", "5 Hz", "Hz", positive,
                             "of the force's closed loop", member(&ForceSettings::bandwidth)),
                    "at most a tenth of natural_frequency", {"controller.natural_frequency"}),
      });
  const std::vector<Key> hybrid = of_types(
      {"hybrid"},
      {
          with_rule(quantity("controller", "touch_force", "0.01 N", "N", positive,
                             "contact is assumed above it", member(&ForceSettings::touch_force)),
                    "less than force", {"controller.force"}),
          with_rule(quantity("controller", "release_force", "0.004 N", "N", not_negative,
                             "contact is given up below it", member(&ForceSettings::release_force)),
                    "less than touch_force", {"controller.touch_force"}),
          quantity("controller", "confirmation", "3 ms", "s", not_negative,
                   "how long the force must be beyond either before it counts",
                   member(&ForceSettings::confirmation)),
          quantity("controller", "dwell", "50 ms", "s", not_negative,
                   "least time between two changes of mode", member(&ForceSettings::dwell)),
      });
  keys.insert(keys.end(), hybrid.begin(), hybrid.end());
  return keys;
}

std::vector<Key> external_keys() {
  const auto member = [](double ControllerOrder::*value) {
    return [value](Config& config) -> double& { return config.controller.*value; };
  };
  Key library = choice("controller", "library", "none", {{"none", "no shared object"}},
                       "shared object with the functions of fingertip_controller.h",
                       [](Config& config, const Value& value) {
                         config.controller.library.clear();
                         if (value.word != "none") config.controller.library = value.word;
                       });
  library.kind = Kind::source;
  std::vector<Key> keys =
      of_types({"socket"},
               {
                   with_rule(plain("controller", "address", Kind::text, "\"unix:fingertip.socket\"",
                                   any, "where the program waits for a controller",
                                   [](Config& config, const Value& value) {
                                     config.controller.address = value.word;
                                   }),
                             "unix:PATH, or tcp:127.0.0.1:PORT", {}),
                   quantity("controller", "timeout", "5 s", "s", positive,
                            "how long the controller may take for an answer, or to come back",
                            member(&ControllerOrder::timeout)),
                   quantity("controller", "connect_timeout", "60 s", "s", positive,
                            "how long the program waits for the controller to connect",
                            member(&ControllerOrder::connect_timeout)),
               });
  keys.insert(keys.begin(), only_with("controller.type", {"library"}, library));
  return keys;
}

}  // namespace

std::vector<Key> controller_keys() {
  using lattice::PidSettings;
  const auto pid = [](double PidSettings::*member) {
    return [member](Config& config) -> double& { return config.press.controller.*member; };
  };
  std::vector<Key> keys = {
      choice("controller", "type", "pid",
             {{"pid", "PID with anti-windup and filtered derivative"},
              {"adaptive", "PID tuned by a relay, gains scheduled on the contact's stiffness"},
              {"force", "contact force along the plane's normal, pose along all other axes"},
              {"hybrid", "approach, then contact force"},
              {"library", "one's own, in a shared object (studies/control)"},
              {"socket", "one's own, in a process that speaks JSON lines (studies/control)"}},
             "control law", assign_controller),
      quantity("controller", "period", "1 ms", "s", positive, "sampling period",
               pid(&PidSettings::period)),
      quantity("controller", "natural_frequency", "60 Hz", "Hz", positive,
               "of the closed loop with the bare rod; sets all gains",
               pid(&PidSettings::natural_frequency)),
      plain("controller", "derivative_filter", Kind::number, "10.0", positive,
            "N: the derivative is low-passed at N times the natural frequency",
            [](Config& config, const Value& value) {
              config.press.controller.derivative_filter = value.number;
            }),
      plain("controller", "setpoint_weight", Kind::number, "1.0", {0.0, 1.0, true},
            "b: share of the set point in the proportional part",
            [](Config& config, const Value& value) {
              config.press.controller.setpoint_weight = value.number;
            }),
      plain("controller", "bond_compensation", Kind::number, "1.0", {0.0, 1.0, true},
            "share of the measured bond force and torque that is fed forward",
            [](Config& config, const Value& value) {
              config.press.controller.bond_compensation = value.number;
            }),
      quantity("controller", "force_limit", "20 N", "N", positive,
               "largest force of the actuator along each axis", pid(&PidSettings::force_limit)),
      quantity("controller", "torque_limit", "1 N m", "N m", positive,
               "largest torque of the actuator about each axis", pid(&PidSettings::torque_limit)),
  };
  for (const auto& part : {adaptation_keys(), force_keys(), external_keys()}) {
    keys.insert(keys.end(), part.begin(), part.end());
  }
  return keys;
}

std::vector<Key> hardware_keys() {
  using lattice::HardwareSettings;
  const auto member = [](double HardwareSettings::*value) {
    return [value](Config& config) -> double& { return config.press.hardware.*value; };
  };
  std::vector<Key> keys;
  add_sensor(keys, "position_noise", "position_resolution", "m", "the endpoint's position",
             &HardwareSettings::position);
  add_sensor(keys, "orientation_noise", "orientation_resolution", "rad", "the rod's orientation",
             &HardwareSettings::orientation);
  add_sensor(keys, "velocity_noise", "velocity_resolution", "m/s", "the endpoint's velocity",
             &HardwareSettings::velocity);
  add_sensor(keys, "angular_velocity_noise", "angular_velocity_resolution", "rad/s",
             "the rod's angular velocity", &HardwareSettings::angular_velocity);
  add_sensor(keys, "force_noise", "force_resolution", "N", "the force at the endpoint",
             &HardwareSettings::force);
  add_sensor(keys, "torque_noise", "torque_resolution", "N m", "the torque at the endpoint",
             &HardwareSettings::torque);
  keys.push_back(plain("hardware", "tactile", Kind::boolean, "true", any,
                       "whether the controller is told about the contact with the plane",
                       [](Config& config, const Value& value) {
                         config.press.hardware.tactile = value.number != 0.0;
                       }));
  keys.push_back(quantity("hardware", "sensor_latency", "0 ms", "s", not_negative,
                          "age of a measurement when the controller gets it",
                          member(&HardwareSettings::sensor_latency)));
  keys.push_back(quantity("hardware", "actuator_latency", "0 ms", "s", not_negative,
                          "until a command acts", member(&HardwareSettings::actuator_latency)));
  keys.push_back(quantity("hardware", "force_rate", "0 N/s", "N/s", not_negative,
                          "largest change of a force component; 0: no limit",
                          member(&HardwareSettings::force_rate)));
  keys.push_back(quantity("hardware", "torque_rate", "0 N m/s", "N m/s", not_negative,
                          "largest change of a torque component; 0: no limit",
                          member(&HardwareSettings::torque_rate)));
  keys.push_back(plain("hardware", "seed", Kind::integer, "1", {0, 1e9, true},
                       "of the sensors' noise: the same seed gives the same run",
                       [](Config& config, const Value& value) {
                         config.press.hardware.seed = std::uint64_t(value.number);
                       }));
  return keys;
}

}  // namespace fingertip::studies
