/// The whole tip of which a press computes a part, to be drawn and counted.
#pragma once

#include <cstdint>
#include <vector>

#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/press/press_setup.h"

namespace fingertip::lattice::inline press {

/// The moving lattice of the whole tip, its particles where mirror images of a part's are.
/// Particles of the part are numbered as the caller lists them.
class WholeTip {
 public:
  /// `rest`: of the part's particles [m], one of `sectors` parts (Sector). Throws InvalidInput as
  /// build_tip does.
  WholeTip(const PressSetup& setup, int sectors, const std::vector<meshes::Vector3>& rest);

  const LatticeModel& model() const { return model_; }
  /// With the part's particles moved so far, and all of them by `travel` beside [m], world axes;
  /// until the next call.
  const State& state(const std::vector<meshes::Vector3>& moved,
                     const meshes::Vector3& travel = meshes::Vector3::Zero());
  /// Per boundary particle of model(), what is so of the part's particles.
  std::vector<std::uint8_t> boundary(const std::vector<std::uint8_t>& of_part) const;

 private:
  /// A particle of the part and one of its mirror images among the model's points.
  struct Image {
    std::size_t particle, point;
    meshes::Vector3 mirror;  ///< signs of x, y, z
  };

  LatticeModel model_;
  std::vector<Image> images_;
  State state_;
};

}  // namespace fingertip::lattice::inline press
