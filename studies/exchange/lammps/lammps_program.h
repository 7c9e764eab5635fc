/// LAMMPS itself, Debian's `lmp`.
#pragma once

#include <filesystem>
#include <string>

namespace fingertip::studies::inline exchange::inline lammps {

/// Of the last run in a log.
struct LammpsTiming {
  double loop_time = 0.0;  ///< wall time of the steps, dumps included [s]
  int ranks = 1;           ///< MPI processes
  long steps = 0;
  std::size_t atoms = 0;  ///< anchors included
  /// Processor time over wall time per rank, at most 1: less when other programs had the cores.
  double processor_share = 1.0;
  std::string version;  ///< "29 Sep 2021 - Update 2"; empty where the log does not tell

  /// Wall time per spring and step [ns]; divided among all ranks, not per rank.
  double ns_per_spring_step(std::size_t springs) const {
    return 1e9 * loop_time / (double(steps) * double(springs));
  }
};

/// "Loop time of T on P procs for S steps with N atoms", "U% CPU use with ..." and the version in
/// the first line. Throws InvalidInput when the file cannot be read, its numbers make no sense, or
/// LAMMPS has not come to the end of a run; then with the error it told.
LammpsTiming read_lammps_log(const std::filesystem::path& file);

/// Runs lattice.in in `folder` on `ranks` MPI processes of one thread each and waits. Throws
/// InvalidInput when `program` or mpirun is not installed, std::runtime_error when LAMMPS fails,
/// with what it said.
LammpsTiming run_lammps(const std::filesystem::path& folder, int ranks = 1,
                        const std::string& program = "lmp");

}  // namespace fingertip::studies::inline exchange::inline lammps
