/// What the processes of a run agree upon. Free of deal.II; MPI inside.
#pragma once

#include <functional>

namespace fingertip::fem_reference::inline job {

/// The first process of MPI_COMM_WORLD speaks and writes for all.
bool first_process();

/// Throws Interrupted on all processes when `stop_requested` (may be empty) says so on any.
void stop_if_asked(const std::function<bool()>& stop_requested);

}  // namespace fingertip::fem_reference::inline job
