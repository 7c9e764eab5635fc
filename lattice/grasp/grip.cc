#include "lattice/grasp/grip.h"

#include <algorithm>
#include <cmath>

#include "meshes/base/files.h"

namespace fingertip::lattice::inline grasp {

namespace {

constexpr double settled_error = 3e-3;  // of the wanted force ...
constexpr double settled_time = 0.020;  // ... for so long [s]
constexpr double change_time = 0.020;   // within which a speed may change by its limit [s]
constexpr double min_rise = 0.05;       // of the lift's speed in the load phase
constexpr double let_go = 0.05;         // share of the grip force at which releasing ends

double towards(double wanted, double last, double most) {
  return std::clamp(wanted, last - most, last + most);
}

}  // namespace

std::vector<meshes::Violation> GripSettings::violations() const {
  std::vector<meshes::Violation> found;
  const auto require = [&](double value, bool zero, const char* key, const char* unit,
                           const char* rule) {
    if (std::isfinite(value) && (value > 0.0 || (zero && value == 0.0))) return;
    found.push_back({key, meshes::to_text(value) + unit, rule,
                     zero ? "give 0 or a positive value" : "give a positive value"});
  };
  require(force, false, "grasp.force", " N", "the grip force must be finite and positive");
  require(closing_speed, false, "grasp.closing_speed", " m/s",
          "the speed must be finite and positive");
  require(lift_height, false, "grasp.lift_height", " m", "the height must be finite and positive");
  require(lift_speed, false, "grasp.lift_speed", " m/s", "the speed must be finite and positive");
  require(hold_time, true, "grasp.hold_time", " s", "the time must be finite and not negative");
  require(release_time, true, "grasp.release_time", " s",
          "the time must be finite and not negative");
  require(slip_limit, false, "grasp.slip_limit", " m", "the slip must be finite and positive");
  require(period, false, "controller.period", " s", "the period must be finite and positive");
  if (!(std::isfinite(time_constant) && time_constant >= 4.0 * period)) {
    found.push_back({"grasp.time_constant", meshes::to_text(time_constant) + " s",
                     "the force control's time constant must be at least four of its periods",
                     "choose a longer one, or a shorter controller.period"});
  }
  return found;
}

double GripSettings::lift_time() const {
  return 15.0 / 8.0 * lift_height / lift_speed;
}

double GripSettings::lift_acceleration() const {
  return 10.0 / std::sqrt(3.0) * lift_height / (lift_time() * lift_time());
}

void GripControl::enter(GripPhase phase, double time) {
  phase_ = phase;
  entered_ = time;
}

/// Whether the force has been near the wanted one for a while.
bool GripControl::settled(const GripFeeling& feeling) {
  if (std::abs(feeling.force - wanted_) > settled_error * wanted_) {
    settled_since_ = -1.0;
    return false;
  }
  if (settled_since_ < 0.0) settled_since_ = feeling.time;
  return feeling.time - settled_since_ >= settled_time;
}

void GripControl::update_phase(const GripFeeling& feeling) {
  const double since = feeling.time - entered_;
  switch (phase_) {
    case GripPhase::squeeze:
      if (settled(feeling)) enter(GripPhase::load, feeling.time);
      break;
    case GripPhase::load:
      if (!feeling.supported) {
        lift_off_ = feeling.time;
        enter(GripPhase::lift, feeling.time);
      }
      break;
    case GripPhase::lift:
      if (since >= settings_.lift_time()) enter(GripPhase::hold, feeling.time);
      break;
    case GripPhase::hold:
      if (since < settings_.hold_time) break;
      enter(settings_.release_time > 0.0 ? GripPhase::release : GripPhase::done, feeling.time);
      break;
    case GripPhase::release:
      if (wanted_ <= let_go * settings_.force) enter(GripPhase::done, feeling.time);
      break;
    case GripPhase::done: break;
  }
}

void GripControl::update_wanted_force(double time) {
  if (phase_ != GripPhase::release) return;
  const double share = 1.0 - (time - entered_) / settings_.release_time;
  wanted_ = settings_.force * std::max(share, let_go);
}

double GripControl::closing_speed(const GripFeeling& feeling) const {
  const double most = settings_.closing_speed;
  if (!(feeling.indentation > 0.0 && feeling.force > 1e-3 * wanted_)) return most;
  const double stiffness = 1.5 * feeling.force / feeling.indentation;
  return std::clamp((wanted_ - feeling.force) / (stiffness * settings_.time_constant), -most, most);
}

double GripControl::rising_speed(const GripFeeling& feeling) const {
  if (phase_ == GripPhase::load) {
    return settings_.lift_speed * std::clamp(1.0 - feeling.load, min_rise, 1.0);
  }
  if (phase_ != GripPhase::lift) return 0.0;
  // The speed wanted is that at the end of the coming period.
  const double since = feeling.time + settings_.period - entered_;
  const double s = std::clamp(since / settings_.lift_time(), 0.0, 1.0);
  return 30.0 * settings_.lift_height / settings_.lift_time() * s * s * (1.0 - s) * (1.0 - s);
}

GripMotion GripControl::next(const GripFeeling& feeling) {
  update_phase(feeling);
  update_wanted_force(feeling.time);
  const double share = settings_.period / change_time;
  last_.closing = towards(closing_speed(feeling), last_.closing, share * settings_.closing_speed);
  last_.rising = towards(rising_speed(feeling), last_.rising, share * settings_.lift_speed);
  return last_;
}

double GripControl::fraction_done(double time) const {
  const double total = 0.5 + settings_.lift_time() + settings_.hold_time + settings_.release_time;
  return std::clamp(time / total, 0.0, 1.0);
}

}  // namespace fingertip::lattice::inline grasp
