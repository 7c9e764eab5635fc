/// The trace of a press: trace.csv.
#pragma once

#include "meshes/press/press_response.h"
#include "meshes/tables/file_fields.h"

namespace fingertip::lattice::inline press {

/// One row of trace.csv, taken once per controller period. SI; vectors in the rod's starting axes.
struct TraceRow {
  double time = 0.0;             ///< [s]
  double indentation = 0.0;      ///< negative before contact [m]
  double commanded_speed = 0.0;  ///< set-point of the approach speed [m/s]
  double speed = 0.0;            ///< approach speed of the rod's endpoint [m/s]
  double tilt = 0.0;             ///< angle between the rod's axis and its start [rad]
  double normal_force = 0.0;     ///< bond force on the rod along the plane normal [N]
  double lateral_force = 0.0;    ///< magnitude of the bond force in the plane [N]
  double torque = 0.0;           ///< magnitude of the bond torque about the endpoint [N m]
  double command_force = 0.0;    ///< controller's force along the approach direction [N]
  double plane_force = 0.0;      ///< reaction of the plane along its normal [N]
  double contact_stiffness = meshes::unknown;  ///< as the controller takes it to be [N/m]
  double wanted_force = meshes::unknown;       ///< contact force the controller wants [N]
  bool force_mode = false;                     ///< whether it controls the contact force
  int anchored = 0;             ///< boundary particles, or points of the true surface, on the plane
  int sliding = 0;              ///< of these (contact coulomb)
  double kinetic_energy = 0.0;  ///< of the particles [J]
  double rod_kinetic_energy = 0.0;  ///< [J]
  double elastic_energy = 0.0;      ///< of springs, cells, bond and contact [J]
};

constexpr auto fields_of(const TraceRow*) {
  using meshes::field, meshes::Presence;
  using Row = TraceRow;
  return std::tuple{field("time [s]", &Row::time),
                    field("indentation [m]", &Row::indentation),
                    field("commanded_speed [m/s]", &Row::commanded_speed),
                    field("speed [m/s]", &Row::speed),
                    field("tilt [rad]", &Row::tilt),
                    field("normal_force [N]", &Row::normal_force),
                    field("lateral_force [N]", &Row::lateral_force),
                    field("torque [N m]", &Row::torque),
                    field("command_force [N]", &Row::command_force),
                    field("plane_force [N]", &Row::plane_force),
                    field("contact_stiffness [N/m]", &Row::contact_stiffness, Presence::newer),
                    field("wanted_force [N]", &Row::wanted_force, Presence::newer),
                    field("force_mode", &Row::force_mode, Presence::newer),
                    field("anchored", &Row::anchored),
                    field("sliding", &Row::sliding),
                    field("particles_kinetic_energy [J]", &Row::kinetic_energy),
                    field("rod_kinetic_energy [J]", &Row::rod_kinetic_energy),
                    field("elastic_energy [J]", &Row::elastic_energy)};
}

}  // namespace fingertip::lattice::inline press
