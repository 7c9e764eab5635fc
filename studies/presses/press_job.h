/// A lattice press as a job.
#pragma once

#include "lattice/press/press_setup.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline presses {

/// Files of a press at rest: response.csv (force_error: as estimated) and summary.json (rewritten
/// after every sample), contact_field.csv (from the first sample that touches), markers.csv (of a
/// protocol with markers), shapes (snapshot_files.h). Of another one also trace.csv (all rewritten
/// twice a second while it runs, so that a killed run stays readable), and a movie/ (movie.h) where
/// so many pictures of it are asked for: another job, with another key.
Job press_job(const lattice::PressSetup& setup, int movie_pictures = 0);

}  // namespace fingertip::studies::inline presses
