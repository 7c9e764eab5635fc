/// What is done to the specimen: the rod carries the tip against a rigid obstacle, by default a
/// plane, to a given depth.
#pragma once

#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/press/obstacle.h"
#include "meshes/shape/geometry.h"

namespace fingertip::meshes::inline press {

/// How the tip and the plane interact (physics: lattice/contact/README.md).
enum class ContactMode {
  stick,         ///< infinite friction: a surface point is anchored where it first touched
  frictionless,  ///< only the normal gap is held, compressive only
  coulomb,       ///< sticks until the shear force exceeds friction times the push, then slides
};

/// What moves the rod.
enum class DriveMode {
  pid,           ///< dynamics under a feedback controller that holds speed and orientation
  quasi_static,  ///< dynamics with the rod's motion prescribed: displacement-driven
  equilibrium,   ///< no time: a path of static equilibria
};

/// What a stage of a press changes.
enum class StageMove {
  press,    ///< the indentation
  lateral,  ///< the plane's displacement along t1
  twist,    ///< its turn about the normal
};

/// When the plane moves laterally.
enum class LateralPath {
  diagonal,  ///< on the way down, in proportion to the indentation
  after,     ///< at full depth, once pressed
};

constexpr auto names_of(ContactMode) {
  using enum ContactMode;
  return names<ContactMode>(
      {{stick, "stick"}, {frictionless, "frictionless"}, {coulomb, "coulomb"}});
}
constexpr auto names_of(DriveMode) {
  using enum DriveMode;
  return names<DriveMode>({{pid, "pid"}, {quasi_static, "quasi-static"}, {equilibrium, "static"}});
}
constexpr auto names_of(LateralPath) {
  using enum LateralPath;
  return names<LateralPath>({{diagonal, "diagonal"}, {after, "after"}});
}

constexpr auto names_of(StageMove) {
  using enum StageMove;
  return names<StageMove>({{press, "press"}, {lateral, "lateral"}, {twist, "twist"}});
}

/// Where the plane is, seen from the rod.
struct PressPose {
  double indentation = 0.0;  ///< [m]
  double lateral = 0.0;      ///< displacement along t1 [m]
  double twist = 0.0;  ///< turn about n through the plane's point below the tip's centre [rad]
};

/// A part of a press in time: a move on to another indentation, lateral displacement or twist, or a
/// hold. What it does not change is that of the stage before.
struct PressStage {
  double indentation = 0.0;  ///< at its end [m]; 0: first touch
  double speed = 0.0;        ///< of a move [m/s], of a twist [rad/s], > 0; 0: a hold
  double hold = 0.0;         ///< how long a hold lasts [s], > 0; 0: a move
  StageMove move = StageMove::press;
  double lateral = 0.0;  ///< at its end [m]
  double twist = 0.0;    ///< at its end [rad]

  bool moves() const { return speed != 0.0; }
  bool moves_along_plane() const { return move != StageMove::press; }
  bool is_displaced() const { return lateral != 0.0 || twist != 0.0; }
  bool operator==(const PressStage&) const = default;
};

/// The press. Indentation is geometric: the distance the rod has travelled along the plane's normal
/// since the tip first touched; of an obstacle that is no plane, "the plane" is the one that
/// touches it at its top.
struct PressProtocol {
  DriveMode mode = DriveMode::pid;
  ContactMode contact = ContactMode::stick;
  double friction = 0.5;  ///< Coulomb's coefficient, contact coulomb only, > 0
  double tilt = 0.0;      ///< of the rod against the plane's normal, about y [rad]
  double lateral = 0.0;   ///< displacement of the plane along t1 at the end [m]
  LateralPath lateral_path = LateralPath::diagonal;
  /// Of the plane about n, at full depth, together with a lateral motion that follows [rad].
  double twist = 0.0;
  int lateral_samples = 10;   ///< outputs of a motion along the plane or twist: equal steps, > 0
  double depth = 3.0e-3;      ///< final indentation [m], 0 < depth < R - r
  double speed = 1.0e-2;      ///< approach speed [m/s], > 0
  double clearance = 0.5e-3;  ///< initial gap between pole and plane [m], > 0; starts at rest
  std::vector<double> samples = {};  ///< output indentations [m], increasing, last one = depth
  Obstacle obstacle = {};
  /// Stages one after the other, each from rest to rest; the first one covers the clearance, too.
  /// depth is the largest indentation then, speed the first stage's. Empty: to `depth` at `speed`,
  /// still moving when it ends.
  std::vector<PressStage> program = {};
  /// Material points whose displacements are told at the samples: places in the undeformed finger
  /// [m], in the rubber (markers.h).
  std::vector<Vector3> markers = {};

