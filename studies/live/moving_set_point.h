/// A set point that a person moves while the finger follows it.
#pragma once

#include "meshes/press/press_motion.h"

namespace fingertip::studies::inline live {

/// Distance along the way of the press [m] that runs to a wanted place at a wanted speed, with
/// bounded acceleration a: the speed tends to the least of the wanted one and that from which it
/// can still stop, which over the distance r that is left after the present period is r/T below
/// a T² and sqrt(2 a r - a² T²) beyond (the same value and slope where they meet), T = 3 periods.
/// Wanted values may change at any moment: neither place nor speed ever jumps.
class MovingSetPoint {
 public:
  /// `clearance` [m] > 0 fixes the acceleration: max(0.5 m/s², speed²/clearance), so that the speed
  /// is reached within half the clearance. `period` [s] > 0 is that of advance().
  MovingSetPoint(double speed, double goal, double clearance, double period);

  /// Of the approach [m/s], > 0, and distance from the start [m]; felt a period later.
  void want(double speed, double goal);

  /// Goes on by one period.
  void advance();
  /// Starts anew, at rest, from `distance` [m].
  void restart(double distance);
  /// Distance and speed at this moment, acceleration until the next one.
  const meshes::SetPoint& now() const { return now_; }

 private:
  double acceleration_limit() const;
  void plan();

  double speed_, goal_, clearance_, period_;
  meshes::SetPoint now_;
};

}  // namespace fingertip::studies::inline live
