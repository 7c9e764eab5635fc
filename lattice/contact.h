/// Contact of the published model: boundary particles anchored on a rigid plane (paper, section
/// II.F).
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/model.h"
#include "lattice/plane.h"
#include "lattice/state.h"
#include "meshes/press_protocol.h"

namespace fingertip::lattice {

/// Which boundary particles the plane holds, and what that costs it. One pass over the boundary
/// per step; allocates only in the constructor.
class PlaneContact {
 public:
  /// The finger must start clear of the plane. Model must outlive the contact.
  PlaneContact(const LatticeModel& model, const Plane& plane, meshes::ContactMode mode);

  /// To be called after particles moved freely through a step of length `step` under `force`:
  /// holds the anchored ones back, anchors those that crossed, where they crossed (linear between
  /// the ends of the step), and in frictionless mode releases those that would be pulled.
  /// Returns the impulse of the plane on the tip [N s]: the reaction that held the anchored ones
  /// (minus the force on them, times the step) and -m v of those stopped at touch.
  meshes::Vector3 resolve(State& state, const VectorField& force, double step);

  int anchored() const { return anchored_; }
  /// Largest distance at rest of a held particle from the axis through the origin along the
  /// normal [m]; 0 without contact.
  double radius() const;
  bool holds(std::size_t boundary_number) const { return candidates_[boundary_number].held; }

 private:
  struct Candidate {
    std::uint32_t particle = 0;
    bool held = false;
    double rest_gap = 0.0;                                   ///< [m]
    double lateral = 0.0;                                    ///< distance from the axis at rest [m]
    meshes::Vector3 displacement = meshes::Vector3::Zero();  ///< at the last step, or held at [m]
  };

  double gap(const Candidate& c, const meshes::Vector3& displacement) const;
  meshes::Vector3 hold(Candidate& c, State& state, const VectorField& force, double step);
  meshes::Vector3 touch(Candidate& c, State& state);

  const LatticeModel* model_;
  meshes::Vector3 normal_;
  meshes::ContactMode mode_;
  std::vector<Candidate> candidates_;  ///< in the order of model.boundary
  int anchored_ = 0;
};

}  // namespace fingertip::lattice
