#include "lattice/springs/wavefront.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#if defined(__x86_64__)
#include <emmintrin.h>
#endif

namespace fingertip::lattice::springs {

namespace {

void rest_a_little(int& spins) {
  constexpr int patience = 2000;  // some 20 us: longer than a plane takes
  if (++spins < patience) {
    _mm_pause();
  } else {
    std::this_thread::yield();
  }
}

/// Planes that one thread has finished since a run began, on a cache line of its own.
struct alignas(128) Progress {
  std::atomic<long> planes{0};

  void wait_for(long needed) const {
    for (int spins = 0; planes.load(std::memory_order_acquire) < needed;) rest_a_little(spins);
  }
};

}  // namespace

struct Wavefront::Crew {
  std::vector<Progress> progress;
  std::vector<std::thread> threads;
  std::mutex mutex;
  std::condition_variable wake;
  long runs = 0;  // guarded by the mutex, like `leaving` and `task`
  bool leaving = false;
  Task task;
  std::atomic<int> busy{0};

  explicit Crew(int count) : progress(std::size_t(count)) {
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
    for (long seen = 0;;) {
      Task mine;
      {
        std::unique_lock lock(mutex);
        wake.wait(lock, [&] { return leaving || runs != seen; });
        if (leaving) return;
        seen = runs;
        mine = task;
      }
      if (self >= mine.threads) continue;
      march(mine, self);
      busy.fetch_sub(1, std::memory_order_release);
    }
  }

  /// The groups self, self + threads, ... of steps.
  void march(const Task& t, int self) {
    const int groups = (t.steps + t.group - 1) / t.group;
    const Progress& ahead = progress[std::size_t((self + t.threads - 1) % t.threads)];
    Progress& mine = progress[std::size_t(self)];
    long finished = 0;
    for (int g = self; g < groups; g += t.threads) {
      const int depth = std::min(t.group, t.steps - g * t.group);
      const long before = g == 0 ? 0 : long((g - 1) / t.threads) * t.planes;
      for (int front = 0; front < t.planes + 2 * (depth - 1); ++front) {
        for (int k = 0; k < depth; ++k) {
          const int plane = front - 2 * k;
          if (plane < 0 || plane >= t.planes) continue;
          if (k == 0 && g > 0) ahead.wait_for(before + std::min(plane + 2, t.planes));
          t.sweep.call(t.sweep.self, self * t.group + k, plane);
          if (k == depth - 1) mine.planes.store(++finished, std::memory_order_release);
        }
      }
    }
  }
};

Wavefront::Wavefront(int threads) : crew_(std::make_unique<Crew>(threads)) {}
Wavefront::~Wavefront() = default;

int Wavefront::threads() const {
  return int(crew_->progress.size());
}

void Wavefront::run(int steps, int planes, int threads, int group, Borrowed sweep) {
  const Task task{steps, planes, threads, group, sweep};
  for (Progress& p : crew_->progress) p.planes.store(0, std::memory_order_relaxed);
  if (threads > 1) {
    crew_->busy.store(threads - 1, std::memory_order_relaxed);
    {
      const std::lock_guard lock(crew_->mutex);
      crew_->task = task;
      ++crew_->runs;
    }
    crew_->wake.notify_all();
  }
  crew_->march(task, 0);
  for (int spins = 0; crew_->busy.load(std::memory_order_acquire) > 0;) rest_a_little(spins);
}

}  // namespace fingertip::lattice::springs
