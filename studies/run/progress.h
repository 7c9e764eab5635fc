/// How far a run is, shown on stderr.
#pragma once

#include <chrono>
#include <map>
#include <mutex>
#include <string>

namespace fingertip::studies {

enum class ProgressStyle {
  tty,   ///< one line with a bar, rewritten in place
  json,  ///< one JSON object per line: {"job", "fraction", "stage", "elapsed"}
  off,
};

/// Safe to use from several threads. Shows at most ten updates a second.
class Progress {
 public:
  explicit Progress(ProgressStyle style);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Announces a job, so that the bar knows how much is to come. `weight`: its expected share of
  /// the work, any unit.
  void expect(const std::string& job, double weight = 1.0);

  /// `fraction` of the job is done, 0 ... 1.
  void report(const std::string& job, double fraction, const std::string& stage);

  /// Removes the bar so that a message can be printed.
  void clear();

 private:
  struct Part {
    double weight = 1.0;
    double fraction = 0.0;
  };
  void draw(const std::string& job, const std::string& stage);

  ProgressStyle style_;
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point drawn_;
  std::map<std::string, Part> parts_;
  std::mutex mutex_;
};

}  // namespace fingertip::studies
