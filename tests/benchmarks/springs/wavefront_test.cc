// The order in which threads sweep planes, on a recurrence with the sweep's dependences.
#include "tests/benchmarks/springs/engine/wavefront.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

using fingertip::lattice::springs::Wavefront;

namespace {

/// Numbers on planes. A step takes plane z from itself, from the next one before its step, and
/// from what the plane before left in the buffer of the thread, all mixed so that any other order
/// gives other numbers.
class Recurrence {
 public:
  Recurrence(int planes, int threads) : value_(std::size_t(planes)), left_(std::size_t(threads)) {
    for (std::size_t z = 0; z < value_.size(); ++z) value_[z] = z + 1;
  }
  void sweep(int thread, int plane) {
    const std::size_t z = std::size_t(plane);
    const std::uint64_t next = z + 1 < value_.size() ? value_[z + 1] : 0;
    std::uint64_t& left = left_[std::size_t(thread)];
    const std::uint64_t from_before = plane == 0 ? 0 : left;
    left = value_[z] * 31 + next;
    value_[z] = value_[z] * 6364136223846793005u + next * 1442695040888963407u + from_before;
  }
  const std::vector<std::uint64_t>& values() const { return value_; }

 private:
  std::vector<std::uint64_t> value_, left_;
};

std::vector<std::uint64_t> serial(int steps, int planes) {
  Recurrence recurrence(planes, 1);
  for (int n = 0; n < steps; ++n)
    for (int z = 0; z < planes; ++z) recurrence.sweep(0, z);
  return recurrence.values();
}

}  // namespace

TEST(Wavefront, SweepsAsOneThreadWould) {
  for (const int ready : {1, 2, 3, 5}) {
    Wavefront wavefront(ready);
    for (int threads = 1; threads <= ready; ++threads) {
      for (const int planes : {1, 2, 3, 20}) {
        for (const int steps : {0, 1, 2, 7, 40, 200}) {
          Recurrence recurrence(planes, threads);
          wavefront.run(steps, planes, threads,
                        [&](int thread, int plane) { recurrence.sweep(thread, plane); });
          EXPECT_EQ(recurrence.values(), serial(steps, planes))
              << threads << " of " << ready << " threads, " << planes << " planes, " << steps
              << " steps";
        }
      }
    }
  }
}
