/// Takes the pictures of a press while it runs.
#pragma once

#include "lattice/press/boundary_view.h"
#include "lattice/press/press.h"
#include "lattice/press/press_shapes.h"

namespace fingertip::lattice {

/// Fills the outcome's PressShapes, and shows the film's pictures.
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

 private:
  const Finger* finger_;
  BoundaryView view_;
  ShapeRecorder recorder_;
  PressFilm film_;
  PressOutcome* outcome_;
  double interval_ = 0.0;    ///< between pictures of the film [s]
  int shown_ = 0;            ///< pictures of the film
  double last_shown_ = 0.0;  ///< [s]
};

}  // namespace fingertip::lattice
