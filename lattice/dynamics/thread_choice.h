/// How many threads step a lattice fastest.
#pragma once

namespace fingertip::lattice {

/// At most `cores` (1 or more), and one for each `particles_per_thread` of the `particles`: with
/// less to do a thread costs more by being waited for than it takes off the others. What
/// `run.threads = 0` takes; results do not depend on it.
int fastest_threads(double particles, int cores);

/// Measured (lattice/MEASUREMENTS.md, threads by size).
inline constexpr double particles_per_thread = 1500.0;

/// Cores of this machine, 1 or more.
int machine_cores();

}  // namespace fingertip::lattice
