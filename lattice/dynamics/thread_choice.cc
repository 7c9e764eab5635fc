#include "lattice/dynamics/thread_choice.h"

#include <algorithm>
#include <thread>

namespace fingertip::lattice::inline dynamics {

int machine_cores() {
  return std::max(1, int(std::thread::hardware_concurrency()));
}

int fastest_threads(double particles, int cores) {
  return int(std::clamp(particles / particles_per_thread, 1.0, double(std::max(cores, 1))));
}

}  // namespace fingertip::lattice::inline dynamics
