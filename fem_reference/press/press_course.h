/// The press as the continuum goes through it, step by step. Free of deal.II.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "meshes/press/press_motion.h"

namespace fingertip::fem_reference::inline press {

/// A course by a coordinate s [m] that is 0 at first touch and grows: the place on the protocol's
/// PressPath, whose holds take nothing; of a program that goes through time the press's speed times
/// the time since first touch, so that holds are part of it. Without a program both are the same.
class PressCourse {
 public:
  /// A part of the course within which the rod moves one way, or stays.
  struct Leg {
    double begin = 0.0;  ///< s where it begins
    double rate = 1.0;   ///< its way over that in s, once its speed has risen; 0: a hold
  };

  /// `in_time`: whether time matters (ReferenceJob::in_time).
  PressCourse(const meshes::PressProtocol& protocol, bool in_time);

  /// Where output is wanted, increasing; every leg ends at one.
  const std::vector<double>& samples() const { return samples_; }
  /// The stage of a program in which a sample lies, from 1; NaN without one.
  double stage(std::size_t sample) const;
  meshes::PressPose at(double s) const;
  /// Since first touch [s].
  double time(double s) const { return s / speed_; }
  /// Of the rod towards the plane [m/s²]; 0 without a program.
  double acceleration(double s) const;
  /// The one that ends at s or goes beyond.
  const Leg& leg(double s) const;

 private:
  double speed_, touch_time_ = 0.0;
  meshes::PressPath path_;
  std::optional<meshes::PressMotion> motion_;  ///< of a program in time
  std::vector<double> samples_;
  std::vector<Leg> legs_;
};

}  // namespace fingertip::fem_reference::inline press
