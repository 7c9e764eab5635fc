/// One page: what it was sent, and whether it waits for more.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "studies/live/protocol.h"
#include "studies/live/row_history.h"

namespace fingertip::studies::inline live {

/// Gets a frame only after it has acknowledged the one before: a slow page is sent less.
class Viewer {
 public:
  /// Only frames later than number `last` are for it.
  explicit Viewer(std::uint64_t last = 0) : sent_(last), acknowledged_(last) {}

  void acknowledge(std::uint64_t number) {
    if (number <= sent_) acknowledged_ = std::max(acknowledged_, number);
  }
  bool waits() const { return acknowledged_ == sent_; }
  bool waits_for(const LiveFrame& frame) const { return waits() && sent_ != frame.number; }
  /// Whether the page was sent the scene of a frame; if not, it comes before it.
  bool knows(const std::shared_ptr<const LiveScene>& scene) const { return scene_ == scene; }
  /// It was; the page has forgotten its rows.
  void shown(const std::shared_ptr<const LiveScene>& scene) {
    scene_ = scene;
    next_row_ = 0;
  }

  /// `frame` as it is sent, with at most 600 of the rows that the page does not have yet.
  std::string send(const LiveFrame& frame, const RowHistory& history) {
    constexpr std::size_t rows_per_frame = 600;
    if (epoch_ != frame.epoch) next_row_ = 0;
    epoch_ = frame.epoch;
    const LiveRows rows = history.from(next_row_, rows_per_frame);
    next_row_ = rows.next;
    sent_ = frame.number;
    return encode_frame(frame, rows.rows);
  }

 private:
  std::uint64_t sent_, acknowledged_, epoch_ = 0, next_row_ = 0;
  std::shared_ptr<const LiveScene> scene_;
};

}  // namespace fingertip::studies::inline live
