#include <cmath>
#include <ostream>

#include "lattice/press/press.h"
#include "meshes/files.h"

namespace fingertip::lattice {

void write_trace_csv(const std::vector<TraceRow>& trace, const std::filesystem::path& file) {
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "time [s],indentation [m],commanded_speed [m/s],speed [m/s],tilt [rad],"
           "normal_force [N],lateral_force [N],torque [N m],command_force [N],plane_force [N],"
           "contact_stiffness [N/m],wanted_force [N],force_mode,"
           "anchored,sliding,particles_kinetic_energy [J],rod_kinetic_energy [J],"
           "elastic_energy [J]\n";
    for (const TraceRow& row : trace) {
      for (const double value :
           {row.time, row.indentation, row.commanded_speed, row.speed, row.tilt, row.normal_force,
            row.lateral_force, row.torque, row.command_force, row.plane_force,
            row.contact_stiffness, row.wanted_force}) {
        out << (std::isnan(value) ? "" : meshes::to_text(value)) << ',';
      }
      out << int(row.force_mode) << ',' << row.anchored << ',' << row.sliding << ','
          << meshes::to_text(row.kinetic_energy) << ',' << meshes::to_text(row.rod_kinetic_energy)
          << ',' << meshes::to_text(row.elastic_energy) << '\n';
    }
  });
}

}  // namespace fingertip::lattice
