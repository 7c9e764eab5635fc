#include "lattice/integrators/mass_scaled_stepper.h"

#include <algorithm>
#include <cmath>

#include "lattice/integrators/euler_stepper.h"

namespace fingertip::lattice {

namespace {

constexpr double largest_change = 0.1;  // of a cell's volume, between two scalings
constexpr double round_off = 1e-9;      // of a step that divides a period

}  // namespace

void MassScaledStepper::scale() {
  const CellExtremes& cells = finger_->extremes();
  if (!(cells.smallest_jacobian > 0.0)) throw CrushedCells("a cell was turned inside out");
  // One that neither the finger nor a saved state uses.
  std::shared_ptr<MassScaling>& scaling = made_[made_[0].use_count() > 1 ? 1 : 0];
  if (scaling.use_count() != 1) scaling = std::make_shared<MassScaling>(ground_);
  finger_->scale_masses(scaling);
  steps_->note(cells);
  changed_ = 0.0;
}

void MassScaledStepper::begin(const Drive& /*drive*/, double duration) {
  const double step = steps_->divide(duration, finger_->extremes());
  const bool other = std::abs(step - finger_->step()) > round_off * step;
  if (other) finger_->set_step(step);
  if (other || !finger_->mass_scaling()) scale();
}

void MassScaledStepper::step(const Drive& drive, double until) {
  const CellExtremes& cells = finger_->extremes();
  bool stale = steps_->outdated(cells) || changed_ > largest_change;
  if (stale) steps_->note(cells);
  if (finger_->step() > (1.0 + round_off) * steps_->limit(cells)) {
    finger_->set_step(steps_->divide(until - finger_->time(), cells));
    stale = true;
  }
  if (stale) scale();
  advance(*finger_, drive);
  changed_ += finger_->step() * finger_->extremes().fastest;
  accept(finger_->step(), true);
}

}  // namespace fingertip::lattice
