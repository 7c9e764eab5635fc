#include "studies/live/simulation.h"

#include <algorithm>
#include <chrono>

namespace fingertip::studies::inline live {

namespace {

using namespace std::chrono_literals;
using Clock = PacedRig::Clock;

constexpr std::size_t max_orders = 256;

}  // namespace

Simulation::Simulation(const lattice::PressSetup& setup, const PaceSettings& pace,
                       std::function<void()> on_frame)
    : paced_(setup, pace), on_frame_(std::move(on_frame)) {
  publish(true);
  thread_ = std::thread([this] { run(); });
}

Simulation::~Simulation() {
  stop();
}

void Simulation::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
}

bool Simulation::post(const LiveMessage& message) {
  {
    const std::lock_guard lock(mutex_);
    if (orders_.size() >= max_orders) return false;
    orders_.push_back(message);
  }
  wake_.notify_all();
  return true;
}

void Simulation::watched_by(int viewers) {
  {
    const std::lock_guard lock(mutex_);
    viewers_ = viewers;
    frame_wanted_ = true;
  }
  wake_.notify_all();
}

std::shared_ptr<const LiveFrame> Simulation::frame() const {
  const std::lock_guard lock(mutex_);
  return frame_;
}

void Simulation::run() {
  while (true) {
    take_orders();
    {
      std::unique_lock lock(mutex_);
      if (stopping_) return;
      if (paced_.idle() && orders_.empty())
        wake_.wait_for(lock, paced_.changed() ? PacedRig::frame_interval : 100ms);
    }
    if (!paced_.idle()) {
      paced_.advance();
      if (paced_.running()) keep_pace();
    }
    paced_.measure_pace();
    publish(false);
  }
}

void Simulation::take_orders() {
  std::deque<LiveMessage> orders;
  {
    const std::lock_guard lock(mutex_);
    orders.swap(orders_);
    if (frame_wanted_) paced_.want_frame();
    frame_wanted_ = false;
  }
  for (const LiveMessage& order : orders) paced_.obey(order);
}

/// Waits until the wall clock has come to where the simulation is; orders end the wait.
void Simulation::keep_pace() {
  const Clock::time_point due = paced_.due();
  while (Clock::now() < due) {
    paced_.measure_pace();
    publish(false);
    std::unique_lock lock(mutex_);
    if (stopping_ || !orders_.empty()) return;
    wake_.wait_until(lock, std::min(due, Clock::now() + PacedRig::frame_interval));
  }
}

void Simulation::publish(bool in_any_case) {
  if (!in_any_case) {
    if (!paced_.frame_due()) return;
    const std::lock_guard lock(mutex_);
    if (viewers_ == 0) return;
  }
  auto frame = std::make_shared<LiveFrame>(paced_.frame());
  {
    const std::lock_guard lock(mutex_);
    frame_ = std::move(frame);
  }
  if (on_frame_) on_frame_();
}

}  // namespace fingertip::studies::inline live
