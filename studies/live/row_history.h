/// Rows of the plots since the last reset, for threads that read them while another one adds some.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "studies/live/rig.h"

namespace fingertip::studies::inline live {

/// Rows with a running number; `next` is that of the row to ask for afterwards.
struct LiveRows {
  std::uint64_t next = 0;
  std::vector<LiveRow> rows;
};

/// Beyond 60 000 the older half is thinned, evenly along the curves: however long a finger has
/// rested, how it was pressed stays.
class RowHistory {
 public:
  void add(const LiveRow& row) {
    const std::lock_guard lock(mutex_);
    rows_.push_back({next_++, row});
    if (rows_.size() <= most_kept) return;
    constexpr std::size_t older = most_kept / 2;
    std::vector<Numbered> kept = thinned(std::span(rows_).first(older), older / 2);
    kept.insert(kept.end(), rows_.begin() + std::ptrdiff_t(older), rows_.end());
    rows_ = std::move(kept);
  }

  /// Forgets all; `row` becomes number 0.
  void restart(const LiveRow& row) {
    const std::lock_guard lock(mutex_);
    rows_.assign(1, {0, row});
    next_ = 1;
  }

  /// From number `first` on, thinned to at most `most`.
  LiveRows from(std::uint64_t first, std::size_t most) const {
    const std::lock_guard lock(mutex_);
    const auto before = [](const Numbered& one, std::uint64_t number) {
      return one.number < number;
    };
    const auto begin = std::lower_bound(rows_.begin(), rows_.end(), first, before);
    const auto wanted = std::span(rows_).subspan(std::size_t(begin - rows_.begin()));
    LiveRows answer{next_, {}};
    for (const Numbered& one : thinned(wanted, most)) answer.rows.push_back(one.row);
    return answer;
  }

 private:
  struct Numbered {
    std::uint64_t number;
    LiveRow row;
  };

  /// At most `most` > 1 of them, the ends among them, as far apart as can be in time,
  /// indentation and force, each over all of its way.
  static std::vector<Numbered> thinned(std::span<const Numbered> all, std::size_t most) {
    if (all.size() <= most) return {all.begin(), all.end()};
    constexpr double LiveRow::*shown[] = {&LiveRow::time, &LiveRow::indentation,
                                          &LiveRow::normal_force};
    std::vector<double> place(all.size(), 0.0);  // along the curves, to 1 for each of them
    for (const auto value : shown) {
      const auto way = [&](std::size_t i) {
        return std::abs(all[i].row.*value - all[i - 1].row.*value);
      };
      double whole = 0.0, so_far = 0.0;
      for (std::size_t i = 1; i < all.size(); ++i) whole += way(i);
      if (!(whole > 0.0)) continue;
      for (std::size_t i = 1; i < all.size(); ++i) place[i] += (so_far += way(i)) / whole;
    }
    const double step = place.back() / double(most - 1);
    std::vector<Numbered> some{all.front()};
    for (std::size_t i = 1; i + 1 < all.size(); ++i)
      if (some.size() + 1 < most && place[i] >= step * double(some.size())) some.push_back(all[i]);
    some.push_back(all.back());
    return some;
  }

  static constexpr std::size_t most_kept = 60000;
  mutable std::mutex mutex_;
  std::vector<Numbered> rows_;  ///< by increasing number
  std::uint64_t next_ = 0;
};

}  // namespace fingertip::studies::inline live
