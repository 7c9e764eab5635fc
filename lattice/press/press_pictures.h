/// Takes the pictures of a press while it runs.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "lattice/press/boundary_view.h"
#include "lattice/press/press_outcome.h"
#include "lattice/press/press_shapes.h"
#include "lattice/press/whole_tip.h"

namespace fingertip::lattice::inline press {

/// Fills the outcome's PressShapes, and shows the film's pictures: of the whole tip.
class PressPictures {
 public:
  /// `expected_time` [s]: how long the press will take. Finger and outcome must outlive it.
  PressPictures(const PressSetup& setup, const Finger& finger, double expected_time, PressFilm film,
                PressOutcome& outcome);

  /// To be called at the start and after every step.
  void look(double indentation);
  /// Brings the outcome's boundary up to date.
  void update();
  /// To be called at the end: the last snapshot, the film's last picture.
  void finish(double indentation);
  /// The lattice of the whole tip.
  const LatticeModel& model() const { return whole_ ? whole_->model() : finger_->model(); }

 private:
  FingerPicture take(double indentation);
  std::vector<meshes::Vector3> deformed();
  std::vector<std::uint8_t> held() const;

  const Finger* finger_;
  std::optional<WholeTip> whole_;  ///< of which the finger is a part
  BoundaryView view_;
  ShapeRecorder recorder_;
  PressFilm film_;
  PressOutcome* outcome_;
  double interval_ = 0.0;    ///< between pictures of the film [s]
  int shown_ = 0;            ///< pictures of the film
  double last_shown_ = 0.0;  ///< [s]
};

}  // namespace fingertip::lattice::inline press
