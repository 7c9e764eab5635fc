#include "lattice/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace fingertip::lattice {

struct Team::Arena {
  explicit Arena(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

Team::Team(int threads)
    : threads_(threads > 0 ? threads : tbb::info::default_concurrency()),
      arena_(threads_ > 1 ? std::make_unique<Arena>(threads_) : nullptr) {}
Team::~Team() = default;
Team::Team(Team&&) noexcept = default;
Team& Team::operator=(Team&&) noexcept = default;

void Team::run(std::size_t count, std::size_t grain, Borrowed body) {
  if (!arena_ || count <= grain) {
    if (count > 0) body.call(body.self, 0, count);
    return;
  }
  arena_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, count, grain),
        [body](const tbb::blocked_range<std::size_t>& piece) {
          body.call(body.self, piece.begin(), piece.end());
        },
        tbb::static_partitioner());
  });
}

}  // namespace fingertip::lattice
