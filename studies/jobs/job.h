/// A computation with files as its result, recognisable by its inputs.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "meshes/base/errors.h"

namespace fingertip::studies::inline jobs {

struct PlannedJob;

/// What a job may use while it runs.
struct JobContext {
  /// Tells how far the job is (0 ... 1); false: stop, keep what is finished, throw Interrupted.
  std::function<bool(double fraction, const std::string& stage)> report;
  std::function<void(const std::string& line)> log;
  int threads = 1;
  int ranks = 1;  ///< MPI processes of the continuum
  /// Carries out further jobs, named beside this one in the run folder, as a session does: from the
  /// cache where it knows them, several at a time. Their folders; throws as they do.
  std::function<std::vector<std::filesystem::path>(const std::vector<PlannedJob>&)> run_all = {};
};

/// A process that did the work was lost (killed, out of memory, crashed). Ends a program like
/// NotConverged, with 3, but says nothing about the problem that was to be solved: never remembered
/// as a result.
class ProcessLost : public meshes::NotConverged {
  using meshes::NotConverged::NotConverged;
};

/// Expected shares of the work: a lattice press in time at R/12 is 10.
inline constexpr double moduli_weight = 0.1, surrogate_weight = 5.0, fit_weight = 10.0,
                        reference_weight = 40.0, meridian_weight = 2.0;

/// `inputs` holds only what the result depends on, so that equal inputs mean equal results.
struct Job {
  std::string kind;               ///< "press", "reference", "moduli", "cubes"
  nlohmann::ordered_json inputs;  ///< SI
  std::string source_hash;        ///< of the folders whose code makes the result
  std::function<void(const std::filesystem::path& folder, const JobContext& context)> run;
  double weight = 1.0;  ///< expected share of the work, for the progress bar
  /// `run` goes on from what an earlier attempt at the equal job left in the folder.
  bool resumable = false;
  /// false: equal inputs may give another result, so that it is neither kept nor looked for in the
  /// cache.
  bool repeatable = true;

  /// SHA-256 over kind, inputs and source hash.
  std::string key() const;
};

/// A job with its place in the run folder.
struct PlannedJob {
  std::string name;  ///< shown to the user; also the sub-folder, "" for the run folder itself
  Job job;
  /// An exhibit may fail to converge without failing the run: its status says so.
  bool exhibit = false;
};

}  // namespace fingertip::studies::inline jobs
