#include "lattice/springs/wavefront.h"

#include <emmintrin.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

namespace fingertip::lattice::springs {

namespace {

/// A counter on cache lines of its own.
struct alignas(128) Counter {
  std::atomic<std::int64_t> value{0};

  /// Spins for some 20 us, longer than a plane takes, then lets others have the core.
  void wait_for(std::int64_t needed) const {
    constexpr int patience = 2000;
    for (int spins = 0; value.load(std::memory_order_acquire) < needed; ++spins) {
      if (spins < patience)
        _mm_pause();
      else
        std::this_thread::yield();
    }
  }
};

}  // namespace

struct Wavefront::Crew {
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable wake;
  Task task;  // guarded by the mutex, like `leaving`
  bool leaving = false;
  Counter next;                   ///< next step to be taken: task.run << 32 | step
  std::vector<Counter> finished;  ///< of step n, in place n % size: n * planes + planes swept

  // At most as many steps are in flight as there are threads; one more place keeps the step before
  // the oldest of them.
  explicit Crew(int count) : finished(std::size_t(count) + 1) {
    for (int t = 1; t < count; ++t) threads.emplace_back([this, t] { serve(t); });
  }
  ~Crew() {
    {
      const std::lock_guard lock(mutex);
      leaving = true;
    }
    wake.notify_all();
    for (std::thread& thread : threads) thread.join();
  }

  void serve(int self) {
    for (std::int64_t seen = 0;;) {
      Task mine;
      {
        std::unique_lock lock(mutex);
        wake.wait(lock, [&] { return leaving || task.run != seen; });
        if (leaving) return;
        mine = task;
      }
      seen = mine.run;
      if (self < mine.threads) march(mine, self);
    }
  }

  Counter& finished_of(int step) { return finished[std::size_t(step) % finished.size()]; }

  /// The next step of this run; -1 when all are taken. A thread that woke up too late finds
  /// another run's number and takes nothing.
  int take(const Task& t) {
    std::int64_t seen = next.value.load(std::memory_order_acquire);
    while (seen >> 32 == t.run && int(seen & 0xffffffff) < t.steps) {
      if (next.value.compare_exchange_weak(seen, seen + 1, std::memory_order_acq_rel))
        return int(seen & 0xffffffff);
    }
    return -1;
  }

  void march(const Task& t, int self) {
    for (int step = take(t); step >= 0; step = take(t)) {
      for (int plane = 0; plane < t.planes; ++plane) {
        if (step > 0) {
          finished_of(step - 1).wait_for(std::int64_t(step - 1) * t.planes +
                                         std::min(plane + 2, t.planes));
        }
        t.sweep.call(t.sweep.self, self, plane);
        finished_of(step).value.store(std::int64_t(step) * t.planes + plane + 1,
                                      std::memory_order_release);
      }
    }
  }

  void run(Task t) {
    for (Counter& counter : finished) counter.value.store(0, std::memory_order_relaxed);
    {
      const std::lock_guard lock(mutex);
      t.run = task.run + 1;
      task = t;
      next.value.store(t.run << 32, std::memory_order_release);
    }
    if (t.threads > 1) wake.notify_all();
    march(t, 0);
    if (t.steps > 0) finished_of(t.steps - 1).wait_for(std::int64_t(t.steps) * t.planes);
  }
};

Wavefront::Wavefront(int threads) : crew_(std::make_unique<Crew>(threads)) {}
Wavefront::~Wavefront() = default;

int Wavefront::threads() const {
  return int(crew_->threads.size()) + 1;
}

void Wavefront::run(int steps, int planes, int threads, Borrowed sweep) {
  crew_->run({steps, planes, threads, 0, sweep});
}

}  // namespace fingertip::lattice::springs
