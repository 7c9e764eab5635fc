/// The rig in a thread of its own, never waiting for anyone.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "studies/live/paced_rig.h"

namespace fingertip::studies::inline live {

/// Runs a PacedRig. Orders are taken between two controller periods; frames are made only while
/// someone watches.
class Simulation {
 public:
  /// `on_frame` is called in the simulation's thread after each new frame; it must be quick.
  Simulation(const lattice::PressSetup& setup, const PaceSettings& pace,
             std::function<void()> on_frame);
  ~Simulation();
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Returns false, and forgets the message, when 256 others wait to be taken.
  bool post(const LiveMessage& message);
  /// How many watch; without any no frames are made. A new frame follows at once.
  void watched_by(int viewers);
  std::shared_ptr<const LiveFrame> frame() const;
  /// Of the present epoch.
  const RowHistory& rows() const { return paced_.rows(); }

  const LiveRig& rig() const { return paced_.rig(); }  ///< what never changes of it
  /// Ends the thread; the last frame stays.
  void stop();
  /// After stop().
  double slowest_factor() const { return paced_.slowest_factor(); }

 private:
  void run();
  void take_orders();
  void keep_pace();
  void publish(bool in_any_case);

  PacedRig paced_;  ///< the simulation's thread alone, but for rows()
  std::function<void()> on_frame_;
  mutable std::mutex mutex_;  ///< guards what follows
  std::condition_variable wake_;
  std::deque<LiveMessage> orders_;
  std::shared_ptr<const LiveFrame> frame_;
  int viewers_ = 0;
  bool frame_wanted_ = false, stopping_ = false;
  std::thread thread_;
};

}  // namespace fingertip::studies::inline live
