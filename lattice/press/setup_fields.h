/// The members of a lattice press's settings by name and unit (meshes/press/fields.h).
#pragma once

#include "lattice/press/press_setup.h"
#include "meshes/press/fields.h"

namespace fingertip::lattice::inline press {

using meshes::Fields;

template <Fields<SpringConstants> T>
void visit_fields(T& constants, auto&& visit) {
  auto& [k1, k2, k3, kappa] = constants;
  visit("k1", k1, "N/m");
  visit("k2", k2, "N/m");
  visit("k3", k3, "N/m");
  visit("kappa", kappa, "Pa");
}

template <Fields<LatticeSettings> T>
void visit_fields(T& lattice, auto&& visit) {
  auto& [model, kinematics, spacing, offset, axes, constants, ligament_stiffness,
         contact_stiffness] = lattice;
  visit("model", model, "");
  visit("kinematics", kinematics, "");
  visit("spacing", spacing, "m");
  visit("offset", offset, "");
  visit("axes", axes, "");
  visit("constants", constants, "");
  visit("ligament_stiffness", ligament_stiffness, "");
  visit("contact_stiffness", contact_stiffness, "");
}

template <Fields<RodSettings> T>
void visit_fields(T& rod, auto&& visit) {
  auto& [density] = rod;
  visit("density", density, "kg/m^3");
}

template <Fields<PidSettings> T>
void visit_fields(T& pid, auto&& visit) {
  auto& [period, natural_frequency, derivative_filter, setpoint_weight, bond_compensation,
         force_limit, torque_limit] = pid;
  visit("period", period, "s");
  visit("natural_frequency", natural_frequency, "Hz");
  visit("derivative_filter", derivative_filter, "");
  visit("setpoint_weight", setpoint_weight, "");
  visit("bond_compensation", bond_compensation, "");
  visit("force_limit", force_limit, "N");
  visit("torque_limit", torque_limit, "N m");
}

/// A schedule is a function: whoever has read it tells what it is.
template <Fields<AdaptiveSettings> T>
void visit_fields(T& adaptive, auto&& visit) {
  auto& [sensitivity, relay, estimate, memory, force_noise, stiffness] = adaptive;
  visit("sensitivity", sensitivity, "");
  visit("relay", relay, "");
  visit("estimate", estimate, "");
  visit("memory", memory, "s");
  visit("force_noise", force_noise, "N");
}

/// A schedule is a function: whoever has read it tells what it is.
template <Fields<ForceSettings> T>
void visit_fields(T& settings, auto&& visit) {
  auto& [force, bandwidth, touch_force, release_force, confirmation, dwell, stiffness] = settings;
  visit("force", force, "N");
  visit("bandwidth", bandwidth, "Hz");
  visit("touch_force", touch_force, "N");
  visit("release_force", release_force, "N");
  visit("confirmation", confirmation, "s");
  visit("dwell", dwell, "s");
}

/// The unit is that of what is measured.
template <Fields<SensorChannel> T>
void visit_fields(T& channel, auto&& visit) {
  auto& [noise, resolution] = channel;
  visit("noise", noise, "");
  visit("resolution", resolution, "");
}

template <Fields<HardwareSettings> T>
void visit_fields(T& hardware, auto&& visit) {
  auto& [position, orientation, velocity, angular_velocity, force, torque, tactile, sensor_latency,
         actuator_latency, force_rate, torque_rate, seed] = hardware;
  visit("position", position, "m");
  visit("orientation", orientation, "rad");
  visit("velocity", velocity, "m/s");
  visit("angular_velocity", angular_velocity, "rad/s");
  visit("force", force, "N");
  visit("torque", torque, "N m");
  visit("tactile", tactile, "");
  visit("sensor_latency", sensor_latency, "s");
  visit("actuator_latency", actuator_latency, "s");
  visit("force_rate", force_rate, "N/s");
  visit("torque_rate", torque_rate, "N m/s");
  visit("seed", seed, "");
}

/// What a result depends on: not the threads, and a maker of controllers is its identity.
template <Fields<PressSetup> T>
void visit_fields(T& setup, auto&& visit) {
  auto& [geometry, rubber, protocol, lattice, rod, controller, make_controller, controller_identity,
         follows_path, hardware, duration, gravity, integrator, time_step, tolerance, energy_bound,
         threads, symmetry] = setup;
  visit("geometry", geometry, "");
  visit("rubber", rubber, "");
  visit("protocol", protocol, "");
  visit("lattice", lattice, "");
  visit("rod", rod, "");
  visit("controller", controller, "");
  visit("controller_identity", controller_identity, "");
  visit("follows_path", follows_path, "");
  visit("hardware", hardware, "");
  visit("duration", duration, "s");
  visit("gravity", gravity, "m/s^2");
  visit("integrator", integrator, "");
  visit("time_step", time_step, "s");
  visit("tolerance", tolerance, "");
  visit("energy_bound", energy_bound, "");
  visit("symmetry", symmetry, "");
}

constexpr auto values(ModelKind) {
  return std::array{ModelKind::published, ModelKind::central, ModelKind::hookean,
                    ModelKind::network};
}
constexpr auto values(Kinematics) {
  return std::array{Kinematics::small, Kinematics::finite};
}
constexpr auto values(Integrator) {
  return std::array{Integrator::symplectic_euler, Integrator::explicit_euler,
                    Integrator::runge_kutta, Integrator::mass_scaled,
                    Integrator::energy_controlled};
}

}  // namespace fingertip::lattice::inline press
