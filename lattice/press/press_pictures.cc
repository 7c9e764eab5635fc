#include "lattice/press/press_pictures.h"

#include <utility>

namespace fingertip::lattice::inline press {

PressPictures::PressPictures(const PressSetup& setup, int sectors,
                             const std::vector<meshes::Vector3>& rest, const LatticeModel* whole,
                             Moment first, PressShapes& shapes)
    : tip_(setup, sectors, rest, whole),
      next_(first),
      before_contact_(-0.5 * setup.protocol.clearance),
      half_depth_(0.5 * setup.protocol.depth),
      shapes_(&shapes) {
  shapes.boundary_rest = tip_.view().rest();
  shapes.boundary_springs = tip_.view().springs();
}

bool PressPictures::due(double indentation, bool touching) const {
  switch (next_) {
    case Moment::before_contact: return indentation >= before_contact_;
    case Moment::first_touch: return touching;
    case Moment::half_depth: return indentation >= half_depth_;
    case Moment::end: return false;
  }
  return false;
}

void PressPictures::keep(FingerPicture picture) {
  shapes_->snapshots.push_back({std::move(picture), next_});
  next_ = Moment(int(next_) + 1);
}

void PressPictures::finish(FingerPicture picture) {
  next_ = Moment::end;
  keep(std::move(picture));
}

}  // namespace fingertip::lattice::inline press
