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

/// Where the plane is, seen from the rod [m].
struct PressPose {
  double indentation = 0.0;
  double lateral = 0.0;  ///< displacement along t1
};

/// A part of a press in time: a move on to another indentation, or a hold.
struct PressStage {
  double indentation = 0.0;  ///< at its end [m]; of a hold that of the stage before; 0: first touch
  double speed = 0.0;        ///< of a move [m/s], > 0; 0: a hold
  double hold = 0.0;         ///< how long a hold lasts [s], > 0; 0: a move

  bool moves() const { return speed != 0.0; }
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
  int lateral_samples = 10;   ///< outputs at full depth, path after only: equal steps, > 0
  double depth = 3.0e-3;      ///< final indentation [m], 0 < depth < R - r
  double speed = 1.0e-2;      ///< approach speed [m/s], > 0
  double clearance = 0.5e-3;  ///< initial gap between pole and plane [m], > 0; starts at rest
  std::vector<double> samples = {};  ///< output indentations [m], increasing, last one = depth
  Obstacle obstacle = {};
  /// Stages one after the other, each from rest to rest; the first one covers the clearance, too.
  /// depth is the largest indentation then, speed the first stage's. Empty: to `depth` at `speed`,
  /// still moving when it ends.
  std::vector<PressStage> program = {};

  /// Whether a second phase follows the press: a lateral motion at full depth.
  bool slides_after() const { return lateral_path == LateralPath::after && lateral != 0.0; }

  bool has_obstacle() const { return !obstacle.is_plane(); }

  /// Whether it is its own image in x = 0; in y = 0 it always is.
  bool mirrored() const { return tilt == 0.0 && lateral == 0.0 && obstacle.mirrored(); }

  /// Whether some stage of a program goes back up.
  bool goes_back() const;

  std::vector<Violation> violations(const Geometry& geometry) const;
};

/// The plane's path by a coordinate s [m] that is 0 at first touch and grows: the indentation, and
/// where a lateral motion follows the press, depth plus the distance moved laterally; of a program
/// the way travelled along the normal, up or down. The path is straight but for its corners: at
/// full depth, when a lateral motion follows, and where a program's moves end. Holds are no part of
/// it.
class PressPath {
 public:
  /// Straight along the normal, without end.
  PressPath() = default;
  explicit PressPath(const PressProtocol& protocol);

  /// Of the whole path.
  double length() const { return length_; }
  PressPose at(double s) const;
  /// Displacement along t1 per indentation on the way down.
  double slope() const { return slope_; }
  /// Whether a corner lies between two places of the path.
  bool bends(double from, double to) const;
  /// Where output is wanted: at the protocol's samples (or default_samples) and after them at equal
  /// steps of the lateral motion that follows; of every move of a program at depths_on_the_way.
  /// Increasing; ends at length().
  const std::vector<double>& samples() const { return samples_; }
  /// The stage of a program in which a sample lies, from 1 and holds counted; NaN without one.
  double stage(std::size_t sample) const;

 private:
  double slope_ = 0.0;
  double corner_ = std::numeric_limits<double>::infinity(), length_ = corner_;
  double lateral_ = 0.0;  ///< beyond the corner, to the end [m]
  int steps_ = 0;         ///< samples beyond the corner
  std::vector<double> samples_;
  std::vector<std::pair<double, double>> moves_;  ///< of a program: place, indentation at ends [m]
  std::vector<double> sample_depths_, sample_stages_;  ///< of a program: of samples_ [m]
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
