/// The folder of one run: parameters, manifest, log, and whatever its jobs produce.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "studies/config/loader.h"
#include "studies/files/manifest.h"
#include "studies/jobs/file_lock.h"

namespace fingertip::studies::inline jobs {

struct RunFolderOptions {
  std::string verb;
  std::filesystem::path out;  ///< empty: runs/<verb>-<YYYYmmdd-HHMMSS> in the current folder
  bool force = false;         ///< replace an existing run folder
  bool resume = false;        ///< keep the finished parts of an existing run folder
  std::vector<std::string> command_line;
  std::string stem{};  ///< of the folder's name in the place of `verb`, which the manifest keeps
};

/// Created by the constructor, which refuses (ConfigError) an existing folder without `force` or
/// `resume`, one in which another process is at work, a folder that is no run folder in any case
/// (it would be destroyed), and one that cannot be written. The manifest says `"status": "running"`
/// until `finish`; if the folder is left without it (an exception, a kill), status and log tell so.
class RunFolder {
 public:
  RunFolder(const RunFolderOptions& options, const LoadedConfig& loaded,
            const std::string& case_text = {});
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  bool resumed() const { return resumed_; }

  /// One line for log.txt, with the time; safe from several threads.
  void log(const std::string& line);

  /// Takes a new folder away again, and puts back what --force had replaced. Not for a resumed run.
  void discard();

  /// Completes the manifest: "finished", "not converged", "criteria failed", "interrupted",
  /// "failed", with the exit code and what went wrong, if anything.
  void finish(const std::string& status, int exit_code, const std::string& error = {});

 private:
  class Log;
  void claim(const RunFolderOptions& options);

  std::filesystem::path path_;
  bool made_ = false;  ///< by this one: it was not there
  bool resumed_ = false;
  bool finished_ = false;
  Manifest manifest_;
  std::unique_ptr<Log> log_;
  std::unique_ptr<FileLock> lock_;  ///< keeps others out as long as this lives
};

}  // namespace fingertip::studies::inline jobs
