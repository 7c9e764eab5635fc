/// What a press leaves to be drawn, in motion or at rest: the skin of the whole tip at a few
/// moments.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/press/whole_tip.h"
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

/// Keeps the pictures of a press's moments.
class PressPictures {
 public:
  /// `first`: the moment that comes first. `shapes` must outlive it; the rest as of WholeTip.
  PressPictures(const PressSetup& setup, int sectors, const std::vector<meshes::Vector3>& rest,
                const LatticeModel* whole, Moment first, PressShapes& shapes);

  WholeTip& tip() { return tip_; }

  /// Whether a state is to be given to keep().
  bool due(double indentation, bool touching) const;
  void keep(FingerPicture picture);
  /// The last state.
  void finish(FingerPicture picture);

 private:
  WholeTip tip_;
  Moment next_;
  double before_contact_, half_depth_;  ///< indentations of these moments [m]
  PressShapes* shapes_;
};

}  // namespace fingertip::lattice::inline press
