/// What every run of this program tells while and after it works. Free of deal.II; MPI inside.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <iosfwd>
#include <limits>
#include <string>

#include "fem_reference/job/job.h"
#include "fem_reference/job/press_state.h"
#include "fem_reference/job/run_summary.h"
#include "fem_reference/solvers/solver_choice.h"

namespace fingertip::fem_reference::inline runs {

/// How a run ended, and in which words.
struct RunOutcome {
  enum class Status { ok, interrupted, not_converged };
  Status status = Status::ok;
  std::string message;  ///< empty when ok
  /// Of a press that found equilibrium no further [m]; else NaN.
  double reached = std::numeric_limits<double>::quiet_NaN();
};

using meshes::name;
constexpr auto names_of(RunOutcome::Status) {
  using enum RunOutcome::Status;
  return meshes::names<RunOutcome::Status>(
      {{ok, "ok"}, {interrupted, "interrupted"}, {not_converged, "not converged"}});
}

/// Does the work of a run, and tells how it ended: Interrupted and NotConverged are outcomes, which
/// all processes see together; anything else is passed on.
RunOutcome outcome_of(const std::function<void()>& work);

/// One JSON object per line, {"stage", "done", "total", "message"} and what is expected, "left" and
/// "memory"; and the wall time since its construction [s].
class RunProgress {
 public:
  explicit RunProgress(std::ostream& out) : out_(out) {}
  void report(const char* stage, std::size_t done, std::size_t total, const std::string& message,
              const Expected& expected = {});
  double wall_time() const;

 private:
  std::ostream& out_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// What every run has.
class Run {
 public:
  Run(const std::filesystem::path& folder, const ReferenceJob& job, std::ostream& progress,
      const std::function<bool()>& stop_requested)
      : folder_(folder), job_(job), progress_(progress), stop_requested_(stop_requested) {}

 protected:
  /// Makes a folder in the run's, before any process goes on.
  std::filesystem::path make_folder(const std::filesystem::path& name) const;

  const std::filesystem::path folder_;
  const ReferenceJob& job_;
  RunProgress progress_;
  const std::function<bool()>& stop_requested_;
};

/// What every run's summary.json starts with: program, status, message, the discretisation that the
/// job asked for, and the number of processes.
RunSummary summary_head(const RunOutcome& outcome, const ReferenceJob& job);

MeshEntry mesh_entry(const MeshSummary& mesh, double wall_time,
                     std::optional<std::size_t> samples = {});
/// "F = 0.1 N at 0.001 m", with the time and the lateral force where there are any.
std::string sample_text(const meshes::PressSample& sample);
/// What the summary of a press tells of its finest mesh.
void add_finest(const MeshSummary& mesh, RunSummary& summary);

/// Adds wall_time [s] and peak_memory [byte] and writes `folder`/summary.json.
void write_summary(RunSummary summary, const RunProgress& progress,
                   const std::filesystem::path& folder);

}  // namespace fingertip::fem_reference::inline runs
