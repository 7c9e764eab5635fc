/// A lattice press as a job.
#pragma once

#include "lattice/press/press_setup.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline presses {

/// A lattice press. Static: see static_press_job.h. Otherwise files: response.csv, trace.csv
/// (rewritten twice a second while it runs, so that a killed run stays readable), boundary.csv,
/// boundary_springs.csv, snapshots.csv, snapshot_points.csv, summary.json, and a movie/ (movie.h)
/// where so many pictures of it are asked for: another job, with another key. Static presses have
/// none.
Job press_job(const lattice::PressSetup& setup, int movie_pictures = 0);

}  // namespace fingertip::studies::inline presses
