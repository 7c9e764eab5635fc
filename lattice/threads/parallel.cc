#include "lattice/threads/parallel.h"

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <exception>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "lattice/threads/spin.h"

namespace fingertip::lattice::inline threads {

namespace {

using std::chrono::microseconds;

/// How long threads without work stay awake. The longest serial part of a step takes half of it;
/// waking up takes a tenth.
constexpr microseconds patience{100};
/// The same where others want the core.
constexpr microseconds yield_time{5};

/// Per thread and loop. More even out loops of uneven iterations and shorten the wait for a thread
/// that lost its core amid a piece; each costs some 20 ns.
constexpr std::size_t pieces_per_thread = 4;
constexpr int max_threads = 4096;  // a number of a piece has 16 bits

/// Pieces that nobody has taken yet, first and end in one word; those at the front are its owner's.
struct Range {
  std::uint32_t first, end;
};
constexpr std::uint32_t pack(Range range) {
  return range.first << 16 | range.end;
}
constexpr Range unpack(std::uint32_t word) {
  return {word >> 16, word & 0xffff};
}
constexpr std::uint32_t leave = pack({0xffff, 0});  // no range of pieces

}  // namespace

class Team::Crew {
 public:
  Crew(int threads) : shares_(std::size_t(threads)) {
    const bool crowded = unsigned(threads) > std::thread::hardware_concurrency();
    patience_ = crowded ? yield_time : patience;
    for (std::size_t self = 1; self < shares_.size(); ++self) {
      threads_.emplace_back([this, self] { serve(self); });
    }
  }
  ~Crew() {
    for (Share& share : shares_) {
      share.left.store(leave);
      share.left.notify_one();
    }
    for (std::thread& thread : threads_) thread.join();
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  /// Runs the loop in pieces; false if another one is running.
  bool run(std::size_t count, std::size_t pieces, const Borrowed& body) {
    if (running_.exchange(true, std::memory_order_acquire)) return false;
    unfinished_.store(std::uint32_t(pieces), std::memory_order_relaxed);
    for (std::size_t n = shares_.size(); n-- > 0;) {
      Share& share = shares_[n];
      const Range mine{std::uint32_t(pieces * n / shares_.size()),
                       std::uint32_t(pieces * (n + 1) / shares_.size())};
      share.loop = {count, pieces, body};
      // Ordered with the look at who sleeps: no call gets lost.
      share.left.exchange(pack(mine), std::memory_order_seq_cst);
      if (n > 0) share.left.notify_one();
    }
    work(0);
    const auto finished = [this] { return unfinished_.load(std::memory_order_acquire) == 0; };
    while (!spin_until(finished, patience_)) {
      const std::uint32_t missing = unfinished_.load(std::memory_order_acquire);
      if (missing > 0) unfinished_.wait(missing);
    }
    const std::exception_ptr failure = std::exchange(failure_, nullptr);
    running_.store(false, std::memory_order_release);
    if (failure) std::rethrow_exception(failure);
    return true;
  }

 private:
  struct Loop {
    std::size_t count = 0, pieces = 0;
    Borrowed body;
  };
  /// On cache lines of its own, with all that a thread has to know: news reach it in one transfer.
  /// Only who has taken a piece may read the loop, which stays as it is until that piece is
  /// finished.
  struct alignas(128) Share {
    std::atomic<std::uint32_t> left{0};
    Loop loop;
  };

  void serve(std::size_t self) {
    Share& own = shares_[self];
    for (;;) {
      const std::uint32_t seen = own.left.load(std::memory_order_acquire);
      if (seen == leave) return;
      if (const Range range = unpack(seen); range.first < range.end) {
        work(self);
        continue;
      }
      const auto news = [&] { return own.left.load(std::memory_order_relaxed) != seen; };
      if (!spin_until(news, patience_)) own.left.wait(seen);
    }
  }

  /// Its own share from the front, then from the back what others have not begun.
  void work(std::size_t self) {
    std::uint32_t finished = 0;
    for (std::size_t n = 0; n < shares_.size(); ++n) {
      Share& share = shares_[(self + n) % shares_.size()];
      for (std::uint32_t piece = 0; take(share, n == 0, piece); ++finished) {
        perform(share.loop, piece);
      }
    }
    if (finished > 0 && unfinished_.fetch_sub(finished) == finished && self != 0) {
      unfinished_.notify_one();
    }
  }

  static bool take(Share& share, bool in_front, std::uint32_t& piece) {
    std::uint32_t seen = share.left.load(std::memory_order_relaxed);
    for (;;) {
      const Range range = unpack(seen);
      if (range.first >= range.end) return false;
      piece = in_front ? range.first : range.end - 1;
      const Range rest{range.first + (in_front ? 1 : 0), range.end - (in_front ? 0 : 1)};
      if (share.left.compare_exchange_weak(seen, pack(rest), std::memory_order_acq_rel,
                                           std::memory_order_relaxed)) {
        return true;
      }
    }
  }

  void perform(const Loop& loop, std::size_t piece) {
    try {
      loop.body.call(loop.body.self, loop.count * piece / loop.pieces,
                     loop.count * (piece + 1) / loop.pieces);
    } catch (...) {
      const std::lock_guard lock(failing_);
      if (!failure_ || piece < failed_piece_) {
        failure_ = std::current_exception();
        failed_piece_ = piece;
      }
    }
  }

  std::vector<Share> shares_;                              ///< per thread
  alignas(128) std::atomic<std::uint32_t> unfinished_{0};  ///< pieces
  alignas(128) std::atomic<bool> running_{false};
  microseconds patience_;
  std::mutex failing_;
  std::exception_ptr failure_;
  std::size_t failed_piece_ = 0;
  std::vector<std::thread> threads_;
};

Team::Team(int threads)
    : threads_(std::clamp(threads > 0 ? threads : int(std::thread::hardware_concurrency()), 1,
                          max_threads)) {
  if (threads_ > 1) crew_ = std::make_shared<Crew>(threads_);
}

void Team::run(std::size_t count, std::size_t grain, Borrowed body) {
  if (count == 0) return;
  const std::size_t pieces =
      std::min(count / std::max<std::size_t>(grain, 1), pieces_per_thread * std::size_t(threads_));
  if (crew_ && pieces > 1 && crew_->run(count, pieces, body)) return;
  body.call(body.self, 0, count);
}

}  // namespace fingertip::lattice::inline threads
