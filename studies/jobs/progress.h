/// How far a run is, shown on stderr.
#pragma once

#include <chrono>
#include <cstdio>
#include <map>
#include <mutex>
#include <optional>
#include <string>

namespace fingertip::studies::inline jobs {

enum class ProgressStyle {
  tty,    ///< one line with a bar, rewritten in place
  lines,  ///< a line after 10 s, then ever more rarely: for logs and pipes
  json,   ///< one JSON object per line: {"job", "fraction", "stage", "elapsed", "remaining"}
  off,
};

/// How long the rest takes if it goes on as on average so far [s]; unknown during the first second
/// and below one per cent. `done` of the work has been computed in `elapsed` [s], `left` of it is
/// to be.
std::optional<double> remaining_time(double elapsed, double done, double left);

/// When lines are due [s]: at 10 s, then after another quarter of the time so far, between 10 s and
/// 10 min.
double next_line(double elapsed);

/// "45 s", "3 min", "2 h 10 min": no more digits than an estimate has.
std::string rough_duration(double seconds);

/// Safe to use from several threads. Shows at most ten updates a second.
class Progress {
 public:
  explicit Progress(ProgressStyle style, std::FILE* out = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Announces a job, so that the bar knows how much is to come. `weight`: its expected share of
  /// the work, any unit.
  void expect(const std::string& job, double weight = 1.0);
  /// What jobs that are not announced yet will weigh.
  void expect_later(double weight);

  /// `fraction` of the job is done, 0 ... 1; it never falls.
  void report(const std::string& job, double fraction, const std::string& stage);
  /// The job need not be computed: its share took no time, and says nothing on the rest.
  void reused(const std::string& job);

  /// Removes the bar so that a message can be printed.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  struct Part {
    double weight = 1.0;
    double fraction = 0.0;
    bool reused = false;
  };
  struct Sum {
    double all = 0.0, done = 0.0, computed = 0.0;  ///< weights
    double fraction() const { return all > 0.0 ? done / all : 0.0; }
  };
  Sum sum() const;
  bool due(double fraction) const;
  void show(const std::string& job, const Part& part, const std::string& stage);
  double elapsed() const;

  ProgressStyle style_;
  std::FILE* out_;
  Clock::time_point start_;
  Clock::time_point drawn_;
  double next_line_;  ///< [s] after the start
  std::map<std::string, Part> parts_;
  double later_ = 0.0;  ///< weight
  double shown_ = 0.0;  ///< largest fraction of all so far
  std::mutex mutex_;
};

}  // namespace fingertip::studies::inline jobs
