/// How the rod is told to move in time.
#pragma once

#include <cstddef>
#include <vector>

#include "meshes/press/press_protocol.h"

namespace fingertip::meshes::inline press {

/// Distance, speed and acceleration of the commanded motion at one time, along the press.
struct SetPoint {
  double distance = 0.0;      ///< from the start [m]
  double speed = 0.0;         ///< down > 0, up < 0 [m/s]
  double acceleration = 0.0;  ///< [m/s²]
};

/// A stage in time.
struct MotionStage {
  double begin = 0.0, end = 0.0;  ///< [s]
  double from = 0.0, to = 0.0;    ///< indentation [m]
  double speed = 0.0;             ///< its size, once risen [m/s]; 0: a hold
  double rise = 0.0;              ///< of the speed, and its fall [s]

  bool moves() const { return speed != 0.0; }
};

/// A time at which output is wanted.
struct MotionSample {
  double time = 0.0;         ///< since the start [s]
  double indentation = 0.0;  ///< [m]
  std::size_t stage = 0;
};

/// Commanded motion of a press: the rod starts at rest, `clearance` above first touch, at time 0.
///
/// The speed of a move rises from rest within T as t/T - sin(2πt/T)/(2π), so that the acceleration
/// is continuous, starts and ends at zero, and the soft tip is hardly shaken. T is 30 ms, less
/// where the way is shorter: in the first stage the rise covers at most half the clearance, in the
/// others rise and fall the whole way. A stage of a program falls to rest in the same way, so it
/// takes way/speed + T and ends exactly at its indentation. Without a program there is one stage,
/// to the depth, and the motion goes on at its speed.
class PressMotion {
 public:
  /// Of a protocol that breaks no rule.
  explicit PressMotion(const PressProtocol& protocol);

  SetPoint at(double time) const;
  /// Commanded [m]; negative before first touch.
  double indentation(double time) const { return at(time).distance - clearance_; }

  /// One or more, one after the other without gaps.
  const std::vector<MotionStage>& stages() const { return stages_; }
  /// The stage at a time; at the moment between two the later one, after the end the last.
  std::size_t stage_at(double time) const;
  /// Of the first stage's speed [s].
  double rise_time() const { return stages_.front().rise; }
  /// When the last stage ends [s]: without a program when the depth is reached.
  double duration() const { return stages_.back().end; }
  /// Whether the rod is at rest at the end: a program's.
  bool stops() const { return stops_; }
  /// When the commanded indentation [m] is reached within a stage [s]; a hold's begin. Throws
  /// std::out_of_range for one that is no part of the stage.
  double time_at(double indentation, std::size_t stage = 0) const;
  /// When the tip touches first [s].
  double touch_time() const { return time_at(0.0); }

  /// When output is wanted, by time: on the way of every move the protocol's samples (or
  /// default_samples) that are passed, and its end; in a hold 1, 2, 3, 5, 7.5, 10, 15, 20, 25 and
  /// 30 thirtieths of it.
  const std::vector<MotionSample>& samples() const { return samples_; }

 private:
  double clearance_;
  bool stops_;
  std::vector<MotionStage> stages_;
  std::vector<MotionSample> samples_;
};

}  // namespace fingertip::meshes::inline press
