#include "lattice/press/step_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fingertip::lattice::inline press {

using Eigen::VectorXd;
using meshes::Vector3;

namespace {

/// How many times the sum of sizes an error may be.
constexpr double cover = 2.0;
/// p (MEASUREMENTS: 1.3 to 2).
constexpr double order = 1.5;

}  // namespace

StepError::StepError(const LatticeBody& body)
    : body_(&body), off_(body.outer.size(), Vector3::Zero()) {}

void StepError::note(const StaticContact& before, const VectorXd& start, const StaticContact& after,
                     const VectorXd& end, const VectorXd& predicted, double force) {
  double sum = 0.0;
  for (std::size_t i = 0; i < off_.size(); ++i) {
    if (!after.anchored(i) || after.slides(i)) {
      off_[i].setZero();
      continue;
    }
    const bool touched = before.anchored(i);
    if (!touched) {
      const FirstTouch found = after.touch(i, start, before.place(), end);
      const Vector3 other = after.touch(i, start, before.place(), predicted).anchor;
      off_[i] = other - found.anchor;
      off_[i] -= off_[i].dot(found.last_normal) * found.last_normal;
    }
    Vector3 pull = after.tie_force(i, end);
    if (touched) pull -= before.tie_force(i, start);
    sum += std::abs(pull.dot(off_[i]));
  }
  const PressPlane& plane = after.plane();
  const double length = (plane.point(after.place()) - plane.point(before.place())).norm(),
               added = std::clamp(1.0 - force_ / force, 0.0, 1.0);
  relative_ = cover * body_->sectors * sum / (length * force);
  mean_length_ += added * (std::pow(length, order) - mean_length_);
  force_ = force;
}

double StepError::length_for(double tolerance) const {
  constexpr double any = std::numeric_limits<double>::max();
  return relative_ > 0.0 ? std::pow(tolerance * mean_length_ / relative_, 1.0 / order) : any;
}

}  // namespace fingertip::lattice::inline press
