/// The rig at a wanted speed, as a page orders it: no threads, and nothing that waits.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "studies/live/protocol.h"
#include "studies/live/row_history.h"

namespace fingertip::studies::inline live {

struct PaceSettings {
  bool paused = false;  ///< at the start
  double rate = 1.0;    ///< wanted real-time factor; 0: as fast as it can
  /// The press with a coarser lattice, which is taken where this machine does not keep up for a
  /// second; empty: that is told and no more.
  SetupAt coarser;
};

/// What a thread of the program (Simulation) or a page by itself (studies/web) runs.
class PacedRig {
 public:
  using Clock = std::chrono::steady_clock;
  /// Least time between two frames.
  static constexpr auto frame_interval = std::chrono::milliseconds(33);

  /// Throws InvalidInput.
  PacedRig(const lattice::PressSetup& setup, const PaceSettings& settings);

  /// Acknowledgements are none of its business.
  void obey(const LiveMessage& order);
  /// Whether advance() has nothing to do.
  bool idle() const { return !running() && steps_wanted_ == 0; }
  bool running() const { return status_ == LiveStatus::running; }
  /// By one controller period. A lattice that gives way, or a controller, is told by the frames.
  void advance();
  /// When the wall clock comes to where the simulation is; a past time with the rate 0 and
  /// for single steps. What is missed by more than 0.05 s is not caught up.
  Clock::time_point due();
  /// To be called between periods and while waiting.
  void measure_pace();

  /// Whether the last frame is out of date.
  bool changed() const { return changed_; }
  /// That somebody wants one, although nothing has changed.
  void want_frame() { changed_ = true; }
  /// Whether a new one is worth its making, at most 30 times a second of wall time.
  bool frame_due() const { return changed_ && Clock::now() - last_frame_ >= frame_interval; }
  LiveFrame frame();
  /// What the frames to come belong to.
  std::shared_ptr<const LiveScene> scene();

  const LiveRig& rig() const { return rig_; }
  const RowHistory& rows() const { return rows_; }
  /// Least real-time factor over half a second of running without a pause, an order to run or
  /// another rate in between; NaN where there was none.
  double slowest_factor() const { return slowest_factor_; }

 private:
  /// Of the last periods: how fast they would go without waiting.
  struct Busy {
    double simulated = 0.0, wall = 0.0;  ///< [s]
    double factor() const { return simulated / wall; }
  };
  void obey(Transport order);
  void adjust(const Adjust& order);
  void reset();
  void restart_pace();
  void keep_up();
  void attempt(const std::function<void()>& work);
  void hold(const meshes::Vector3& place);
  bool go_on_coarser(double share, bool whole);

  LiveRig rig_;
  SetupAt coarser_;
  double first_spacing_;  ///< [m]
  std::shared_ptr<const LiveScene> scene_;
  int lattices_ = 0;          ///< of the rig when scene_ was made
  bool is_coarsest_ = false;  ///< that the finger's shape allows
  RowHistory rows_;
  LiveStatus status_;
  std::string failure_;
  double rate_;
  int steps_wanted_ = 0;
  bool changed_ = true;  ///< since the last frame
  std::uint64_t frames_ = 0, epoch_ = 0;
  Clock::time_point last_frame_{}, pace_start_{};
  double pace_time_ = 0.0;
  std::deque<std::pair<Clock::time_point, double>> pace_marks_;
  double achieved_ = 0.0, slowest_factor_ = meshes::unknown;
  std::optional<Clock::time_point> slow_since_;
  Busy busy_;
};

}  // namespace fingertip::studies::inline live