  /// Whether a second phase follows the press: a lateral motion or a twist at full depth.
  bool moves_after() const {
    return twist != 0.0 || (lateral_path == LateralPath::after && lateral != 0.0);
  }
  /// Whether some stage of a program moves along the plane or twists.
  bool has_plane_moves() const;
  /// Lateral displacements between which the plane moves [m]; 0 is one of them.
  std::pair<double, double> lateral_range() const;
  /// Whether the plane turns about its normal.
  bool twists() const;
  /// Whether the plane only comes nearer, or goes away again.
  bool is_straight() const { return lateral_range() == std::pair(0.0, 0.0) && !twists(); }

  bool has_obstacle() const { return !obstacle.is_plane(); }
  bool has_twist() const { return twist != 0.0; }

  /// Whether it is its own image in x = 0 (axis 0), in y = 0 (1).
  bool mirrored(int axis) const {
    return axis == 1 ? !twists() : tilt == 0.0 && is_straight() && obstacle.mirrored();
  }

  /// Whether some stage of a program goes back: up, or along the plane or in twist the other way.
  bool goes_back() const;

  std::vector<Violation> violations(const Geometry& geometry) const;
};

/// The plane's path by a coordinate s [m] that is 0 at first touch and grows by the way travelled:
/// along the normal, up or down, along t1, or, of a twist, by depth times its angle. It is straight
/// but for its corners: at full depth, when a motion follows, and where a program's moves end.
/// Holds are no part of it.
class PressPath {
 public:
  /// Straight along the normal, without end.
  PressPath() = default;
  explicit PressPath(const PressProtocol& protocol);

  /// Of the whole path.
  double length() const { return legs_.back().end; }
  PressPose at(double s) const;
  /// Displacement along t1 per indentation on the way down.
  double slope() const { return legs_.front().slope.lateral; }
  /// Whether a corner lies between two places of the path.
  bool bends(double from, double to) const;
  /// Where output is wanted: at the protocol's samples (or default_samples) and at equal steps of
  /// the motion that follows; of every move of a program at depths_on_the_way, or equal steps.
  /// Increasing; ends at length().
  const std::vector<double>& samples() const { return samples_; }
  /// The stage of a program in which a sample lies, from 1 and holds counted; NaN without one.
  double stage(std::size_t sample) const;

 private:
  struct Leg {
    double begin = 0.0, end = std::numeric_limits<double>::infinity();
    PressPose from;                       ///< where it begins
    PressPose slope{.indentation = 1.0};  ///< change per s
  };

  std::vector<Leg> legs_{Leg{}};
  std::vector<double> samples_, stages_;  ///< stages of a program alone
  std::vector<PressPose> poses_;          ///< of samples_
};

/// Output depths [m] of a move between two indentations [m]: those of the protocol's samples (or
/// default_samples) that lie between them, in the order in which they are passed, and then `to`.
std::vector<double> depths_on_the_way(const PressProtocol& protocol, double from, double to);

/// Ten output depths [m] for a press to `depth` [m] > 0: 1, 2, 3, 5, 7.5, 10, 15, 20, 25 and 30
/// thirtieths of it, denser where the force is still strongly curved.
std::vector<double> default_samples(double depth);
/// 1/n, 2/n ... 1 of a depth.
std::vector<double> even_depths(double depth, std::size_t count);

}  // namespace fingertip::meshes::inline press
