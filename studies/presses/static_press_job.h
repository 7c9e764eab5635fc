/// A press without time.
#pragma once

#include "lattice/press/press_setup.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline presses {

/// Files: response.csv and summary.json (rewritten after every sample), contact.csv, and shapes
/// (snapshot_files.h).
Job static_press_job(const lattice::PressSetup& setup);

}  // namespace fingertip::studies::inline presses
