/// LAMMPS itself, Debian's `lmp`.
#pragma once

#include <filesystem>
#include <string>

#include "studies/exchange/lammps_output.h"

namespace fingertip::studies {

/// Runs lattice.in in `folder` on `ranks` MPI processes of one thread each and waits. Throws
/// InvalidInput when `program` or mpirun is not installed, std::runtime_error when LAMMPS fails,
/// with what it said.
LammpsTiming run_lammps(const std::filesystem::path& folder, int ranks = 1,
                        const std::string& program = "lmp");

}  // namespace fingertip::studies
