#include "fem_reference/output/vtu_output.h"

#include <deal.II/base/mpi.h>

#include <ostream>

#include "fem_reference/job/processes.h"
#include "meshes/base/files.h"

namespace fingertip::fem_reference::inline output {

dealii::DataOutBase::VtkFlags fast_vtu() {
  dealii::DataOutBase::VtkFlags flags;
  flags.compression_level = decltype(flags.compression_level)::best_speed;
  return flags;
}

void write_vtu(dealii::DataOut<3>& out, const std::filesystem::path& file) {
  out.set_flags(fast_vtu());
  // MPI's files leave traces of their own in its folder of the session, where processes that end
  // meanwhile remove them.
  if (dealii::Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
    return meshes::write_atomically(file, [&](std::ostream& text) { out.write_vtu(text); });
  const std::filesystem::path partial = file.string() + ".partial";
  out.write_vtu_in_parallel(partial.string(), MPI_COMM_WORLD);
  MPI_Barrier(MPI_COMM_WORLD);
  if (first_process()) std::filesystem::rename(partial, file);
}

}  // namespace fingertip::fem_reference::inline output
