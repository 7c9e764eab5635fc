/// How fingertip-fem is started: alone, or as several MPI ranks under mpirun.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <vector>

#include "studies/files/process.h"

namespace fingertip::studies::inline jobs {

struct FemCommand : Command {
  bool under_mpirun = false;
};

/// `program` on `folder`: by itself with `threads` threads when `ranks` is 1, else as `ranks` ranks
/// with one thread each. Throws InvalidInput when the program, or mpirun, is not there.
FemCommand fem_command(const std::filesystem::path& program, const std::filesystem::path& folder,
                       int threads, int ranks);

/// The processes whose parent is `parent`: of mpirun, the ranks.
std::vector<pid_t> children_of(pid_t parent);

}  // namespace fingertip::studies::inline jobs
