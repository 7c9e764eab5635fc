/// The live view of one page, without a server: takes the page's messages, has the answers.
#pragma once

#include <chrono>
#include <deque>
#include <string>
#include <string_view>

#include "studies/live/paced_rig.h"
#include "studies/live/viewer.h"
#include "studies/web/web_press.h"

namespace fingertip::studies::inline web {

/// As a websocket would carry it: a text or a binary message.
struct WebMessage {
  bool is_text = true;
  std::string bytes;
};

/// What LiveServer and Simulation are to many pages, in one thread that somebody calls often.
class PageSession {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Paused; the scene waits. Throws InvalidInput.
  explicit PageSession(const WebPress& press);

  /// From the page.
  void take(std::string_view text);
  /// Advances as far as the wall clock has come, for about `budget`. Returns how long there is
  /// nothing to do unless the page says something.
  Seconds run(Seconds budget);
  /// What waits for the page, in its order.
  std::deque<WebMessage> answers();

 private:
  void tell(const LiveFrame& frame);
  void show(const std::shared_ptr<const LiveScene>& scene);

  WebPress press_;
  PacedRig paced_;
  Viewer viewer_;
  std::deque<WebMessage> answers_;
};

/// Simulated over wall time of such a press at the usual speed, as fast as this machine can: from
/// its start until it is past first touch and `wall` is over, or four times that. Throws
/// InvalidInput, NotConverged.
double pace_of(const WebPress& press, std::chrono::duration<double> wall);

}  // namespace fingertip::studies::inline web
