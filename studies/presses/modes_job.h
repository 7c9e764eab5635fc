/// Natural frequencies of the lattice as a job.
#pragma once

#include "lattice/press/press_setup.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline presses {

/// Natural frequencies of the lattice bonded to a fixed rod, lowest first. Files: modes.csv
/// (`mode,frequency [Hz]` and what moves, see lattice::ModeMotion), summary.json.
Job modes_job(const lattice::PressSetup& setup, int count);

}  // namespace fingertip::studies::inline presses
