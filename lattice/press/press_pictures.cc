#include "lattice/press/press_pictures.h"

#include <utility>

namespace fingertip::lattice::inline press {

using meshes::Vector3;

namespace {

/// None if the finger is whole.
std::optional<WholeTip> whole_tip(const PressSetup& setup, const LatticeModel& part) {
  if (part.sector.count() == 1) return {};
  std::vector<Vector3> rest;
  for (const std::uint32_t p : part.particles) rest.push_back(part.rest_position(p));
  return WholeTip(setup, part.sector.count(), rest);
}

}  // namespace

PressPictures::PressPictures(const PressSetup& setup, const Finger& finger, double expected_time,
                             PressFilm film, PressOutcome& outcome)
    : finger_(&finger),
      whole_(whole_tip(setup, finger.model())),
      view_(model(), setup.geometry),
      recorder_(view_, setup.protocol, Moment::before_contact, outcome),
      film_(std::move(film)),
      outcome_(&outcome) {
  if (film_.pictures > 1) interval_ = expected_time / (film_.pictures - 1);
}

void PressPictures::look(double indentation) {
  if (recorder_.due(indentation, finger_->touching() > 0)) recorder_.keep(take(indentation));
  if (interval_ <= 0.0 || finger_->time() < shown_ * interval_) return;
  film_.show(view_, take(indentation));
  ++shown_;
  last_shown_ = finger_->time();
}

std::vector<Vector3> PressPictures::deformed() {
  if (!whole_) return view_.deformed(finger_->state());
  const LatticeModel& part = finger_->model();
  std::vector<Vector3> moved;
  for (const std::uint32_t p : part.particles)
    moved.emplace_back(part.grid.axes * finger_->state().displacement.at(p));
  return view_.deformed(whole_->state(moved));
}

std::vector<std::uint8_t> PressPictures::held() const {
  const std::vector<std::uint8_t> of_boundary = finger_->held();
  if (!whole_) return view_.held(of_boundary);
  const LatticeModel& part = finger_->model();
  std::vector<std::uint8_t> of_point(part.points(), 0), of_part;
  for (std::size_t b = 0; b < of_boundary.size(); ++b) of_point[part.boundary[b]] = of_boundary[b];
  for (const std::uint32_t p : part.particles) of_part.push_back(of_point[p]);
  return view_.held(whole_->boundary(of_part));
}

FingerPicture PressPictures::take(double indentation) {
  FingerPicture picture = bare_picture(*finger_, indentation);
  picture.boundary = deformed();
  picture.held = held();
  return picture;
}

void PressPictures::update() {
  outcome_->boundary_deformed = deformed();
  outcome_->boundary_anchored = held();
}

void PressPictures::finish(double indentation) {
  recorder_.finish(take(indentation));
  // The end may come just before or after the time that was expected.
  if (interval_ > 0.0 && finger_->time() > last_shown_ + 0.5 * interval_) {
    film_.show(view_, take(indentation));
  }
}

}  // namespace fingertip::lattice::inline press
