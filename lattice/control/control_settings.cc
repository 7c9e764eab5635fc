#include "lattice/control/control_settings.h"

#include <cmath>

#include "meshes/base/files.h"

namespace fingertip::lattice::inline control {

namespace {

/// Collects what breaks a rule.
class Rules {
 public:
  void require(bool holds, const char* key, double value, const char* rule, const char* remedy) {
    if (!holds) found.push_back({key, meshes::to_text(value), rule, remedy});
  }
  void positive(const char* key, double value) {
    require(std::isfinite(value) && value > 0.0, key, value, "must be finite and positive",
            "give such a value");
  }
  void not_negative(const char* key, double value) {
    require(std::isfinite(value) && value >= 0.0, key, value, "must be finite and not negative",
            "give such a value");
  }
  std::vector<meshes::Violation> found;
};

}  // namespace

std::vector<meshes::Violation> PidSettings::violations() const {
  Rules rules;
  rules.positive("controller.period", period);
  rules.positive("controller.natural_frequency", natural_frequency);
  rules.positive("controller.derivative_filter", derivative_filter);
  rules.require(bond_compensation >= 0.0 && bond_compensation <= 1.0,
                "controller.bond_compensation", bond_compensation,
                "the share of the measured wrench fed forward must lie between 0 and 1",
                "1 cancels the tip's pull on the rod, 0 leaves it to the integrator");
  rules.require(setpoint_weight >= 0.0 && setpoint_weight <= 1.0, "controller.setpoint_weight",
                setpoint_weight,
                "the share of the set point in the proportional part must lie between 0 and 1",
                "1 answers a set point like an error, 0 spares the actuator");
  rules.positive("controller.force_limit", force_limit);
  rules.positive("controller.torque_limit", torque_limit);
  return rules.found;
}

std::vector<meshes::Violation> AdaptiveSettings::violations() const {
  Rules rules;
  rules.require(sensitivity >= 1.2 && sensitivity <= 3.0, "controller.sensitivity", sensitivity,
                "must lie between 1.2 and 3",
                "2 is a common choice; less is slower, more is nervous");
  rules.positive("controller.memory", memory);
  rules.positive("controller.force_noise", force_noise);
  return rules.found;
}

std::vector<meshes::Violation> ForceSettings::violations() const {
  Rules rules;
  rules.positive("controller.force", force);
  rules.positive("controller.force_bandwidth", bandwidth);
  rules.positive("controller.touch_force", touch_force);
  rules.not_negative("controller.release_force", release_force);
  rules.require(release_force < touch_force, "controller.release_force", release_force,
                "must be less than controller.touch_force, or noise switches to and fro",
                "half of it leaves room for noise");
  rules.require(touch_force < force, "controller.touch_force", touch_force,
                "must be less than controller.force, or the touch is never noticed",
                "a tenth of it, but more than the sensor's noise");
  rules.not_negative("controller.confirmation", confirmation);
  rules.not_negative("controller.dwell", dwell);
  return rules.found;
}

}  // namespace fingertip::lattice::inline control
