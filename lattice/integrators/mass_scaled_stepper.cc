#include "lattice/integrators/mass_scaled_stepper.h"

#include <algorithm>
#include <cmath>

#include "lattice/integrators/euler_stepper.h"

namespace fingertip::lattice {

namespace {

constexpr double largest_change = 0.1;  // of a cell's volume, between two scalings
constexpr double round_off = 1e-9;      // of a step that divides a period
constexpr double smoothing = 10e-3;     // of changes of the contact [s]: particles come in rings
constexpr double calm = 5.0 / 6.0;      // of contact_change: from there on steps are whole again

}  // namespace

bool MassScaledStepper::stale() const {
  const CellExtremes& cells = finger_->extremes();
  if (!(cells.smallest_jacobian > 0.0)) throw CrushedCells("a cell was turned inside out");
  return !finger_->mass_scaling() || steps_->outdated(cells) || changed_ > largest_change;
}

void MassScaledStepper::scale() {
  // One that neither the finger nor a saved state uses.
  std::shared_ptr<MassScaling>& scaling = made_[made_[0].use_count() > 1 ? 1 : 0];
  if (scaling.use_count() != 1) scaling = std::make_shared<MassScaling>(ground_);
  finger_->scale_masses(scaling);
  changed_ = 0.0;
}

/// Sees to it that step and scaling are right for what is left of the span.
void MassScaledStepper::prepare(double left, bool divides) {
  const CellExtremes& cells = finger_->extremes();
  const bool renew = stale();
  if (renew) steps_->note(cells);  // the limit is that of the cells as they are now
  const double whole = steps_->divide(left, cells), present = finger_->step();
  const double longest = steps_->limit(cells), change = longest * std::abs(contact_rate_);
  if (divides && change < calm * contact_change_) halved_ = false;
  if (change > contact_change_) halved_ = true;
  const double step = halved_ ? 0.5 * whole : whole;
  const bool other = divides ? std::abs(step - present) > round_off * step
                             : present > (1.0 + round_off) * (halved_ ? 0.5 : 1.0) * longest;
  if (other) finger_->set_step(step);
  if (other || renew) scale();
}

void MassScaledStepper::watch_contact(int touched_before) {
  const int touching = finger_->touching(), most = std::max(touched_before, touching);
  const double step = finger_->step();
  const double rate = most > 0 ? (touching - touched_before) / (most * step) : 0.0;
  contact_rate_ += (1.0 - std::exp(-step / smoothing)) * (rate - contact_rate_);
}

void MassScaledStepper::recall(const Memory& memory) {
  changed_ = memory[0];
  contact_rate_ = memory[1];
  halved_ = memory[2] != 0.0;
}

void MassScaledStepper::begin(const Drive& /*drive*/, double duration) {
  prepare(duration, true);
}

void MassScaledStepper::step(const Drive& drive, double until) {
  prepare(until - finger_->time(), false);
  const int touched = finger_->touching();
  advance(*finger_, drive);
  changed_ += finger_->step() * finger_->extremes().fastest;
  watch_contact(touched);
  accept(finger_->step(), true);
}

}  // namespace fingertip::lattice
