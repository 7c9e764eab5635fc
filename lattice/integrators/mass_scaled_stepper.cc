#include "lattice/integrators/mass_scaled_stepper.h"

#include <algorithm>
#include <cmath>

#include "lattice/integrators/euler_stepper.h"

namespace fingertip::lattice {

namespace {

constexpr double largest_change = 0.1;  // of a cell's volume, between two scalings

}  // namespace

void MassScaledStepper::scale() {
  const CellExtremes& cells = finger_->extremes();
  if (!(cells.smallest_jacobian > 0.0)) throw CrushedCells("a cell was turned inside out");
  const auto scaling =
      std::make_shared<MassScaling>(finger_->model(), finger_->state(), finger_->step());
  products_ = std::max(products_, scaling->products());
  finger_->scale_masses(scaling);
  steps_->note(cells);
  changed_ = 0.0;
}

void MassScaledStepper::begin(const Drive& /*drive*/, double duration) {
  const double step = steps_->divide(duration, finger_->extremes());
  const bool other = std::abs(step - finger_->step()) > 1e-9 * step;
  if (other) finger_->set_step(step);
  if (other || !finger_->mass_scaling()) scale();
}

void MassScaledStepper::step(const Drive& drive, double until) {
  const CellExtremes& cells = finger_->extremes();
  bool stale = steps_->outdated(cells) || changed_ > largest_change;
  if (stale) steps_->note(cells);
  if (finger_->step() > steps_->limit(cells)) {
    finger_->set_step(steps_->divide(until - finger_->time(), cells));
    stale = true;
  }
  if (stale) scale();
  advance(*finger_, drive);
  changed_ += finger_->step() * finger_->extremes().fastest;
  accept(finger_->step(), true);
}

std::string MassScaledStepper::explanation() const {
  return "at most " + std::to_string(products_) + " products per step scale the masses";
}

}  // namespace fingertip::lattice
