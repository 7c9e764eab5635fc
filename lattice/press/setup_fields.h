/// The members of a lattice press's settings (meshes/press/fields.h).
#pragma once

#include "lattice/press/press_setup.h"
#include "meshes/press/fields.h"

namespace fingertip::lattice::inline press {

FINGERTIP_FIELDS(SpringConstants, k1, k2, k3, kappa);

FINGERTIP_FIELDS(LatticeSettings, model, kinematics, spacing, offset, axes, constants,
                 ligament_stiffness, contact_stiffness);

FINGERTIP_FIELDS(RodSettings, density);

FINGERTIP_FIELDS(PidSettings, period, natural_frequency, derivative_filter, setpoint_weight,
                 bond_compensation, force_limit, torque_limit);

/// A schedule is a function: whoever has read it tells what it is.
FINGERTIP_FIELDS_BUT((stiffness), AdaptiveSettings, sensitivity, relay, estimate, memory,
                     force_noise);

/// A schedule is a function: whoever has read it tells what it is.
FINGERTIP_FIELDS_BUT((stiffness), ForceSettings, force, bandwidth, touch_force, release_force,
                     confirmation, dwell);

/// The unit is that of what is measured.
FINGERTIP_FIELDS(SensorChannel, noise, resolution);

FINGERTIP_FIELDS(HardwareSettings, position, orientation, velocity, angular_velocity, force, torque,
                 tactile, skin, taxel, taxel_rate, taxel_latency, sensor_latency, actuator_latency,
                 force_rate, torque_rate, seed);

/// What a result depends on: not the threads, and a maker of controllers is its identity.
FINGERTIP_FIELDS_BUT((make_controller, threads), PressSetup, geometry, rubber, protocol, lattice,
                     rod, controller, controller_identity, follows_path, hardware, duration,
                     gravity, integrator, time_step, tolerance, energy_bound, slopes, symmetry);

}  // namespace fingertip::lattice::inline press
