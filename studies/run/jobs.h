/// The computations that studies are made of, as cacheable jobs.
#pragma once

#include "calibration/moduli_fit.h"
#include "fem_reference/job.h"
#include "lattice/press/press_setup.h"
#include "studies/run/job.h"

namespace fingertip::studies {

/// A lattice press. Static: see static_press_job.h. Otherwise files: response.csv, trace.csv
/// (rewritten twice a second while it runs, so that a killed run stays readable), boundary.csv,
/// boundary_springs.csv, snapshots.csv, snapshot_points.csv, summary.json, and a movie/ (movie.h)
/// where so many pictures of it are asked for: another job, with another key. Static presses have
/// none.
Job press_job(const lattice::PressSetup& setup, int movie_pictures = 0);

/// Natural frequencies of the lattice bonded to a fixed rod, lowest first. Files: modes.csv
/// (`mode,frequency [Hz]` and what moves, see lattice::ModeMotion), summary.json.
Job modes_job(const lattice::PressSetup& setup, int count);

/// The continuum by fingertip-fem. Files: job.json, summary.json, convergence.csv, tip.msh,
/// section.csv, pressure.csv, fields/, and by analysis response.csv (static press), also
/// transient.csv (transient), or modes.csv (modes). While it is unfinished, checkpoint/, from which
/// it goes on when it is run again in the same folder.
Job reference_job(const fem_reference::ReferenceJob& reference);

/// The continuum's code against analytic solutions. Files: job.json, summary.json,
/// verification.json.
Job verification_job();

/// A fit to the moduli. Files: calibration.json, material.toml, summary.json.
Job moduli_job(const meshes::Rubber& rubber, const calibration::ModuliFitOptions& options);

/// Finite cubes of 2, 4 and 8 cells of the three models. File: cubes.csv.
Job cubes_job(const meshes::Rubber& rubber, const lattice::SpringConstants& central,
              const lattice::SpringConstants& hookean, double spacing);

}  // namespace fingertip::studies
