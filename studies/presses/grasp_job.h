/// Two soft fingers lift a rigid block.
#pragma once

#include "lattice/grasp/grasp.h"
#include "studies/config/loader.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline presses {

/// The grasp that `loaded` describes; of [press] it takes contact, friction and clearance. Throws
/// ConfigError for every rule it breaks.
lattice::GraspSetup grasp_setup(const LoadedConfig& loaded);

/// Files: grasp.csv (rewritten twice a second while it runs), summary.json.
Job grasp_job(const lattice::GraspSetup& setup);

}  // namespace fingertip::studies::inline presses
