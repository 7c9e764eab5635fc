#include "studies/live/simulation.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::inline live {

namespace {

using namespace std::chrono_literals;

constexpr std::size_t max_orders = 256;
constexpr std::size_t max_rows = 60000;
constexpr auto frame_interval = 33ms;
constexpr auto pace_window = 500ms;
/// Further behind the wanted speed than this is not caught up.
constexpr double patience = 0.05;
constexpr double slowest = 0.01;  // real-time factor

}  // namespace

Simulation::Simulation(const lattice::PressSetup& setup, bool paused, double rate,
                       std::function<void()> on_frame)
    : rig_(setup),
      on_frame_(std::move(on_frame)),
      status_(paused ? LiveStatus::paused : LiveStatus::running),
      rate_(rate) {
  rows_.push_back(rig_.row());
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

LiveRows Simulation::rows_from(std::uint64_t first, std::size_t most) const {
  const std::lock_guard lock(mutex_);
  const std::uint64_t end = first_row_ + rows_.size();
  first = std::clamp(first, first_row_, end);
  const std::size_t count = std::size_t(end - first);
  const std::size_t stride = std::max<std::size_t>(1, (count + most - 1) / most);
  LiveRows answer{end, {}};
  for (std::size_t i = stride - 1; i < count; i += stride) {
    answer.rows.push_back(rows_[std::size_t(first - first_row_) + i]);
  }
  return answer;
}

void Simulation::run() {
  restart_pace();
  while (true) {
    take_orders();
    {
      std::unique_lock lock(mutex_);
      if (stopping_) return;
      const bool idle = status_ != LiveStatus::running && steps_wanted_ == 0;
      if (idle && orders_.empty()) wake_.wait_for(lock, changed_ ? frame_interval : 100ms);
    }
    if (status_ == LiveStatus::running || steps_wanted_ > 0) {
      advance();
      if (status_ == LiveStatus::running) keep_pace();
    }
    measure_pace();
    publish(false);
  }
}

void Simulation::take_orders() {
  std::deque<LiveMessage> orders;
  {
    const std::lock_guard lock(mutex_);
    orders.swap(orders_);
    changed_ = changed_ || frame_wanted_;
    frame_wanted_ = false;
  }
  for (const LiveMessage& order : orders) obey(order);
  if (!orders.empty()) changed_ = true;
}

void Simulation::obey(const LiveMessage& order) {
  const bool failed = status_ == LiveStatus::failed;
  if (const Adjust* change = std::get_if<Adjust>(&order)) {
    adjust(*change);
  } else if (const HandHolds* hold = std::get_if<HandHolds>(&order)) {
    rig_.hold(hold->place);
  } else if (std::holds_alternative<HandLetsGo>(order)) {
    rig_.release();
  } else if (const Transport* transport = std::get_if<Transport>(&order)) {
    switch (*transport) {
      case Transport::run:
        if (!failed) status_ = LiveStatus::running;
        break;
      case Transport::pause:
        if (!failed) status_ = LiveStatus::paused;
        break;
      case Transport::step:
        if (failed) break;
        status_ = LiveStatus::paused;
        ++steps_wanted_;
        break;
      case Transport::reset: {
        rig_.reset();
        if (failed) status_ = LiveStatus::paused;
        failure_.clear();
        steps_wanted_ = 0;
        ++epoch_;
        const std::lock_guard lock(mutex_);
        rows_.assign(1, rig_.row());
        first_row_ = 0;
        break;
      }
    }
    restart_pace();
  }
}

void Simulation::adjust(const Adjust& order) {
  if (order.name == "rate") {
    rate_ = order.value > 0.0 ? std::clamp(order.value, slowest, 1.0) : 0.0;
    restart_pace();
    return;
  }
  LiveSettings settings = rig_.settings();
  for (const Slider& slider : sliders)
    if (order.name == slider.name) settings.*slider.value = order.value;
  if (order.name == "contact_force") settings.contact_force = order.value;
  if (order.name == "controller") settings.controller = order.value != 0.0;
  rig_.set(settings);
}

void Simulation::advance() {
  if (steps_wanted_ > 0) --steps_wanted_;
  changed_ = true;
  try {
    rig_.advance();
  } catch (const std::runtime_error& error) {  // NotConverged, ControllerFailed
    status_ = LiveStatus::failed;
    failure_ = error.what();
    steps_wanted_ = 0;
    return;
  }
  const std::lock_guard lock(mutex_);
  rows_.push_back(rig_.row());
  if (rows_.size() > max_rows) {
    rows_.pop_front();
    ++first_row_;
  }
}

void Simulation::restart_pace() {
  pace_start_ = Clock::now();
  pace_time_ = rig_.time();
  pace_marks_.clear();
  achieved_ = 0.0;
}

/// Waits until the wall clock has come to where the simulation is; orders end the wait.
void Simulation::keep_pace() {
  if (!(rate_ > 0.0)) return;
  const auto due =
      pace_start_ + std::chrono::duration_cast<Clock::duration>(
                        std::chrono::duration<double>((rig_.time() - pace_time_) / rate_));
  const Clock::time_point now = Clock::now();
  if (std::chrono::duration<double>(now - due).count() > patience) {
    pace_start_ = now;
    pace_time_ = rig_.time();
  }
  while (Clock::now() < due) {
    measure_pace();
    publish(false);
    std::unique_lock lock(mutex_);
    if (stopping_ || !orders_.empty()) return;
    wake_.wait_until(lock, std::min(due, Clock::now() + frame_interval));
  }
}

void Simulation::measure_pace() {
  if (status_ != LiveStatus::running) return;
  const Clock::time_point now = Clock::now();
  if (pace_marks_.empty() || now - pace_marks_.back().first > frame_interval) {
    pace_marks_.emplace_back(now, rig_.time());
  }
  while (pace_marks_.size() > 2 && now - pace_marks_[1].first > pace_window) {
    pace_marks_.pop_front();
  }
  const double wall = std::chrono::duration<double>(now - pace_marks_.front().first).count();
  if (wall > 0.1) achieved_ = (rig_.time() - pace_marks_.front().second) / wall;
  if (wall > std::chrono::duration<double>(pace_window).count())
    slowest_factor_ = std::fmin(slowest_factor_, achieved_);
}

void Simulation::publish(bool in_any_case) {
  const Clock::time_point now = Clock::now();
  if (!in_any_case) {
    if (!changed_ || now - last_frame_ < frame_interval) return;
    const std::lock_guard lock(mutex_);
    if (viewers_ == 0) return;
  }
  auto frame = std::make_shared<LiveFrame>();
  frame->number = ++frames_;
  frame->epoch = epoch_;
  frame->status = status_;
  frame->failure = failure_;
  frame->real_time_factor = achieved_;
  frame->state = {rig_.settings(), rate_};
  frame->picture = rig_.picture();
  last_frame_ = now;
  changed_ = false;
  {
    const std::lock_guard lock(mutex_);
    frame_ = std::move(frame);
  }
  if (on_frame_) on_frame_();
}

}  // namespace fingertip::studies::inline live
