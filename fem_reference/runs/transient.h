/// A press with inertia as a run: its mesh from static presses, its error, its files. Free of
/// deal.II.
#pragma once

#include <filesystem>
#include <functional>
#include <iosfwd>

#include "fem_reference/job/job.h"
#include "fem_reference/runs/run_progress.h"

namespace fingertip::fem_reference::inline runs {

/// Carries out a job with Analysis::transient; the contract is that of `run_job`. Writes
/// response.csv, pressure.csv, transient.csv (`time [s],indentation [m],normal_force [N],
/// contact_force [N]`, at most 2000 rows), convergence.csv, fields and summary.json.
///
/// The mesh comes from a static frictionless press to the same samples, refined until its force
/// error meets `tolerance`; the transient takes the coarsest of its meshes whose static forces are
/// all within twice the tolerance of the finest one's. `force_error` is the sum of that mesh's
/// static error, relative to the force, and of the change of the transient force when the steps are
/// doubled. Without `estimate_error` the first mesh is taken and `force_error` is empty.
RunOutcome run_transient(const std::filesystem::path& folder, const ReferenceJob& job,
                         std::ostream& progress, const std::function<bool()>& stop_requested);

}  // namespace fingertip::fem_reference::inline runs
