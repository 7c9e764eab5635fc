#include "lattice/dynamics/integrators/mass_scaled_stepper.h"

#include <cmath>

#include "lattice/dynamics/integrators/euler_stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

namespace {

constexpr double largest_change = 0.1;      // of a cell's volume, between two scalings
constexpr double largest_strain = 0.2;      // or turn [rad]
constexpr double assumed_swiftness = 20.0;  // of cells that do not tell: a fifth in 10 ms [1/s]
constexpr double round_off = 1e-9;          // of a step that divides a period

}  // namespace

bool MassScaledStepper::stale() const {
  const CellExtremes& cells = finger_->extremes();
  if (!(cells.smallest_jacobian > 0.0)) throw CrushedCells("a cell was turned inside out");
  return !finger_->mass_scaling() || steps_->outdated(cells) || now_.changed > largest_change ||
         now_.strained > largest_strain;
}

/// How fast cells strain or turn, at most, as far as S depends on it [1/s].
double MassScaledStepper::swiftness() const {
  const CellMaterial& material = finger_->model().cell_lattice.material;
  if (material.kind == CellLawKind::cubic) return 0.0;
  return material.retardation_time > 0.0 ? finger_->extremes().velocity_gradient
                                         : assumed_swiftness;
}

void MassScaledStepper::scale() {
  // One that neither the finger nor a saved state uses.
  std::shared_ptr<MassScaling>& scaling = made_[made_[0].use_count() > 1 ? 1 : 0];
  if (scaling.use_count() != 1) scaling = std::make_shared<MassScaling>(ground_);
  finger_->scale_masses(scaling);
  now_.changed = now_.strained = 0.0;
}

/// Sees to it that step and scaling are right for what is left of the span.
void MassScaledStepper::prepare(double left, bool divides) {
  const CellExtremes& cells = finger_->extremes();
  const bool renew = stale();
  if (renew) steps_->note(cells);  // the limit is that of the cells as they are now
  const double step = steps_->divide(left, cells), present = finger_->step();
  const bool other = divides ? std::abs(step - present) > round_off * step
                             : present > (1.0 + round_off) * steps_->limit(cells);
  if (other) finger_->set_step(step);
  if (other || renew) scale();
}

void MassScaledStepper::begin(const Drive& /*drive*/, double duration) {
  prepare(duration, true);
}

void MassScaledStepper::step(const Drive& drive, double until) {
  prepare(until - finger_->time(), false);
  advance(*finger_, drive);
  now_.changed += finger_->step() * finger_->extremes().fastest;
  now_.strained += finger_->step() * swiftness();
  accept(finger_->step(), true);
}

}  // namespace fingertip::lattice::inline dynamics::inline integrators
