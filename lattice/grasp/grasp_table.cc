#include <ostream>

#include "lattice/grasp/grasp.h"
#include "meshes/files.h"

namespace fingertip::lattice {

void write_grasp_csv(const std::vector<GraspRow>& rows, const std::filesystem::path& file) {
  meshes::write_atomically(file, [&](std::ostream& out) {
    out << "time [s],phase,height [m],velocity [m/s],tilt [rad],finger_height [m],indentation [m],"
           "support_force [N],load [N],slip [m],normal_force_1 [N],tangential_force_1 [N],"
           "touching_1,sliding_1,normal_force_2 [N],tangential_force_2 [N],touching_2,sliding_2,"
           "point_friction_1 [N],inward_friction_1 [N],point_friction_2 [N],inward_friction_2 "
           "[N]\n";
    for (const GraspRow& row : rows) {
      out << meshes::to_text(row.time) << ',' << name(row.phase);
      for (const double value : {row.height, row.velocity, row.tilt, row.finger_height,
                                 row.indentation, row.support_force, row.load, row.slip}) {
        out << ',' << meshes::to_text(value);
      }
      for (std::size_t i = 0; i < 2; ++i) {
        out << ',' << meshes::to_text(row.normal[i]) << ',' << meshes::to_text(row.tangential[i])
            << ',' << row.touching[i] << ',' << row.sliding[i];
      }
      for (std::size_t i = 0; i < 2; ++i) {
        out << ',' << meshes::to_text(row.point_friction[i]) << ','
            << meshes::to_text(row.inward_friction[i]);
      }
      out << '\n';
    }
  });
}

}  // namespace fingertip::lattice
