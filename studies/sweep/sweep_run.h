/// Computing the points of a shard.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "studies/jobs/job.h"
#include "studies/sweep/sweep.h"

namespace fingertip::studies::inline sweep {

inline constexpr const char* sweep_file = "sweep.json";

/// How a point ended.
struct PointResult {
  std::string id;
  std::string status;  ///< "finished", "not converged: why", "failed: why", "at work elsewhere"
  bool reused = false;
};

/// A point and its computation.
struct PlannedPoint {
  SweepPoint point;
  Job job;
};

/// The computations of these points. Throws ConfigError for bad input, NotConverged when a fit of
/// constants fails, as the verb would, before anything is computed.
std::vector<PlannedPoint> plan(const Sweep& sweep, const std::vector<SweepPoint>& points);

/// Writes sweep.json into `folder`, which lists all points. Throws ConfigError when the folder
/// belongs to another sweep or to something else.
void claim_folder(const Sweep& sweep, const std::filesystem::path& folder);

/// Computes `points`, each in a run folder of its own, FOLDER/points/ID; what is finished there is
/// kept, so the same call after a kill goes on where it was. Several processes may work in one
/// folder: a point that another one has locked is left to it. As many points at a time as
/// `threads`. A point that fails does not keep the others from being computed. `tell` is called
/// after each, by one thread at a time. Throws Interrupted.
std::vector<PointResult> run_points(const Sweep& sweep, const std::vector<PlannedPoint>& points,
                                    const std::filesystem::path& folder, int threads,
                                    const std::vector<std::string>& command_line,
                                    const std::function<void(const PointResult&)>& tell);

}  // namespace fingertip::studies::inline sweep
