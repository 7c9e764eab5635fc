#include "lattice/press/trace.h"

#include "meshes/tables/table_rows.h"

namespace fingertip::lattice::inline press {

void write_trace_csv(const std::vector<TraceRow>& trace, const std::filesystem::path& file) {
  meshes::write_rows(trace, file);
}

}  // namespace fingertip::lattice::inline press
