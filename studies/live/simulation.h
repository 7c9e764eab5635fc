/// The rig in a thread of its own, at a wanted speed, never waiting for anyone.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "meshes/press/press_response.h"
#include "studies/live/protocol.h"

namespace fingertip::studies::inline live {

/// Rows of the plots with a running number, the oldest ones dropped; from `first` on.
struct LiveRows {
  std::uint64_t first = 0;
  std::vector<LiveRow> rows;
};

/// Runs a LiveRig. Orders are taken between two controller periods. Frames are made at most 30
/// times a second of wall time, and only while someone watches.
class Simulation {
 public:
  /// `on_frame` is called in the simulation's thread after each new frame; it must be quick.
  Simulation(const lattice::PressSetup& setup, bool paused, double rate,
             std::function<void()> on_frame);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Returns false, and forgets the message, when 256 others wait to be taken. Acknowledgements are
  /// none of its business.
  bool post(const LiveMessage& message);
  /// How many watch; without any no frames are made. A new frame follows at once.
  void watched_by(int viewers);
  std::shared_ptr<const LiveFrame> frame() const;
  /// The rows of the present epoch from number `first` on, thinned to at most `most`; the answer's
  /// `first` is the number of the next row to ask for.
  LiveRows rows_from(std::uint64_t first, std::size_t most) const;

  const LiveRig& rig() const { return rig_; }  ///< what never changes of it
  /// Ends the thread; the last frame stays.
  void stop();
  /// Least real-time factor over half a second of running without a pause, an order to run or
  /// another rate in between; NaN where there was none. After stop().
  double slowest_factor() const { return slowest_factor_; }

 private:
  using Clock = std::chrono::steady_clock;
  void run();
  void take_orders();
  void obey(const LiveMessage& order);
  void adjust(const Adjust& order);
  void advance();
  void keep_pace();
  void measure_pace();
  void publish(bool in_any_case);
  void restart_pace();

  LiveRig rig_;
  std::function<void()> on_frame_;
  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable wake_;
  std::deque<LiveMessage> orders_;
  std::shared_ptr<const LiveFrame> frame_;
  std::deque<LiveRow> rows_;
  std::uint64_t first_row_ = 0;  ///< number of rows_.front()
  int viewers_ = 0;
  bool frame_wanted_ = false, stopping_ = false;

  // The simulation's thread alone:
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
  std::thread thread_;
};

}  // namespace fingertip::studies::inline live
