#include "lattice/grasp/grasp_table.h"

#include "meshes/tables/table_rows.h"

namespace fingertip::lattice::inline grasp {

void write_grasp_csv(const std::vector<GraspRow>& rows, const std::filesystem::path& file) {
  meshes::write_rows(rows, file);
}

}  // namespace fingertip::lattice::inline grasp
