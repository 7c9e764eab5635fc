/// Waiting awake.
#pragma once

#include <emmintrin.h>

#include <chrono>

namespace fingertip::lattice::inline threads {

/// Looks again and again whether `done()`, for about `patience`; returns whether it is. Anything
/// that takes less than some ten microseconds is missed by a thread that goes to sleep.
template <typename Done>
bool spin_until(const Done& done, std::chrono::nanoseconds patience) {
  constexpr int looks_per_glance = 64;  // at the clock
  const auto start = std::chrono::steady_clock::now();
  do {
    for (int look = 0; look < looks_per_glance; ++look) {
      if (done()) return true;
      _mm_pause();
    }
  } while (std::chrono::steady_clock::now() - start < patience);
  return done();
}

}  // namespace fingertip::lattice::inline threads
