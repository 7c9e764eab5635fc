/// Kernels and peers, measured in turns.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/bench/plan.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline bench {

/// One benchmark of fingertip-kernels in one round, by NAME/isa:ISA/precision:P/threads:N/size:N.
struct KernelSample {
  std::string name, isa, precision;
  int threads = 1, size = 0;
  double masses = 0.0, springs = 0.0;
  double operations = 0.0;  ///< per spring, 0 where not counted
  double cache = 0.0;       ///< of a bandwidth's probe: how large that cache is [bytes]
  double bytes = 0.0;       ///< memory that a part of a step touches; 0 where not told
  /// Per spring and step [ns], for probes per operation or byte, for parts per step. With one
  /// thread processor time, which others on the machine disturb least; with more wall time.
  double cost = 0.0;
  double wall_cost = 0.0;  ///< [ns]
};

/// Everything measured in one round.
using KernelRound = std::map<std::string, KernelSample>;

/// The samples in the file that Google Benchmark has written. Throws InvalidInput when it is
/// damaged.
KernelRound read_kernel_round(const std::filesystem::path& file);

/// What the rounds saw: all samples, LAMMPS and Bullet among them ("lammps_harmonic",
/// "bullet_soft_body"), and why what is missing is missing.
struct KernelRounds {
  std::vector<KernelRound> rounds;
  std::map<std::string, std::string> missing;  ///< program → why
  std::map<std::string, std::string> versions;
};

/// Measures in `folder`, which keeps every program's output. `context` learns how far it is.
KernelRounds measure_kernels(const BenchPlan& plan, const std::filesystem::path& folder,
                             const JobContext& context);

double median(std::vector<double> values);

}  // namespace fingertip::studies::inline bench
