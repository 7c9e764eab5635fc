/// Waiting awake.
#pragma once

#include <chrono>

#ifdef __x86_64__
#include <emmintrin.h>
#endif

namespace fingertip::lattice::inline threads {

/// Tells the processor that this thread only waits.
inline void pause() {
#ifdef __x86_64__
  _mm_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

/// Looks again and again whether `done()`, for about `patience`; returns whether it is. Anything
/// that takes less than some ten microseconds is missed by a thread that goes to sleep.
template <typename Done>
bool spin_until(const Done& done, std::chrono::nanoseconds patience) {
  constexpr int looks_per_glance = 64;  // at the clock
  const auto start = std::chrono::steady_clock::now();
  do {
    for (int look = 0; look < looks_per_glance; ++look) {
      if (done()) return true;
      pause();
    }
  } while (std::chrono::steady_clock::now() - start < patience);
  return done();
}

}  // namespace fingertip::lattice::inline threads
