#include "studies/control/c_structs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

namespace fingertip::studies::inline control {

using lattice::ControllerFailed;
using meshes::Vector3;

namespace {

void put(const Vector3& from, double* to) {
  std::copy(from.data(), from.data() + 3, to);
}

Vector3 vector(const double* from) {
  return {from[0], from[1], from[2]};
}

fingertip_pose c_pose(const lattice::Pose& pose) {
  const Eigen::Quaterniond& q = pose.orientation;
  fingertip_pose c{{}, {q.w(), q.x(), q.y(), q.z()}};
  put(pose.position, c.position);
  return c;
}

fingertip_twist c_twist(const lattice::Twist& twist) {
  fingertip_twist c{};
  put(twist.velocity, c.velocity);
  put(twist.angular_velocity, c.angular_velocity);
  return c;
}

fingertip_wrench c_wrench(const lattice::Wrench& wrench) {
  fingertip_wrench c{};
  put(wrench.force, c.force);
  put(wrench.torque, c.torque);
  return c;
}

lattice::Twist twist_of(const fingertip_twist& c) {
  return {vector(c.velocity), vector(c.angular_velocity)};
}

lattice::Target target_of(const fingertip_target& c) {
  lattice::Target target;
  const double* q = c.pose.orientation;
  target.pose = {vector(c.pose.position), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
  target.twist = twist_of(c.twist);
  target.acceleration = twist_of(c.acceleration);
  return target;
}

void check(const lattice::Wrench& wrench) {
  if (!finite(wrench)) {
    throw ControllerFailed("the controller commanded a wrench that is not finite");
  }
}

void check(const lattice::Target& target) {
  if (!finite(target)) {
    throw ControllerFailed("the controller commanded a target that is not finite");
  }
  if (!(std::abs(target.pose.orientation.norm() - 1.0) <= 1e-6)) {
    throw ControllerFailed(
        "the controller commanded an orientation that is no quaternion of length one (w, x, y, z)");
  }
}

}  // namespace

const lattice::Command& checked(const lattice::Command& command) {
  std::visit([](const auto& value) { check(value); }, command);
  return command;
}

// A skin is handed over as it is.
static_assert(sizeof(fingertip_taxel) == sizeof(meshes::Taxel) &&
              offsetof(fingertip_taxel, normal) == offsetof(meshes::Taxel, normal) &&
              offsetof(fingertip_taxel, area) == offsetof(meshes::Taxel, area));
static_assert(sizeof(fingertip_taxel_reading) == sizeof(meshes::TaxelReading) &&
              offsetof(fingertip_taxel_reading, shear_u) ==
                  offsetof(meshes::TaxelReading, shear_u) &&
              offsetof(fingertip_taxel_reading, shear_v) ==
                  offsetof(meshes::TaxelReading, shear_v));

fingertip_task c_task(const lattice::ControlTask& task) {
  fingertip_task c{};
  c.size = sizeof c;
  c.abi = FINGERTIP_CONTROLLER_ABI;
  c.period = task.period;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) c.inertia[6 * i + j] = task.inertia(i, j);
  c.force_limit = task.force_limit;
  c.torque_limit = task.torque_limit;
  put(task.normal, c.normal);
  c.clearance = task.clearance;
  c.depth = task.depth;
  c.speed = task.speed;
  c.taxel_count = task.taxels.size();
  c.taxels = reinterpret_cast<const fingertip_taxel*>(task.taxels.data());
  return c;
}

fingertip_measurement c_measurement(const lattice::Measurement& m,
                                    const lattice::ControlTask& task) {
  fingertip_measurement c{};
  c.size = sizeof c;
  c.abi = FINGERTIP_CONTROLLER_ABI;
  c.time = m.time;
  c.pose = c_pose(m.pose);
  c.twist = c_twist(m.twist);
  c.wrench = c_wrench(m.wrench);
  if (m.contact) {
    c.has_contact = 1;
    c.touching = m.contact->touching;
    c.contact_radius = m.contact->radius;
    c.on_tip = c_wrench(m.contact->on_tip);
  }
  c.taxel_count = m.taxels.size();
  c.taxels = reinterpret_cast<const fingertip_taxel_reading*>(m.taxels.data());
  if (task.path) {
    const lattice::Target wanted = task.path(m.time);
    c.has_set_point = 1;
    c.set_point = {c_pose(wanted.pose), c_twist(wanted.twist), c_twist(wanted.acceleration)};
  }
  return c;
}

fingertip_command empty_c_command() {
  fingertip_command c{};
  c.size = sizeof c;
  c.abi = FINGERTIP_CONTROLLER_ABI;
  return c;
}

lattice::Command command_of(const fingertip_command& c) {
  switch (c.kind) {
    case FINGERTIP_COMMAND_WRENCH:
      return checked(lattice::Wrench{vector(c.wrench.force), vector(c.wrench.torque)});
    case FINGERTIP_COMMAND_TARGET: return checked(target_of(c.target));
    default:
      throw ControllerFailed("the controller answered with a command of kind " +
                             std::to_string(c.kind) + "; 1 (wrench) and 2 (target) exist");
  }
}

}  // namespace fingertip::studies::inline control
