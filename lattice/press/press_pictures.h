/// What a press leaves to be drawn, in motion or at rest: the skin of the whole tip at a few
/// moments.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/model/state.h"
#include "lattice/press/boundary_view.h"
#include "lattice/press/press_setup.h"
#include "meshes/base/names.h"

namespace fingertip::lattice::inline press {

/// When a picture of a press is kept.
enum class Moment {
  before_contact,  ///< halfway to the plane
  first_touch,
  half_depth,
  end,  ///< whatever was reached before
};
using meshes::name, meshes::values;
constexpr auto names_of(Moment) {
  using enum Moment;
  return meshes::names<Moment>({{before_contact, "before contact"},
                                {first_touch, "first touch"},
                                {half_depth, "half depth"},
                                {end, "end"}});
}

struct MomentPicture : FingerPicture {
  Moment moment = Moment::end;
};

struct PressShapes {
  std::vector<meshes::Vector3> boundary_rest;        ///< what a BoundaryView shows, at rest [m]
  std::vector<std::array<int, 2>> boundary_springs;  ///< pairs of them joined by axis springs
  /// Each moment once, those that a press passes through; the end last.
  std::vector<MomentPicture> snapshots;
};

/// The particles that a press computes, in the caller's order: world axes.
struct ComputedParticles {
  std::vector<meshes::Vector3> moved;  ///< how far since rest [m]
  std::vector<std::uint8_t> held;      ///< where the plane holds them, as Finger::held(); now
};
ComputedParticles particles_of(const Finger& finger);
/// Their places at rest [m].
std::vector<meshes::Vector3> rest_places(const LatticeModel& model);

/// Draws a press, of which it computes a part, as the moving lattice of the whole tip, and keeps
/// the pictures of its moments.
class PressPictures {
 public:
  /// `rest`: the particles of one of `sectors` parts (Sector). `whole`: the lattice of the whole
  /// tip where that is computed, which must outlive this; null: it is built (throws as build_tip
  /// does). `first`: the moment that comes first. `shapes` must outlive it.
  PressPictures(const PressSetup& setup, int sectors, const std::vector<meshes::Vector3>& rest,
                const LatticeModel* whole, Moment first, PressShapes& shapes);
  PressPictures(const PressPictures&) = delete;
  PressPictures& operator=(const PressPictures&) = delete;

  const LatticeModel& model() const { return *model_; }  ///< of the whole tip
  const BoundaryView& view() const { return view_; }
  /// `bare` with the tip where these particles are, and all of them moved by `travel` beside [m].
  FingerPicture draw(FingerPicture bare, const ComputedParticles& now,
                     const meshes::Vector3& travel = meshes::Vector3::Zero());

  /// Whether a state is to be given to keep().
  bool due(double indentation, bool touching) const;
  void keep(FingerPicture picture);
  /// The last state.
  void finish(FingerPicture picture);

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
  Moment next_;
  double before_contact_, half_depth_;  ///< indentations of these moments [m]
  PressShapes* shapes_;
};

}  // namespace fingertip::lattice::inline press
