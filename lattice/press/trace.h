/// The trace of a press: trace.csv.
#pragma once

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

consteval auto fields_of(const TraceRow*) {
  return FINGERTIP_ALL_MEMBERS(TraceRow, time, indentation, commanded_speed, speed, tilt,
                               normal_force, lateral_force, torque, command_force, plane_force,
                               contact_stiffness, wanted_force, force_mode, anchored, sliding,
                               kinetic_energy, rod_kinetic_energy, elastic_energy)
      .called("kinetic_energy", "particles_kinetic_energy")
      .in("s", "time")
      .in("m", "indentation")
      .in("m/s", "commanded_speed speed")
      .in("rad", "tilt")
      .in("N", "normal_force lateral_force command_force plane_force wanted_force")
      .in("N m", "torque")
      .in("N/m", "contact_stiffness")
      .in("J", "particles_kinetic_energy rod_kinetic_energy elastic_energy")
      .newer("contact_stiffness wanted_force force_mode");
}

}  // namespace fingertip::lattice::inline press
