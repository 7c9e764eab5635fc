// Prints what loops cost on the lattice's own threads (lattice/threads/parallel.h) and on oneTBB's,
// on a quiet machine and beside threads that never rest: microseconds of wall time, medians and, in
// brackets, means; they take turns of a tenth of a second. Not a test:
// lattice/MEASUREMENTS.md quotes it.
// Usage: lattice_measure_team [threads = 2] [busy threads = 1] [steps per radius = 12]
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <numeric>
#include <string>
#include <thread>
#include <vector>

#include "lattice/forces/cell_arrays.h"
#include "lattice/kernels/cell_kernel.h"
#include "lattice/threads/parallel.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;

namespace {

/// The same interface over oneTBB.
class TbbTeam {
 public:
  explicit TbbTeam(int threads) : arena_(threads) {}

  template <typename Body>
  void split(std::size_t count, std::size_t grain, const Body& body) {
    arena_.execute([&] {
      tbb::parallel_for(
          tbb::blocked_range<std::size_t>(0, count, grain),
          [&](const tbb::blocked_range<std::size_t>& piece) { body(piece.begin(), piece.end()); },
          tbb::static_partitioner());
    });
  }

 private:
  tbb::task_arena arena_;
};

/// One thread.
struct Alone {
  template <typename Body>
  void split(std::size_t count, std::size_t /*grain*/, const Body& body) {
    body(std::size_t(0), count);
  }
};

using Clock = std::chrono::steady_clock;

double microseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// Multiplications that wait for each other, `length` of them.
double chain(int length) {
  double x = 1.0;
  for (int i = 0; i < length; ++i) x = x * 0.999999 + 1e-9;
  return x;
}

int chain_of(double microseconds) {
  const auto start = Clock::now();
  volatile double sink = chain(2000000);
  (void)sink;
  return int(2000000 * microseconds / microseconds_since(start));
}

struct Statistics {
  double median, mean;
};
Statistics of(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  const double sum = std::accumulate(times.begin(), times.end(), 0.0);
  return {times[times.size() / 2], sum / double(times.size())};
}

/// `work` with one thread, our threads and oneTBB's in turns.
template <typename Work>
void compare(const std::string& what, int threads, const Work& work) {
  constexpr double turn = 1e5;  // [us]: long enough for the system to find cores for the threads
  constexpr int turns = 5;
  Alone alone;
  lattice::Team team(threads);
  TbbTeam tbb(threads);
  const auto take_turn = [&](auto& scheduler, std::vector<double>& times) {
    for (const auto begin = Clock::now(); microseconds_since(begin) < turn;) {
      const auto start = Clock::now();
      work(scheduler);
      times.push_back(microseconds_since(start));
    }
  };
  std::vector<double> serial, ours, theirs;
  for (int n = 0; n < turns; ++n) {
    take_turn(alone, serial);
    take_turn(team, ours);
    take_turn(tbb, theirs);
  }
  const Statistics a = of(serial), b = of(ours), c = of(theirs);
  std::printf("  %-34s %7.2f (%7.2f) %7.2f (%7.2f) %7.2f (%7.2f)  %5.2f (%4.2f) %5.2f (%4.2f)\n",
              what.c_str(), a.median, a.mean, b.median, b.mean, c.median, c.mean,
              a.median / b.median, a.mean / b.mean, a.median / c.median, a.mean / c.mean);
}

/// The loops of Finger's internal forces, `network` at finite strain.
class Sweeps {
 public:
  explicit Sweeps(int per_radius)
      : model_(tip(lattice::ModelKind::network, lattice::Kinematics::finite, per_radius)),
        state_(random_state(model_, 0.01, 0.01, 7)),
        force_(model_.points()),
        sweep_(lattice::kernel::select_cells(model_.cell_lattice.material.kind,
                                             lattice::kernel::CellTask::damped, 0)) {}

  template <typename Scheduler>
  void operator()(Scheduler& scheduler) const {
    const auto& cells = model_.cell_lattice;
    auto arrays = lattice::cell_arrays(cells, state_.displacement);
    for (std::size_t c = 0; c < 3; ++c) {
      arrays.velocity[c] = state_.velocity.component[c].data();
      arrays.force[c] = force_.component[c].data();
    }
    scheduler.split(model_.blocks.size(), 16, [&](std::size_t begin, std::size_t end) {
      for (auto& component : force_.component) {
        for (std::size_t b = begin; b < end; ++b)
          std::fill_n(component.data() + model_.blocks[b], lattice::lanes, 0.0);
      }
    });
    for (const auto& slabs : cells.slabs) {
      scheduler.split(slabs.size(), 1, [&](std::size_t begin, std::size_t end) {
        lattice::kernel::CellBounds bounds;
        for (std::size_t s = begin; s < end; ++s) {
          sweep_(arrays, cells.blocks.data(), slabs[s].first, slabs[s].last, bounds);
        }
      });
    }
  }

 private:
  lattice::LatticeModel model_;
  lattice::State state_;
  mutable lattice::VectorField force_;
  lattice::kernel::CellSweep sweep_;
};

void measure(int threads, const Sweeps& sweeps) {
  std::printf("  %-34s %17s %17s %17s  ratios to one\n", "", "one thread", "ours", "oneTBB");
  compare("empty loop", threads,
          [](auto& scheduler) { scheduler.split(1000, 1, [](std::size_t, std::size_t) {}); });
  for (const double length : {5.0, 20.0, 100.0}) {
    const int links = chain_of(length / 64.0);
    std::atomic<long> sink{0};
    compare("loop of " + std::to_string(int(length)) + " us", threads, [&](auto& scheduler) {
      scheduler.split(64, 1, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t i = begin; i < end; ++i) sum += chain(links);
        sink.fetch_add(long(sum), std::memory_order_relaxed);
      });
    });
  }
  compare("sweeps of a step", threads, sweeps);
  const int pause = chain_of(30.0);
  compare("the same and 30 us of serial work", threads, [&](auto& scheduler) {
    sweeps(scheduler);
    volatile double sink = chain(pause);
    (void)sink;
  });
}

}  // namespace

int main(int count, char** values) {
  const int threads = count > 1 ? std::atoi(values[1]) : 2;
  const int busy = count > 2 ? std::atoi(values[2]) : 1;
  const int per_radius = count > 3 ? std::atoi(values[3]) : 12;
  if (threads < 1 || busy < 0 || per_radius < 4) return 2;
  const Sweeps sweeps(per_radius);
  std::printf("%d threads\n", threads);
  measure(threads, sweeps);
  if (busy == 0) return 0;
  std::printf("beside %d busy threads\n", busy);
  std::atomic<bool> enough{false};
  std::vector<std::thread> others;
  for (int n = 0; n < busy; ++n) {
    others.emplace_back([&] {
      while (!enough.load(std::memory_order_relaxed)) {
      }
    });
  }
  measure(threads, sweeps);
  enough = true;
  for (std::thread& other : others) other.join();
}
