/// The keys of [controller] and [hardware].
#include "studies/config/keys/key_builders.h"
#include "studies/config/keys/key_sections.h"

namespace fingertip::studies::inline config::inline keys {

namespace {

/// Noise and resolution of one kind of sensor.
void add_sensor(std::vector<Key>& keys, const char* noise, const char* resolution, const char* unit,
                const std::string& what, lattice::SensorChannel lattice::HardwareSettings::*channel,
                const char* section = "hardware") {
  const auto add = [&](const char* name, const std::string& help, auto member) {
    keys.push_back(quantity(section, name, unit, unit, not_negative, help.c_str(),
                            at(&Config::press, &lattice::PressSetup::hardware, channel, member)));
  };
  add(noise, "standard deviation of the white noise of the sensor of " + what,
      &lattice::SensorChannel::noise);
  add(resolution, "smallest step of the reading of the sensor of " + what + "; 0: exact",
      &lattice::SensorChannel::resolution);
}

std::vector<Key> of_types(const std::vector<std::string>& types, std::vector<Key> keys) {
  for (Key& key : keys) key = only_with("controller.type", types, key);
  return keys;
}

std::vector<Key> adaptation_keys() {
  using lattice::AdaptiveSettings;
  const auto member = [](auto value) {
    return at(&Config::controller, &ControllerSettings::adaptive, value);
  };
  Key schedule =
      choice("controller", "schedule", {{"none", "the contact's stiffness is only estimated"}},
             "stiffness of the contact over the indentation: a surrogate.json written "
             "by calibrate",
             at(&Config::controller, &ControllerSettings::schedule));
  std::vector<Key> keys = of_types(
      {"adaptive"},
      {
          plain("controller", "sensitivity", {1.2, 3.0, true},
                "peak of the sensitivity that the relay's tuning leaves",
                member(&AdaptiveSettings::sensitivity)),
          plain("controller", "relay", any,
                "whether a relay on the free finger finds the loop's delay first",
                member(&AdaptiveSettings::relay)),
          plain("controller", "adaptation", any,
                "whether the contact's stiffness and damping are estimated",
                member(&AdaptiveSettings::estimate)),
          quantity("controller", "memory", "ms", "s", positive,
                   "time constant of the estimate's forgetting", member(&AdaptiveSettings::memory)),
      });
  keys.push_back(only_with("controller.type", {"adaptive", "force", "hybrid"}, schedule));
  return keys;
}

std::vector<Key> force_keys() {
  using lattice::ForceSettings;
  const auto member = [](auto value) {
    return at(&Config::controller, &ControllerSettings::force, value);
  };
  std::vector<Key> keys = of_types(
      {"force", "hybrid"},
      {
          quantity("controller", "force", "N", "N", positive, "contact force to be held",
                   member(&ForceSettings::force)),
          with_rule(quantity("controller", "force_bandwidth", "Hz", "Hz", positive,
                             "of the force's closed loop", member(&ForceSettings::bandwidth)),
                    "at most a tenth of natural_frequency", {"controller.natural_frequency"}),
      });
  const std::vector<Key> hybrid = of_types(
      {"hybrid"},
      {
          with_rule(quantity("controller", "touch_force", "N", "N", positive,
                             "contact is assumed above it", member(&ForceSettings::touch_force)),
                    "less than force", {"controller.force"}),
          with_rule(quantity("controller", "release_force", "N", "N", not_negative,
                             "contact is given up below it", member(&ForceSettings::release_force)),
                    "less than touch_force", {"controller.touch_force"}),
          quantity("controller", "confirmation", "ms", "s", not_negative,
                   "how long the force must be beyond either before it counts",
                   member(&ForceSettings::confirmation)),
          quantity("controller", "dwell", "ms", "s", not_negative,
                   "least time between two changes of mode", member(&ForceSettings::dwell)),
      });
  keys.insert(keys.end(), hybrid.begin(), hybrid.end());
  return keys;
}

std::vector<Key> external_keys() {
  const auto member = [](auto value) { return at(&Config::controller, value); };
  Key library = choice("controller", "library", {{"none", "no shared object"}},
                       "shared object with the functions of fingertip_controller.h",
                       at(&Config::controller, &ControllerSettings::library));
  std::vector<Key> keys = of_types(
      {"socket"},
      {
          with_rule(plain("controller", "address", any, "where the program waits for a controller",
                          member(&ControllerSettings::address)),
                    "unix:PATH, or tcp:127.0.0.1:PORT", {}),
          quantity("controller", "timeout", "s", "s", positive,
                   "how long the controller may take for an answer, or to come back",
                   member(&ControllerSettings::timeout)),
          quantity("controller", "connect_timeout", "s", "s", positive,
                   "how long the program waits for the controller to connect",
                   member(&ControllerSettings::connect_timeout)),
      });
  keys.insert(keys.begin(), only_with("controller.type", {"library"}, library));
  return keys;
}

}  // namespace

std::vector<Key> controller_keys() {
  using lattice::PidSettings;
  const auto pid = [](auto member) {
    return at(&Config::press, &lattice::PressSetup::controller, member);
  };
  std::vector<Key> keys = {
      choice("controller", "type",
             {{"pid", "PID with anti-windup and filtered derivative"},
              {"adaptive", "PID tuned by a relay, gains scheduled on the contact's stiffness"},
              {"force", "contact force along the plane's normal, pose along all other axes"},
              {"hybrid", "approach, then contact force"},
              {"library", "one's own, in a shared object (studies/control)"},
              {"socket", "one's own, in a process that speaks JSON lines (studies/control)"}},
             "control law", at(&Config::controller, &ControllerSettings::kind)),
      quantity("controller", "period", "ms", "s", positive, "sampling period",
               pid(&PidSettings::period)),
      quantity("controller", "natural_frequency", "Hz", "Hz", positive,
               "of the closed loop with the bare rod; sets all gains",
               pid(&PidSettings::natural_frequency)),
      plain("controller", "derivative_filter", positive,
            "N: the derivative is low-passed at N times the natural frequency",
            pid(&PidSettings::derivative_filter)),
      plain("controller", "setpoint_weight", {0.0, 1.0, true},
            "b: share of the set point in the proportional part",
            pid(&PidSettings::setpoint_weight)),
      plain("controller", "bond_compensation", {0.0, 1.0, true},
            "share of the measured bond force and torque that is fed forward",
            pid(&PidSettings::bond_compensation)),
      quantity("controller", "force_limit", "N", "N", positive,
               "largest force of the actuator along each axis; the default grows with what a press "
               "is expected to take",
               pid(&PidSettings::force_limit)),
      quantity(
          "controller", "torque_limit", "N m", "N m", positive,
          "largest torque of the actuator about each axis; the default grows with force_limit's",
          pid(&PidSettings::torque_limit)),
  };
  for (const auto& part : {adaptation_keys(), force_keys(), external_keys()}) {
    keys.insert(keys.end(), part.begin(), part.end());
  }
  return keys;
}

std::vector<Key> hardware_keys() {
  using lattice::HardwareSettings;
  const auto member = [](auto value) {
    return at(&Config::press, &lattice::PressSetup::hardware, value);
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
  keys.push_back(plain("hardware", "tactile", any,
                       "whether the controller is told about the contact with the plane",
                       member(&HardwareSettings::tactile)));
  keys.push_back(quantity("hardware", "sensor_latency", "ms", "s", not_negative,
                          "age of a measurement when the controller gets it",
                          member(&HardwareSettings::sensor_latency)));
  keys.push_back(quantity("hardware", "actuator_latency", "ms", "s", not_negative,
                          "until a command acts", member(&HardwareSettings::actuator_latency)));
  keys.push_back(quantity("hardware", "force_rate", "N/s", "N/s", not_negative,
                          "largest change of a force component; 0: no limit",
                          member(&HardwareSettings::force_rate)));
  keys.push_back(quantity("hardware", "torque_rate", "N m/s", "N m/s", not_negative,
                          "largest change of a torque component; 0: no limit",
                          member(&HardwareSettings::torque_rate)));
  keys.push_back(plain("hardware", "seed", {0, 1e9, true},
                       "of the sensors' noise: the same seed gives the same run",
                       member(&HardwareSettings::seed)));
  return keys;
}

std::vector<Key> sensor_keys() {
  using lattice::HardwareSettings;
  const auto member = [](auto... way) {
    return at(&Config::press, &lattice::PressSetup::hardware, way...);
  };
  const auto layout = [](auto way) { return at(&Config::taxels, way); };
  Key taxels;
  taxels.section = "sensor";
  taxels.name = "taxels";
  taxels.kind = Kind::fields;
  taxels.or_file = true;
  taxels.preset = "\"none\"";
  taxels.choices = {{"none", "no skin"}};
  taxels.fields = {{"rings", "1", "4", "around the pole, sensor.pitch apart"},
                   {"per_ring", "1", "8", "taxels in each"}};
  taxels.help = "where the taxels are: rings, or a CSV file with columns x [mm],y [mm],z [mm]";
  taxels.rule = "on the surface that may touch, not in the bond";
  taxels.related = {"geometry.shape"};
  taxels.assign = [](Config& config, const Value& value) {
    TaxelLayout& taken = config.taxels;
    taken.file = value.word == "none" ? "" : value.word;
    taken.rings = taken.per_ring = 0;
    for (std::size_t i = 0; i < value.words.size(); ++i)
      (value.words[i] == "rings" ? taken.rings : taken.per_ring) = int(value.numbers[3 * i + 1]);
  };
  std::vector<Key> keys = {
      taxels,
      quantity("sensor", "pitch", "mm", "m", positive,
               "between rings along the surface; auto: a tenth of tip_radius",
               layout(&TaxelLayout::pitch)),
      quantity("sensor", "footprint", "mm", "m", positive,
               "diameter of the disc over which a taxel averages; auto: a tenth of tip_radius",
               layout(&TaxelLayout::footprint)),
      with_rule(quantity("sensor", "depth", "mm", "m", not_negative,
                         "of the taxels below the surface, as in a half space",
                         member(&HardwareSettings::skin, &meshes::TaxelSkin::depth)),
                "0 or at least a tenth of the footprint", {"sensor.footprint"}),
  };
  const auto markers = [](auto way) { return at(&Config::markers, way); };
  const auto of_grid = [](const char* rule, Key key) {
    return only_with("sensor.markers", {"grid"},
                     with_rule(std::move(key), rule, {"sensor.markers"}));
  };
  Key places = plain("sensor", "markers", any,
                     "material points whose displacements markers.csv tells: a grid on the surface "
                     "that may touch, or a CSV file with columns x [mm],y [mm],z [mm]",
                     markers(&MarkerLayout::file));
  places.choices = {{"none", "no markers"},
                    {"grid", "square as seen along the axis, one marker on it"}};
  keys.push_back(with_rule(places, "in the rubber, in the undeformed finger", {"geometry.shape"}));
  keys.push_back(of_grid("at most 10000 markers",
                         quantity("sensor", "marker_pitch", "mm", "m", positive,
                                  "between the markers of a grid; auto: a tenth of tip_radius",
                                  markers(&MarkerLayout::pitch))));
  keys.push_back(of_grid("in the rubber",
                         quantity("sensor", "marker_depth", "mm", "m", not_negative,
                                  "of the markers of a grid below the surface, along its normal",
                                  markers(&MarkerLayout::depth))));
  add_sensor(keys, "noise", "resolution", "Pa", "a taxel's stresses", &HardwareSettings::taxel,
             "sensor");
  keys.push_back(quantity("sensor", "rate", "Hz", "Hz", not_negative,
                          "of new readings, taken when the controller asks; 0: each time",
                          member(&HardwareSettings::taxel_rate)));
  keys.push_back(quantity("sensor", "latency", "ms", "s", not_negative,
                          "age of a reading, besides hardware.sensor_latency",
                          member(&HardwareSettings::taxel_latency)));
  return keys;
}

}  // namespace fingertip::studies::inline config::inline keys
