#include "lattice/dynamics/integrators/energy_stepper.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "lattice/dynamics/integrators/euler_stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

namespace {

constexpr double smallest_share = 1e-3;  // of the stable step
constexpr double safety = 0.9;

/// Factor on the step, for a drift that goes with its square.
double factor(double drift, double bound) {
  if (!(drift > 0.0)) return std::isnan(drift) ? 0.0 : 10.0;
  return safety * std::sqrt(bound / drift);
}

}  // namespace

EnergyStepper::EnergyStepper(Finger& finger, StepController& steps, double bound)
    : finger_(&finger), steps_(&steps), balance_(finger), bound_(bound) {}

void EnergyStepper::begin(const Drive& drive, double /*duration*/) {
  start_ = balance_.measure(std::holds_alternative<Motion>(drive));
}

double EnergyStepper::try_step(const Drive& drive, double step) {
  finger_->set_step(step);
  advance(*finger_, drive);
  end_ = balance_.measure(std::holds_alternative<Motion>(drive));
  return std::abs(EnergyBalance::drift(start_, end_, step, drive));
}

void EnergyStepper::step(const Drive& drive, double until) {
  const double left = until - finger_->time();
  const CellExtremes& cells = finger_->extremes();
  if (steps_->outdated(cells)) steps_->update(finger_->state(), cells);
  const double stable = safe_step(*finger_, *steps_, left);
  const double floor = smallest_share * stable;
  double wanted = now_.next > 0.0 ? std::min(now_.next, stable) : stable;
  const Finger::Snapshot before = finger_->save();
  for (;;) {
    // Evenly through what is left, so that no crumb remains; the last one may be smaller.
    const double tried =
        left <= 2.0 * wanted ? left / std::ceil(left / wanted * (1.0 - 1e-12)) : wanted;
    const double drift = try_step(drive, tried);
    const bool sound = std::isfinite(drift) && finger_->extremes().smallest_jacobian > 0.0;
    if (sound && (drift <= bound_ || tried <= floor)) {
      if (drift > bound_) ++count_.forced;
      accept(tried, tried >= wanted);
      now_.next = std::min(tried * std::clamp(factor(drift, bound_), 0.3, 1.5), stable);
      now_.next = std::max(now_.next, tried < wanted ? std::min(wanted, now_.next * 2.0) : floor);
      start_ = end_;
      return;
    }
    if (!sound && tried <= floor) throw CrushedCells("a cell was turned inside out");
    ++count_.rejected;
    finger_->load(before);
    wanted = std::max(tried * std::clamp(factor(drift, bound_), 0.1, 0.7), floor);
  }
}

std::string EnergyStepper::explanation() const {
  std::ostringstream text;
  text << "steps of at most this length over which the energy balance closes within " << bound_
       << " J; " << counted() << ", smallest " << count_.smallest * 1e6 << " us";
  return text.str();
}

}  // namespace fingertip::lattice::inline dynamics::inline integrators
