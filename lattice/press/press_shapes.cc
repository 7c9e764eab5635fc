#include "lattice/press/press_shapes.h"

#include <utility>

namespace fingertip::lattice::inline press {

std::string_view name(Moment moment) {
  switch (moment) {
    case Moment::before_contact: return "before contact";
    case Moment::first_touch: return "first touch";
    case Moment::half_depth: return "half depth";
    case Moment::end: return "end";
  }
  return "unknown";
}

ShapeRecorder::ShapeRecorder(const BoundaryView& view, const meshes::PressProtocol& protocol,
                             Moment next, PressShapes& shapes)
    : next_(next),
      before_contact_(-0.5 * protocol.clearance),
      half_depth_(0.5 * protocol.depth),
      shapes_(&shapes) {
  shapes.boundary_rest = view.rest();
  shapes.boundary_springs = view.springs();
}

bool ShapeRecorder::due(double indentation, bool touching) const {
  switch (next_) {
    case Moment::before_contact: return indentation >= before_contact_;
    case Moment::first_touch: return touching;
    case Moment::half_depth: return indentation >= half_depth_;
    case Moment::end: return false;
  }
  return false;
}

void ShapeRecorder::keep(FingerPicture picture) {
  shapes_->snapshots.push_back({std::move(picture), next_});
  next_ = Moment(int(next_) + 1);
}

void ShapeRecorder::finish(FingerPicture picture) {
  shapes_->boundary_deformed = picture.boundary;
  shapes_->boundary_anchored = picture.held;
  next_ = Moment::end;
  shapes_->snapshots.push_back({std::move(picture), next_});
}

}  // namespace fingertip::lattice::inline press
