#include "lattice/press/press_task.h"

#include "lattice/press/press_deviation.h"
#include "lattice/statics/cut_lattice.h"
#include "meshes/cells/cubic_grid.h"

namespace fingertip::lattice::inline press {

using meshes::Vector3;

Target PressWay::at(const Vector3& start, const meshes::SetPoint& point) const {
  Target target;
  target.pose.position = start + point.distance * direction;
  target.twist.velocity = point.speed * direction;
  target.acceleration.velocity = point.acceleration * direction;
  return target;
}

FingerSetup finger_setup(const PressSetup& setup, const PressWay& way) {
  FingerSetup finger;
  finger.geometry = setup.geometry;
  finger.rubber = setup.rubber;
  finger.lattice = setup.lattice;
  finger.rod = setup.rod;
  finger.contact = {setup.protocol.contact, setup.protocol.friction};
  finger.plane.point = way.plane.point(-setup.protocol.clearance);
  finger.plane.normal = way.plane.normal;
  finger.plane.obstacle = way.plane.obstacle;
  finger.skin = setup.hardware.skin;
  finger.gravity = -setup.gravity * way.plane.normal;
  finger.prescribed = setup.protocol.mode == meshes::DriveMode::quasi_static;
  finger.integrator = setup.integrator;
  finger.time_step = setup.time_step;
  finger.tolerance = setup.tolerance;
  finger.energy_bound = setup.energy_bound;
  finger.threads = setup.threads;
  return finger;
}

int moving_sectors(const PressSetup& setup) {
  const HardwareSettings& hardware = setup.hardware;
  bool noise = false;
  for (const SensorChannel* channel :
       {&hardware.position, &hardware.orientation, &hardware.velocity, &hardware.angular_velocity,
        &hardware.force, &hardware.torque})
    noise = noise || channel->noise > 0.0;
  if (!setup.symmetry || setup.make_controller || noise) return 1;
  return way_symmetry(setup.geometry, setup.lattice, setup.protocol);
}

double moving_particles(const PressSetup& setup) {
  return meshes::expected_particle_count(setup.geometry, setup.lattice.spacing) /
         moving_sectors(setup);
}

FingerSetup pressed_finger(const PressSetup& setup, const PressWay& way) {
  FingerSetup finger = finger_setup(setup, way);
  if (setup.integrator != Integrator::mass_scaled) return finger;
  const ScalingChoice choice = choose_scaling(setup);
  if (choice.scaled) {
    finger.time_step = choice.step;
  } else {
    finger.integrator = Integrator::symplectic_euler;
  }
  return finger;
}

ControlTask control_task(const PressSetup& setup, const PressWay& way, const RodBody& rod) {
  const meshes::PressProtocol& protocol = setup.protocol;
  ControlTask task;
  task.taxels = setup.hardware.skin.taxels;
  task.period = setup.controller.period;
  task.inertia = rod.inertia_at_endpoint();
  task.force_limit = setup.controller.force_limit;
  task.torque_limit = setup.controller.torque_limit;
  task.normal = way.plane.normal;
  task.clearance = protocol.clearance;
  task.depth = protocol.depth;
  task.speed = protocol.speed;
  task.path = [start = rod.endpoint, way, motion = meshes::PressMotion(protocol)](double time) {
    return way.at(start, motion.at(time));
  };
  return task;
}

}  // namespace fingertip::lattice::inline press
