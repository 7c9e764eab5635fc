/// Threads that march a lattice through time together, each in a time step of its own.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "lattice/threads/parallel.h"

namespace fingertip::lattice::springs {

/// Sweeps planes 0, 1, ... of step after step, where plane z of a step needs planes up to z + 1 of
/// the step before and leaves the planes below z alone. A thread takes the next step that nobody
/// has taken and stays two planes behind the step before: no barrier, and every step does the same
/// whoever takes it. Waiting threads spin, and yield their core when that takes long. A thread that
/// gets no core takes no step, and the others go on without it.
class Wavefront {
 public:
  /// Makes `threads` - 1 threads ready besides the calling one; they sleep between runs.
  explicit Wavefront(int threads) : team_(threads), finished_(std::size_t(threads) + 1) {}
  Wavefront(const Wavefront&) = delete;
  Wavefront& operator=(const Wavefront&) = delete;

  int threads() const { return team_.threads(); }

  /// Calls sweep(thread, plane) for every plane of `steps` steps on `threads` threads of those made
  /// ready; a number of a thread is used by one at a time. Allocates nothing; `sweep` must not
  /// throw.
  template <typename Sweep>
  void run(int steps, int planes, int threads, const Sweep& sweep) {
    for (Counter& counter : finished_) counter.value.store(0, std::memory_order_relaxed);
    next_.value.store(0, std::memory_order_relaxed);
    team_.split(std::size_t(threads), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t thread = begin; thread < end; ++thread) {
        for (int step = take(steps); step >= 0; step = take(steps)) {
          for (int plane = 0; plane < planes; ++plane) {
            wait(step, plane, planes);
            sweep(int(thread), plane);
            finish(step, plane, planes);
          }
        }
      }
    });
  }

 private:
  /// On cache lines of its own.
  struct alignas(128) Counter {
    std::atomic<std::int64_t> value{0};
  };

  Counter& finished_of(int step) { return finished_[std::size_t(step) % finished_.size()]; }
  int take(int steps);                           ///< the next step; -1 when all are taken
  void wait(int step, int plane, int planes);    ///< until the step before is far enough
  void finish(int step, int plane, int planes);  ///< tells that the plane is swept

  Team team_;
  Counter next_;  ///< step to be taken
  /// Of step n, in place n % size: n * planes + planes swept. At most as many steps are in flight
  /// as there are threads; one more place keeps the step before the oldest of them.
  std::vector<Counter> finished_;
};

}  // namespace fingertip::lattice::springs
