#include "lattice/press/press_pictures.h"

#include <utility>

namespace fingertip::lattice {

PressPictures::PressPictures(const PressSetup& setup, const Finger& finger, double expected_time,
                             PressFilm film, PressOutcome& outcome)
    : finger_(&finger),
      view_(finger.model(), setup.geometry),
      film_(std::move(film)),
      outcome_(&outcome),
      before_contact_(-0.5 * setup.protocol.clearance),
      half_depth_(0.5 * setup.protocol.depth) {
  outcome.boundary_rest = view_.rest();
  outcome.boundary_springs = view_.springs();
  if (film_.pictures > 1) interval_ = expected_time / (film_.pictures - 1);
}

/// Before contact, at first touch, at half depth; the fourth is taken at the end.
bool PressPictures::snapshot_due(double indentation) const {
  switch (outcome_->snapshots.size()) {
    case 0: return indentation >= before_contact_;
    case 1: return finger_->touching() > 0;
    case 2: return indentation >= half_depth_;
    default: return false;
  }
}

void PressPictures::look(double indentation) {
  if (snapshot_due(indentation)) {
    outcome_->snapshots.push_back(take_picture(*finger_, view_, indentation));
  }
  if (interval_ <= 0.0 || finger_->time() < shown_ * interval_) return;
  film_.show(view_, take_picture(*finger_, view_, indentation));
  ++shown_;
  last_shown_ = finger_->time();
}

void PressPictures::update() {
  outcome_->boundary_deformed = view_.deformed(finger_->state());
  outcome_->boundary_anchored = view_.held(*finger_);
}

void PressPictures::finish(double indentation) {
  outcome_->snapshots.push_back(take_picture(*finger_, view_, indentation));
  // The end may come just before or after the time that was expected.
  if (interval_ > 0.0 && finger_->time() > last_shown_ + 0.5 * interval_) {
    film_.show(view_, take_picture(*finger_, view_, indentation));
  }
}

}  // namespace fingertip::lattice
