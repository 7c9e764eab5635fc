/// One run of a verb: its folder, progress and cache, and the jobs in it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "studies/jobs/cache.h"
#include "studies/jobs/job.h"
#include "studies/jobs/progress.h"
#include "studies/jobs/run_folder.h"

namespace fingertip::studies::inline jobs {

struct JobResult {
  std::string name;
  std::string status;      ///< "finished", or "not converged: why" for an exhibit
  bool reused = false;     ///< from the cache or from the resumed folder
  double wall_time = 0.0;  ///< [s]
  bool ok() const { return status == finished; }
};

class Session {
 public:
  /// `threads` > 0: cores the jobs may use together. `ranks` > 0: MPI processes of a continuum.
  Session(RunFolder& folder, Progress& progress, Cache cache, int threads, int ranks = 1)
      : folder_(folder),
        progress_(progress),
        cache_(std::move(cache)),
        threads_(threads),
        ranks_(ranks) {}

  /// Fetches or runs one job with all threads. A resumable job that ended early in this folder goes
  /// on from there. Throws what the job throws (NotConverged not for an
  /// exhibit); a failed job leaves what it had.
  JobResult run(const PlannedJob& planned);

  /// Runs all jobs, as many at a time as there are threads, one thread each, in the given order.
  /// After the first failure no further job starts; it is thrown when the running ones have ended.
  std::vector<JobResult> run_all(const std::vector<PlannedJob>& planned);

  /// What jobs of later stages will weigh, for the progress.
  void expect_later(double weight) { progress_.expect_later(weight); }

  const Cache& cache() const { return cache_; }
  RunFolder& folder() { return folder_; }
  std::filesystem::path path_of(const PlannedJob& planned) const {
    return planned.name.empty() ? folder_.path() : folder_.path() / planned.name;
  }

 private:
  JobResult run_with(const PlannedJob& planned, int threads);
  bool reuse(const PlannedJob& planned, JobResult& result);
  /// Puts the cache's result in the place of whatever is in the job's folder. False, and all as it
  /// was, when the cache has none.
  bool fetch(const PlannedJob& planned) const;
  void compute(const PlannedJob& planned, JobResult& result, int threads);
  /// Empties the job's folder, apart from what belongs to the run.
  void clear(const PlannedJob& planned) const;

  RunFolder& folder_;
  Progress& progress_;
  Cache cache_;
  int threads_;
  int ranks_;
};

/// Calls `work` with 0 ... count - 1 in that order, as many at a time as `threads`, or one. After
/// the first failure, or Ctrl-C, no further one starts; it is thrown (Interrupted) when the running
/// ones have ended.
void side_by_side(std::size_t count, int threads, const std::function<void(std::size_t)>& work);

}  // namespace fingertip::studies::inline jobs
