#include "tests/benchmarks/springs/engine/wavefront.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "lattice/threads/spin.h"

namespace fingertip::lattice::springs {

namespace {

constexpr std::chrono::microseconds patience{20};  // longer than a plane takes

}  // namespace

int Wavefront::take(int steps) {
  const std::int64_t step = next_.value.fetch_add(1, std::memory_order_relaxed);
  return step < steps ? int(step) : -1;
}

void Wavefront::wait(int step, int plane, int planes) {
  if (step == 0) return;
  const std::atomic<std::int64_t>& before = finished_of(step - 1).value;
  const std::int64_t needed = std::int64_t(step - 1) * planes + std::min(plane + 2, planes);
  const auto far_enough = [&] { return before.load(std::memory_order_acquire) >= needed; };
  while (!spin_until(far_enough, patience)) std::this_thread::yield();
}

void Wavefront::finish(int step, int plane, int planes) {
  finished_of(step).value.store(std::int64_t(step) * planes + plane + 1, std::memory_order_release);
}

}  // namespace fingertip::lattice::springs
