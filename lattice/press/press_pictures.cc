#include "lattice/press/press_pictures.h"

#include <utility>

namespace fingertip::lattice {

PressPictures::PressPictures(const PressSetup& setup, const Finger& finger, double expected_time,
                             PressFilm film, PressOutcome& outcome)
    : finger_(&finger),
      view_(finger.model(), setup.geometry),
      recorder_(view_, setup.protocol, Moment::before_contact, outcome),
      film_(std::move(film)),
      outcome_(&outcome) {
  if (film_.pictures > 1) interval_ = expected_time / (film_.pictures - 1);
}

void PressPictures::look(double indentation) {
  if (recorder_.due(indentation, finger_->touching() > 0))
    recorder_.keep(take_picture(*finger_, view_, indentation));
  if (interval_ <= 0.0 || finger_->time() < shown_ * interval_) return;
  film_.show(view_, take_picture(*finger_, view_, indentation));
  ++shown_;
  last_shown_ = finger_->time();
}

void PressPictures::update() {
  outcome_->boundary_deformed = view_.deformed(finger_->state());
  outcome_->boundary_anchored = view_.held(finger_->held());
}

void PressPictures::finish(double indentation) {
  recorder_.finish(take_picture(*finger_, view_, indentation));
  // The end may come just before or after the time that was expected.
  if (interval_ > 0.0 && finger_->time() > last_shown_ + 0.5 * interval_) {
    film_.show(view_, take_picture(*finger_, view_, indentation));
  }
}

}  // namespace fingertip::lattice
