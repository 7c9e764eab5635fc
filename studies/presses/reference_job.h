/// The continuum as a job.
#pragma once

#include "fem_reference/job/job.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline presses {

/// The continuum by fingertip-fem. Files: job.json, summary.json, convergence.csv, tip.msh,
/// section.csv, contact_field.csv, fields/, and by analysis response.csv (static press), also
/// transient.csv (transient), or modes.csv (modes). While it is unfinished, checkpoint/, from which
/// it goes on when it is run again in the same folder.
Job reference_job(const fem_reference::ReferenceJob& reference);

/// What fingertip-fem expects of a static press from its first mesh, which takes a second or two.
struct ReferenceCost {
  double unknowns = 0.0;  ///< of the first mesh
  double time = 0.0;      ///< until the press is done [s]
  double memory = 0.0;    ///< peak [byte]
};

/// Throws InvalidInput where the program is missing, NotConverged with its words where it refuses
/// the job or cannot mesh the finger, Interrupted once `stop` says so.
ReferenceCost expected_cost(const fem_reference::ReferenceJob& reference,
                            const std::function<bool()>& stop = {});

/// The continuum's code against analytic solutions. Files: job.json, summary.json,
/// verification.json.
Job verification_job();

}  // namespace fingertip::studies::inline presses
