/// Fields for ParaView, from all processes into one file. deal.II's side.
#pragma once

#include <deal.II/numerics/data_out.h>

#include <filesystem>

namespace fingertip::fem_reference::inline output {

/// Compressed as fast as can be.
dealii::DataOutBase::VtkFlags fast_vtu();

/// Writes built patches to `file`, through a temporary name. All processes of MPI_COMM_WORLD call
/// it together.
void write_vtu(dealii::DataOut<3>& out, const std::filesystem::path& file);

}  // namespace fingertip::fem_reference::inline output
