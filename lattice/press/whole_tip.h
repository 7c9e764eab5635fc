/// The whole tip of a press that computes a part of it.
#pragma once

#include <optional>
#include <vector>

#include "lattice/model/state.h"
#include "lattice/press/boundary_view.h"
#include "lattice/press/press_setup.h"

namespace fingertip::lattice::inline press {

/// The particles that a press computes, in the caller's order: world axes.
struct ComputedParticles {
  std::vector<meshes::Vector3> moved;  ///< how far since rest [m]
  std::vector<std::uint8_t> held;      ///< where the plane holds them, as Finger::held(); now
};
ComputedParticles particles_of(const Finger& finger);
/// Their places at rest [m].
std::vector<meshes::Vector3> rest_places(const LatticeModel& model);

/// A part together with its mirror images, as the moving lattice of the whole tip.
class WholeTip {
 public:
  /// `rest`: the particles of one of `sectors` parts (Sector). `whole`: the lattice of the whole
  /// tip where that is computed, which must outlive this; null: it is built (throws as build_tip
  /// does).
  WholeTip(const PressSetup& setup, int sectors, const std::vector<meshes::Vector3>& rest,
           const LatticeModel* whole);
  /// Of a finger that moves, and must outlive this.
  WholeTip(const PressSetup& setup, const LatticeModel& computed);
  WholeTip(const WholeTip&) = delete;
  WholeTip& operator=(const WholeTip&) = delete;

  const LatticeModel& model() const { return *model_; }
  const BoundaryView& view() const { return view_; }
  /// `bare` with the tip where these particles are, and all of them moved by `travel` beside [m].
  FingerPicture draw(FingerPicture bare, const ComputedParticles& now,
                     const meshes::Vector3& travel = meshes::Vector3::Zero());
  /// All of a finger whose part is computed; `indentation` [m] is the caller's.
  FingerPicture picture(const Finger& finger, double indentation);
  /// Of all particles, from that of the computed part.
  State state_of(const LatticeModel& part, const State& state) const;

 private:
  /// A particle of the part and one of its mirror images among the whole tip's grid points.
  struct Image {
    std::size_t particle, point;
    meshes::Vector3 mirror;  ///< signs of x, y, z
  };

  std::optional<LatticeModel> built_;
  const LatticeModel* model_;
  std::vector<Image> images_;
  State state_;
  BoundaryView view_;
};

/// A state of the whole tip on another grid, of the whole or of a part: at each particle of `to`
/// what is linear in space and fits best to the particles of `from` within two spacings around.
/// Their weights are m/d⁴, d the distance: the light corners of slivers move wildly.
State carried_over(const LatticeModel& from, const State& state, const LatticeModel& to);

}  // namespace fingertip::lattice::inline press
