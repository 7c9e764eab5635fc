/// The skin of the tip as it is drawn, and the finger at one moment with it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/dynamics/finger.h"
#include "lattice/model/model.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline press {

/// Boundary particles and the axis springs between them. On cut cells a boundary particle is drawn
/// where the nearest point of the true surface that hangs on it is; far corners of slivers on which
/// no such point hangs move wildly and are left out. The model must outlive the view.
class BoundaryView {
 public:
  BoundaryView(const LatticeModel& model, const meshes::Geometry& geometry);

  std::size_t size() const { return rest_.size(); }
  const std::vector<meshes::Vector3>& rest() const { return rest_; }  ///< places at rest [m]
  /// Pairs of places joined by a spring.
  const std::vector<std::array<int, 2>>& springs() const { return springs_; }
  /// Where they are now [m].
  std::vector<meshes::Vector3> deformed(const State& state) const;
  /// Where the plane holds the finger, of what Finger::held() tells of a finger of this model.
  std::vector<std::uint8_t> held(const std::vector<std::uint8_t>& of_boundary) const;

 private:
  /// A place before it is known whether it is drawn.
  struct Candidate {
    meshes::Vector3 rest;
    const EmbeddedPoint* tie = nullptr;  ///< what is drawn in the particle's place, or null
  };
  std::vector<Candidate> candidates(const meshes::Geometry& geometry) const;

  const LatticeModel* model_;
  std::vector<meshes::Vector3> rest_;
  std::vector<std::size_t> entry_;           ///< of model.boundary
  std::vector<const EmbeddedPoint*> drawn_;  ///< per place, null: the particle itself
  std::vector<std::array<int, 2>> springs_;
};

/// The finger at one moment, ready to be drawn; world axes = the rod's starting axes.
struct FingerPicture {
  double time = 0.0;                                   ///< unknown without time [s]
  double indentation = 0.0;                            ///< negative before contact [m]
  Pose rod;                                            ///< of the finger's frame
  meshes::Vector3 endpoint = meshes::Vector3::Zero();  ///< of the rod [m]
  Wrench on_rod;                                       ///< of the tip, about the endpoint
  Plane plane;
  std::vector<meshes::Vector3> boundary;      ///< BoundaryView::deformed() [m]
  std::vector<std::uint8_t> held;             ///< BoundaryView::held()
  std::vector<meshes::ContactPoint> contact;  ///< Finger::contact_now(), or none
};

/// Rod and plane of `finger` now, without what is drawn of its tip. `indentation` [m] is the
/// caller's.
FingerPicture bare_picture(const Finger& finger, double indentation);

}  // namespace fingertip::lattice::inline press
