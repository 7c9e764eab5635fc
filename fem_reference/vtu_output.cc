#include "fem_reference/vtu_output.h"

#include "fem_reference/run_progress.h"

namespace fingertip::fem_reference {

void write_vtu(dealii::DataOut<3>& out, const std::filesystem::path& file) {
  dealii::DataOutBase::VtkFlags flags;
  flags.compression_level = dealii::DataOutBase::VtkFlags::best_speed;
  out.set_flags(flags);
  const std::filesystem::path partial = file.string() + ".partial";
  out.write_vtu_in_parallel(partial.string(), MPI_COMM_WORLD);
  MPI_Barrier(MPI_COMM_WORLD);
  if (first_process()) std::filesystem::rename(partial, file);
}

}  // namespace fingertip::fem_reference
