/// How fingertip-fem is started: alone, or as several MPI ranks under mpirun.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace fingertip::studies {

/// A program with its arguments and what is added to the environment.
struct FemCommand {
  std::vector<std::string> words;        ///< absolute path first
  std::vector<std::string> environment;  ///< "NAME=value"
  bool under_mpirun = false;
};

/// `program` on `folder`: by itself with `threads` threads when `ranks` is 1, else as `ranks` ranks
/// with one thread each. Throws InvalidInput when the program, or mpirun, is not there.
FemCommand fem_command(const std::filesystem::path& program, const std::filesystem::path& folder,
                       int threads, int ranks);

/// Starts it in a process group of its own, without standard input, its output going to the two
/// file descriptors. It gets SIGTERM when the calling thread ends.
pid_t start_process(const FemCommand& command, int out, int err);

/// The processes whose parent is `parent`: of mpirun, the ranks.
std::vector<pid_t> children_of(pid_t parent);

}  // namespace fingertip::studies
