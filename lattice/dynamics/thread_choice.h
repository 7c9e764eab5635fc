/// How many threads step a lattice fastest.
#pragma once

namespace fingertip::lattice::inline dynamics {

/// At most `cores` (1 or more), and one for each `particles_per_thread` of the `particles`, V/a³:
/// below, a further thread gains less on an idle machine than it loses beside other programs, where
/// it is waited for. What `run.threads = 0` takes; results do not depend on it.
int fastest_threads(double particles, int cores);

/// Measured (lattice/MEASUREMENTS.md, threads by size).
inline constexpr double particles_per_thread = 1000.0;

/// Cores of this machine, 1 or more.
int machine_cores();

}  // namespace fingertip::lattice::inline dynamics
