/// Finished jobs, kept by content for the next run that asks the same.
#pragma once

#include <filesystem>

#include "studies/jobs/job.h"

namespace fingertip::studies::inline jobs {

/// Status of a job that went well.
inline constexpr const char* finished = "finished";

/// The status in the marker that `folder` holds for `job`; empty when the job has not run there to
/// its end, or another one has, or a file is not as it was written (see result_files.h).
std::string marked_status(const Job& job, const std::filesystem::path& folder);

/// Whether `folder` holds what an attempt at the equal job left when it ended early.
bool attempted(const Job& job, const std::filesystem::path& folder);

/// Notes that `job` is at work in `folder`; `mark` takes the note away.
void mark_attempt(const Job& job, const std::filesystem::path& folder);

/// Writes the marker. `status`: `finished`, or why the result is incomplete and will remain so.
void mark(const Job& job, const std::filesystem::path& folder, const std::string& status,
          double wall_time);

/// A folder with one sub-folder per finished job, named by its key. Entries appear by renaming, so
/// several programs may share it, and are served only while every file is as it was stored; a
/// damaged or unwritable cache costs time, never a result.
class Cache {
 public:
  explicit Cache(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Copies the result of `job` into `target`, which it makes anew. False, and no `target`, when it
  /// is not there or any file of it is missing, new or another than was stored.
  bool fetch(const Job& job, const std::filesystem::path& target) const;

  /// Whether it keeps a result of `job`, as far as can be told without reading its files.
  bool keeps(const Job& job) const { return std::filesystem::exists(entry(job)); }

  /// Copies the finished `source` into the cache, leaving out what belongs to a run and not to a
  /// job (is_run_file). False when that failed.
  bool store(const Job& job, const std::filesystem::path& source) const;

  /// Removes what processes left that were killed while they stored something.
  void tidy() const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path entry(const Job& job) const;
  std::filesystem::path folder_;
};

}  // namespace fingertip::studies::inline jobs
