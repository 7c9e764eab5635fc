/// What every press leaves to be drawn, in motion or at rest.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

#include "lattice/press/boundary_view.h"
#include "meshes/press/press_protocol.h"

namespace fingertip::lattice::inline press {

/// When a picture of a press is kept.
enum class Moment {
  before_contact,  ///< halfway to the plane
  first_touch,
  half_depth,
  end,  ///< whatever was reached before
};
std::string_view name(Moment moment);

struct MomentPicture : FingerPicture {
  Moment moment = Moment::end;
};

struct PressShapes {
  /// What a BoundaryView shows, at rest [m] ...
  std::vector<meshes::Vector3> boundary_rest;
  std::vector<meshes::Vector3> boundary_deformed;    ///< ... and at the end [m]
  std::vector<std::array<int, 2>> boundary_springs;  ///< pairs of them joined by axis springs
  std::vector<std::uint8_t> boundary_anchored;       ///< BoundaryView::held
  /// Each moment once, those that a press passes through.
  std::vector<MomentPicture> snapshots;
};

/// Keeps the pictures of a press's moments.
class ShapeRecorder {
 public:
  /// `next`: the moment that comes first. `shapes` must outlive it.
  ShapeRecorder(const BoundaryView& view, const meshes::PressProtocol& protocol, Moment next,
                PressShapes& shapes);

  /// Whether a state is to be given to `keep`.
  bool due(double indentation, bool touching) const;
  void keep(FingerPicture picture);
  /// The last state: its picture, and the boundary at the end.
  void finish(FingerPicture picture);

 private:
  Moment next_;
  double before_contact_, half_depth_;  ///< indentations of these moments [m]
  PressShapes* shapes_;
};

}  // namespace fingertip::lattice::inline press
