/// How a finger is marched through time: who chooses the steps, and by which formula.
#pragma once

#include <functional>
#include <string>
#include <variant>

#include "lattice/dynamics/finger.h"
#include "lattice/dynamics/time_step.h"
#include "meshes/base/errors.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

/// Where a prescribed rod is at a time [s].
using Motion = std::function<RodMotion(double time)>;
/// What moves the rod: a wrench at its endpoint (world axes), or that it is told where to be.
using Drive = std::variant<Wrench, Motion>;

/// Thrown when compression turns cells inside out or would need endless steps.
class CrushedCells : public meshes::NotConverged {
 public:
  using meshes::NotConverged::NotConverged;
};

/// What a run took.
struct StepCount {
  long accepted = 0, rejected = 0;
  /// Steps taken although they left their bound, because smaller ones are not tried.
  long forced = 0;
  double smallest = 0.0;  ///< of the accepted ones that were not cut short by the end of a span [s]
};

/// Marches a finger through spans of time, during each of which the drive and the plane's
/// velocities hold. A span is begin(), step() until its end is reached, end(). What a stepper knows
/// between two spans is in memory(), so that recall() and the same spans give the same bits.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// A span of `duration` [s] > 0 begins now. Throws CrushedCells.
  virtual void begin(const Drive& drive, double duration) = 0;
  /// One step that does not go beyond `until` [s], the span's end. Throws CrushedCells.
  virtual void step(const Drive& drive, double until) = 0;
  /// The span has ended, perhaps early. Finger::bond() is then the present one, or, for Euler
  /// steps, that at the start of the last step.
  virtual void end() {}

  /// Zeros: nothing is known yet.
  struct Memory {
    double next = 0.0;  ///< the step to try where an error chooses it [s]
    /// Of a cell since masses were scaled, at most: change of volume, and strain or turn.
    double changed = 0.0, strained = 0.0;
  };
  const Memory& memory() const { return now_; }
  void recall(const Memory& memory) { now_ = memory; }

  const StepCount& count() const { return count_; }
  /// How steps are chosen and how many there were, for people; empty for steps that the stability
  /// bound alone rules.
  virtual std::string explanation() const { return {}; }

 protected:
  void accept(double step, bool whole);
  std::string counted() const;

  Memory now_;
  StepCount count_;
};

}  // namespace fingertip::lattice::inline dynamics::inline integrators
