/// The set point of the press: uniform motion along a direction, started smoothly from rest.
#pragma once

#include "meshes/geometry.h"

namespace fingertip::lattice {

/// Distance, speed and acceleration of the commanded motion at one time.
struct SetPoint {
  double distance = 0.0;      ///< [m]
  double speed = 0.0;         ///< [m/s]
  double acceleration = 0.0;  ///< [m/s²]
};

/// Speed rises from 0 to `speed` within `rise_time` as t/T - sin(2πt/T)/(2π), so that acceleration
/// and jerk start and end at zero or finite values and the soft tip is hardly shaken.
class Approach {
 public:
  /// speed [m/s] > 0, clearance [m] > 0: the rise takes 30 ms, less if the plane would otherwise be
  /// touched before it ends (the rise covers at most half the clearance).
  Approach(double speed, double clearance);

  SetPoint at(double time) const;
  double rise_time() const { return rise_time_; }
  /// When the commanded distance [m] is reached [s]; for distances beyond the rise.
  double time_at(double distance) const { return distance / speed_ + 0.5 * rise_time_; }

 private:
  double speed_;
  double rise_time_;
};

}  // namespace fingertip::lattice
