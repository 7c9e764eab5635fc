#include "studies/live/paced_rig.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace fingertip::studies::inline live {

namespace {

using Seconds = std::chrono::duration<double>;

constexpr Seconds pace_window(0.5);
/// Further behind the wanted speed than this is not caught up.
constexpr Seconds patience(0.05);
constexpr double slowest = 0.01;  // real-time factor
/// So long a lattice may lag before a coarser one takes over: others may be at work for a moment.
constexpr Seconds forbearance(1.0);
/// Behind by less is no lag.
constexpr double punctual = 0.95;
/// How many times as fast as wanted a lattice should be that is taken: frames cost, too.
constexpr double margin = 1.25;
/// Wall time after which older periods count half [s].
constexpr double memory = 0.25;

}  // namespace

PacedRig::PacedRig(const lattice::PressSetup& setup, const PaceSettings& settings)
    : rig_(setup),
      coarser_(settings.coarser),
      first_spacing_(setup.lattice.spacing),
      status_(settings.paused ? LiveStatus::paused : LiveStatus::running),
      rate_(settings.rate) {
  rows_.restart(rig_.row());
  restart_pace();
}

void PacedRig::obey(const LiveMessage& order) {
  if (const Adjust* change = std::get_if<Adjust>(&order)) {
    adjust(*change);
  } else if (const HandHolds* hold = std::get_if<HandHolds>(&order)) {
    attempt([&] { this->hold(hold->place); });
  } else if (std::holds_alternative<HandLetsGo>(order)) {
    rig_.release();
  } else if (const Transport* transport = std::get_if<Transport>(&order)) {
    obey(*transport);
  }
  changed_ = true;
}

void PacedRig::obey(Transport order) {
  const bool failed = status_ == LiveStatus::failed;
  if (order == Transport::reset) {
    reset();
  } else if (!failed) {
    status_ = order == Transport::run ? LiveStatus::running : LiveStatus::paused;
    if (order == Transport::step) ++steps_wanted_;
  }
  restart_pace();
}

void PacedRig::reset() {
  is_coarsest_ = false;
  rig_.reset();
  if (status_ == LiveStatus::failed) status_ = LiveStatus::paused;
  failure_.clear();
  steps_wanted_ = 0;
  ++epoch_;
  rows_.restart(rig_.row());
}

void PacedRig::adjust(const Adjust& order) {
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

/// Toward a lattice that takes `share` < 1 of the time of this one, of the part that moves or of
/// the `whole`; false where the finger's shape allows none.
bool PacedRig::go_on_coarser(double share, bool whole) {
  const lattice::PressSetup& now = rig_.setup();
  // A step takes time in proportion to its particles; plain ones are as short as the spacing.
  const double power = now.integrator == lattice::Integrator::mass_scaled ? 3.0 : 4.0,
               wanted = now.lattice.spacing * std::pow(share, -1.0 / power),
               next = 1.125 * now.lattice.spacing;
  for (const double spacing : {std::max(wanted, next), next}) {
    try {
      const lattice::PressSetup coarser = coarser_(spacing);
      if (!(coarser.lattice.spacing > now.lattice.spacing)) return false;
      whole ? rig_.go_on_whole(coarser) : rig_.go_on_with(coarser);
      return true;
    } catch (const std::exception&) {  // as fit_moduli, build_tip: this one cannot be had
    }
  }
  return false;
}

/// The whole tip takes as many times as long as there are parts.
void PacedRig::hold(const meshes::Vector3& place) {
  const int sectors = rig_.sectors();
  const double share = busy_.factor() / (sectors * margin * rate_);
  if (sectors > 1 && coarser_ && share < 1.0) go_on_coarser(share, true);
  if (sectors > 1) restart_pace();
  rig_.hold(place);
}

void PacedRig::keep_up() {
  const Clock::time_point now = Clock::now();
  if (achieved_ >= punctual * rate_)
    slow_since_.reset();
  else if (!slow_since_)
    slow_since_ = now;
  if (!coarser_ || is_coarsest_ || !slow_since_ || now - *slow_since_ < forbearance) return;
  is_coarsest_ = !go_on_coarser(achieved_ / (margin * rate_), false);
  changed_ = true;
  restart_pace();
}

/// What goes wrong with a lattice or a controller is told by the frames, until a reset.
void PacedRig::attempt(const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    status_ = LiveStatus::failed;
    failure_ = error.what();
    steps_wanted_ = 0;
  }
}

void PacedRig::advance() {
  if (steps_wanted_ > 0) --steps_wanted_;
  changed_ = true;
  attempt([this] {
    const Clock::time_point begun = Clock::now();
    rig_.advance();
    busy_.simulated += rig_.period();
    busy_.wall += Seconds(Clock::now() - begun).count();
    if (busy_.wall > memory) busy_ = {0.5 * busy_.simulated, 0.5 * busy_.wall};
    rows_.add(rig_.row());
  });
}

void PacedRig::restart_pace() {
  pace_start_ = Clock::now();
  pace_time_ = rig_.time();
  pace_marks_.clear();
  achieved_ = 0.0;
  slow_since_.reset();
  busy_ = {};
}

PacedRig::Clock::time_point PacedRig::due() {
  if (!running() || !(rate_ > 0.0)) return {};
  const auto due = pace_start_ + std::chrono::duration_cast<Clock::duration>(
                                     Seconds((rig_.time() - pace_time_) / rate_));
  const Clock::time_point now = Clock::now();
  if (now - due > patience) {
    pace_start_ = now;
    pace_time_ = rig_.time();
  }
  return due;
}

void PacedRig::measure_pace() {
  if (!running()) return;
  const Clock::time_point now = Clock::now();
  if (pace_marks_.empty() || now - pace_marks_.back().first > frame_interval)
    pace_marks_.emplace_back(now, rig_.time());
  while (pace_marks_.size() > 2 && now - pace_marks_[1].first > pace_window)
    pace_marks_.pop_front();
  const Seconds wall = now - pace_marks_.front().first;
  if (wall > Seconds(0.1)) achieved_ = (rig_.time() - pace_marks_.front().second) / wall.count();
  if (!(wall > pace_window)) return;
  slowest_factor_ = std::fmin(slowest_factor_, achieved_);
  keep_up();
}

std::shared_ptr<const LiveScene> PacedRig::scene() {
  if (lattices_ == rig_.lattices()) return scene_;
  lattices_ = rig_.lattices();
  LiveScene scene = scene_of(rig_);
  if (rig_.setup().lattice.spacing > first_spacing_) scene.title += ", coarser to keep up";
  scene_ = std::make_shared<const LiveScene>(std::move(scene));
  return scene_;
}

LiveFrame PacedRig::frame() {
  LiveFrame frame;
  frame.number = ++frames_;
  frame.scene = scene();
  frame.epoch = epoch_;
  frame.status = status_;
  frame.failure = failure_;
  frame.real_time_factor = achieved_;
  frame.state = {rig_.settings(), rate_};
  frame.picture = rig_.picture();
  last_frame_ = Clock::now();
  changed_ = false;
  return frame;
}

}  // namespace fingertip::studies::inline live
