/// What a job of a press has computed so far, on disk while it runs.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <string>

#include "lattice/control/controller.h"
#include "studies/jobs/job.h"
#include "studies/presses/press_record.h"

namespace fingertip::studies::inline presses {

/// Writes an `Outcome` when `interval` has passed, when it is told to stop, and at the end.
template <typename Outcome>
class Journal {
 public:
  using Write = std::function<void(const Outcome&, const std::string& status)>;

  Journal(std::filesystem::path folder, const JobContext& context, std::string stage, Write write,
          std::chrono::milliseconds interval = std::chrono::milliseconds(500))
      : folder_(std::move(folder)),
        context_(context),
        stage_(std::move(stage)),
        write_(std::move(write)),
        interval_(interval) {}

  /// `compute` with an observer of what it has so far; summary.json tells how it ended. Throws as
  /// `compute`.
  template <typename Compute>
  Outcome run(const Compute& compute) {
    try {
      Outcome outcome = compute(
          [this](const Outcome& so_far, double fraction) { return observe(so_far, fraction); });
      write_(outcome, "finished");
      return outcome;
    } catch (const meshes::NotConverged& error) {
      set_press_status(folder_, std::string("not converged: ") + error.what());
      throw;
    } catch (const lattice::ControllerFailed& error) {
      set_press_status(folder_, std::string("controller failed: ") + error.what());
      throw;
    } catch (const meshes::Interrupted&) {
      set_press_status(folder_, "interrupted");
      throw;
    }
  }

 private:
  using Clock = std::chrono::steady_clock;

  /// The last call before an end by force, or a failure (fraction 0), must be on disk whatever the
  /// time.
  bool observe(const Outcome& so_far, double fraction) {
    const bool go_on = context_.report(fraction, stage_);
    if (!go_on || fraction == 0.0 || Clock::now() - written_ > interval_) {
      write_(so_far, go_on ? "running" : "interrupted");
      written_ = Clock::now();
    }
    return go_on;
  }

  std::filesystem::path folder_;
  const JobContext& context_;
  std::string stage_;
  Write write_;
  std::chrono::milliseconds interval_;
  Clock::time_point written_;
};

}  // namespace fingertip::studies::inline presses
