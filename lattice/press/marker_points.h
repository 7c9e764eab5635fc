/// The markers of a press among the particles that it computes.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "lattice/model/embedded_points.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/press/press_setup.h"

namespace fingertip::lattice::inline press {

/// A marker, or its mirror image in the part computed, lies in the cell of the grid that holds it
/// and moves by trilinear weights of its corners, as points of the surface do. Every cell counts
/// whose eight corners are particles; where the surface has left a marker without one (`published`,
/// whose staircase ends inside), the nearest beside it goes on as it does inside (place_in_cell).
class MarkerPoints {
 public:
  /// `rest`: places [m] of the particles of one of `sectors` parts (Sector). Throws InvalidInput
  /// for a marker without such a cell within a spacing: `published` may have none on a coarse grid.
  MarkerPoints(const PressSetup& setup, int sectors, const std::vector<meshes::Vector3>& rest);

  bool empty() const { return images_.empty(); }
  /// Of each marker [m], by that of a particle in the order of `rest`, along the finger's axes.
  std::vector<meshes::Vector3> displacements(
      const std::function<meshes::Vector3(std::uint32_t particle)>& moved) const;
  /// Of each marker in a lattice that moves [m], world axes; `ahead` [s] at its velocities.
  std::vector<meshes::Vector3> places(const LatticeModel& model, const State& state,
                                      double ahead = 0.0) const;

 private:
  struct Image {
    std::array<std::uint32_t, 8> corners{};
    std::array<double, 8> weights{};
    meshes::Vector3 mirror;  ///< signs of x, y, z
  };
  std::vector<meshes::Vector3> rest_;  ///< of the markers [m]
  std::vector<Image> images_;
};

}  // namespace fingertip::lattice::inline press
