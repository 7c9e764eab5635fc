/// What LAMMPS leaves behind: its log and its dump.
#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "meshes/shape/geometry.h"

namespace fingertip::studies {

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

/// Positions and velocities of atoms 1 ... n at one step.
struct LammpsFrame {
  long step = 0;
  std::vector<meshes::Vector3> position, velocity;  ///< [m], [m/s]
};

/// Reads a custom dump with the columns id x y z vx vy vz, in any order of columns and rows, frame
/// by frame.
class LammpsDump {
 public:
  /// `masses`: n. Throws InvalidInput when the file cannot be read.
  LammpsDump(const std::filesystem::path& file, std::size_t masses);

  /// The next frame; nothing at the end, also when the file breaks off inside a frame, as that of
  /// a run that was killed. Throws InvalidInput for a frame of something else, numbers that are not
  /// finite and steps that do not increase.
  std::optional<LammpsFrame> next();
  bool broke_off() const { return broke_off_; }

 private:
  bool line();
  bool read_head(LammpsFrame& frame);
  void read_columns();
  bool read_rows(LammpsFrame& frame);
  [[noreturn]] void refuse(const std::string& rule) const;

  std::filesystem::path file_;
  std::ifstream in_;
  std::size_t masses_;
  std::string line_;
  std::vector<int> columns_;  ///< per column its place among id x y z vx vy vz, -1: not needed
  long last_step_ = -1;       ///< of the frame before
  bool broke_off_ = false;
};

}  // namespace fingertip::studies
