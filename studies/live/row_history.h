/// Rows of the plots since the last reset, for threads that read them while another one adds some.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <mutex>
#include <vector>

#include "studies/live/rig.h"

namespace fingertip::studies::inline live {

/// Rows with a running number; `next` is that of the row to ask for afterwards.
struct LiveRows {
  std::uint64_t next = 0;
  std::vector<LiveRow> rows;
};

/// The oldest ones are dropped, beyond 60 000.
class RowHistory {
 public:
  void add(const LiveRow& row) {
    const std::lock_guard lock(mutex_);
    rows_.push_back(row);
    if (rows_.size() <= most_kept) return;
    rows_.pop_front();
    ++first_;
  }

  /// Forgets all; `row` becomes number 0.
  void restart(const LiveRow& row) {
    const std::lock_guard lock(mutex_);
    rows_.assign(1, row);
    first_ = 0;
  }

  /// From number `first` on, thinned to at most `most`.
  LiveRows from(std::uint64_t first, std::size_t most) const {
    const std::lock_guard lock(mutex_);
    const std::uint64_t end = first_ + rows_.size();
    first = std::clamp(first, first_, end);
    const std::size_t count = std::size_t(end - first);
    const std::size_t stride = std::max<std::size_t>(1, (count + most - 1) / most);
    LiveRows answer{end, {}};
    for (std::size_t i = stride - 1; i < count; i += stride)
      answer.rows.push_back(rows_[std::size_t(first - first_) + i]);
    return answer;
  }

 private:
  static constexpr std::size_t most_kept = 60000;
  mutable std::mutex mutex_;
  std::deque<LiveRow> rows_;
  std::uint64_t first_ = 0;  ///< number of rows_.front()
};

}  // namespace fingertip::studies::inline live
