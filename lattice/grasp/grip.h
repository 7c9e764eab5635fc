/// How a robot grasps: close until the wanted grip force, take up the weight, lift, hold.
#pragma once

#include <vector>

#include "meshes/base/errors.h"
#include "meshes/base/names.h"
#include "meshes/press/press_response.h"

namespace fingertip::lattice::inline grasp {

/// What the hand is to do.
struct GripSettings {
  double force = 0.07;           ///< normal force of each finger [N], > 0
  double closing_speed = 0.02;   ///< largest speed of a finger toward the block [m/s], > 0
  double time_constant = 0.025;  ///< of the force control [s], at least 4 periods
  double lift_height = 5.0e-3;   ///< [m], > 0
  double lift_speed = 0.01;      ///< largest speed of the lift [m/s], > 0
  double hold_time = 0.2;        ///< at the top [s], >= 0
  double release_time = 0.0;   ///< after that the grip falls by so much, relative [1/s]; 0: it ends
  double slip_limit = 2.0e-3;  ///< a block that slid farther is dropped [m], > 0
  double period = 1.0e-3;      ///< of the control [s], > 0

  std::vector<meshes::Violation> violations() const;
  double lift_time() const;          ///< [s]
  double lift_acceleration() const;  ///< largest one [m/s²]
};

enum class GripPhase {
  squeeze,  ///< close until the grip force is there
  load,     ///< rise until the fingers carry the block's weight
  lift,     ///< minimum-jerk path to the height
  hold,     ///< stand still
  release,  ///< let the grip force fall slowly
  done,
};
using meshes::name, meshes::values;
constexpr auto names_of(GripPhase) {
  using enum GripPhase;
  return meshes::names<GripPhase>({{squeeze, "squeeze"},
                                   {load, "load"},
                                   {lift, "lift"},
                                   {hold, "hold"},
                                   {release, "release"},
                                   {done, "done"}});
}

/// What the robot feels once per period.
struct GripFeeling {
  double time = 0.0;         ///< [s]
  double force = 0.0;        ///< mean normal force of the fingers [N]
  double indentation = 0.0;  ///< mean travel beyond first touch [m]
  double load = 0.0;         ///< upward force of the fingers over the block's weight
  bool supported = true;     ///< whether the block still stands on its support
};

/// Speeds of the rods at the end of the coming period [m/s].
struct GripMotion {
  double closing = 0.0;  ///< toward the block, each finger
  double rising = 0.0;
};

/// A parallel gripper: both fingers close alike under the control of their mean normal force, an
/// integrator on a position-controlled jaw. With k the contact's stiffness and T the time constant,
///   closing speed = (F_wanted - F)/(k T),  so  F' = (F_wanted - F)/T,
/// limited to closing_speed; k = 3/2 F / indentation, Hertz' law at the present state.
/// The load phase slows down as the weight is taken up, so that the block is not plucked from its
/// support: rising speed = lift_speed * max(1 - load/weight, 1/20). The lift is the path of least
/// jerk (Flash & Hogan 1985), z = h (10 s³ - 15 s⁴ + 6 s⁵) with s = t/T, whose largest speed is
/// 15/8 h/T and largest acceleration 10/sqrt(3) h/T². No speed changes faster than by its limit
/// within 20 ms.
class GripControl {
 public:
  explicit GripControl(const GripSettings& settings)
      : settings_(settings), wanted_(settings.force) {}

  /// To be called once per period, with increasing times.
  GripMotion next(const GripFeeling& feeling);
  GripPhase phase() const { return phase_; }
  double wanted_force() const { return wanted_; }  ///< [N]
  /// When the block left its support [s]; what is not yet is unknown (NaN).
  double lift_off_time() const { return lift_off_; }
  /// Rough share of the plan that is behind, 0 ... 1.
  double fraction_done(double time) const;

 private:
  void enter(GripPhase phase, double time);
  void update_phase(const GripFeeling& feeling);
  void update_wanted_force(double time);
  bool settled(const GripFeeling& feeling);
  double closing_speed(const GripFeeling& feeling) const;
  double rising_speed(const GripFeeling& feeling) const;

  GripSettings settings_;
  GripPhase phase_ = GripPhase::squeeze;
  double entered_ = 0.0;       // when the phase began [s]
  double settled_since_ = -1;  // when the force came near the wanted one, < 0: it is not
  double wanted_;
  GripMotion last_;
  double lift_off_ = meshes::unknown;
};

}  // namespace fingertip::lattice::inline grasp
