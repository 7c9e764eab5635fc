/// What the length of a static press's steps leaves in the force of what sticks.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lattice/statics/lattice_body.h"
#include "lattice/statics/static_contact.h"
#include "meshes/press/press_response.h"

namespace fingertip::lattice::inline press {

/// A point is anchored where the straight way of its step meets the plane (StaticContact), in truth
/// where its motion does. A second place that is as good is where the motion that the step began
/// with would have met it: from it the anchor is e. An anchor A is where the energy E has the slope
/// dE/dA = T, the pull on the tie, and the force along the plane's way x is dE/dx; so it is off by
///
///   sum of e · dT/dx,
///
/// T's change over a step at hand. Both places are first-order guesses at a motion that bends, on
/// both sides of the truth as a rule: the sum of sizes, doubled, covers it
/// (lattice/MEASUREMENTS.md, solver and steps). Points that slide owe nothing to where they
/// touched.
class StepError {
 public:
  /// Keeps a reference to `body`.
  explicit StepError(const LatticeBody& body);

  /// A step without a turn, from `start` under `before` to `end` under `after`, whose anchors are
  /// set; `predicted` is the end of the motion that the step began with, `force` the size of the
  /// whole tip's force at the end [N].
  void note(const StaticContact& before, const Eigen::VectorXd& start, const StaticContact& after,
            const Eigen::VectorXd& end, const Eigen::VectorXd& predicted, double force);

  /// Of the force along the plane's way, over the whole; unknown before the first step.
  double relative() const { return relative_; }
  /// Length of steps [m] by which it would be `tolerance`: an error is taken for C h^p of the force
  /// that a step of the length h adds, so that C is known from the mean of h^p over the force.
  double length_for(double tolerance) const;

 private:
  const LatticeBody* body_;
  std::vector<meshes::Vector3> off_;  ///< anchors, e [m]
  double relative_ = meshes::unknown;
  double force_ = 0.0;        ///< after the last step [N]
  double mean_length_ = 0.0;  ///< to the power p
};

}  // namespace fingertip::lattice::inline press
