/// What a press knows of its way from the mesh before. deal.II's side.
#pragma once

#include <map>
#include <vector>

#include "fem_reference/elements/body.h"

namespace fingertip::fem_reference::inline press {

/// The way of a press as a coarser mesh has found it, corrected as a finer one goes along: its
/// states, carried over to that mesh. Newton's method starts from it, and contact reads off it
/// where on a long step nodes touch first.
class KnownWay {
 public:
  using Points = std::map<double, Vector>;  ///< displacement [m] by place on the course [m]

  KnownWay() = default;
  /// On one mesh after `meshes` others, along `points`, with the press at `now`, one of them, where
  /// it is off by `difference` [m] what was known. A mesh begins at rest, place 0.
  KnownWay(int meshes, Points points, double now, Vector difference);

  int meshes() const { return meshes_; }
  const Points& points() const { return points_; }
  const Vector& difference() const { return difference_; }

  bool reaches(double place) const { return !points_.empty() && points_.rbegin()->first >= place; }
  /// The places known between where the press is and `place`, both apart.
  std::vector<double> until(double place) const;
  /// Displacement known of a place from where the press is to where it reaches: linear between
  /// points [m].
  Vector known(double place) const;
  /// The press has moved on to `place`. What is known of the way there is corrected in proportion.
  void pass(double place, const Vector& displacement);

 private:
  int meshes_ = 0;
  Points points_;
  double now_ = 0.0;
  Vector difference_;
};

}  // namespace fingertip::fem_reference::inline press
