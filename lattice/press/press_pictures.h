/// Takes the pictures of a press while it runs.
#pragma once

#include "lattice/press/boundary_view.h"
#include "lattice/press/press.h"

namespace fingertip::lattice {

/// Fills PressOutcome::boundary_* and snapshots, and shows the film's pictures.
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
  bool snapshot_due(double indentation) const;

  const Finger* finger_;
  BoundaryView view_;
  PressFilm film_;
  PressOutcome* outcome_;
  double before_contact_, half_depth_;  ///< indentations of the first and the third snapshot [m]
  double interval_ = 0.0;               ///< between pictures of the film [s]
  int shown_ = 0;                       ///< pictures of the film
  double last_shown_ = 0.0;             ///< [s]
};

}  // namespace fingertip::lattice
