#include "lattice/dynamics/integrators/euler_stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

void advance(Finger& finger, const Drive& drive) {
  if (const Wrench* wrench = std::get_if<Wrench>(&drive)) {
    finger.advance(*wrench);
  } else {
    finger.advance(std::get<Motion>(drive)(finger.time() + finger.step()));
  }
}

bool outgrown(const Finger& finger, const StepController& steps) {
  const CellExtremes& cells = finger.extremes();
  return finger.step() > steps.limit(cells) || !(cells.smallest_jacobian > 0.0);
}

double safe_step(const Finger& finger, const StepController& steps, double span) {
  const CellExtremes& cells = finger.extremes();
  if (!(cells.smallest_jacobian > 0.0)) {
    throw CrushedCells("a cell was turned inside out");
  }
  const double step = steps.divide(span, cells);
  if (!(step > 1e-4 * steps.at_rest(span))) {
    throw CrushedCells("cells are pressed flat");
  }
  return step;
}

void EulerStepper::begin(const Drive& /*drive*/, double duration) {
  finger_->set_step(safe_step(*finger_, *steps_, duration));
  chosen_ = true;
}

void EulerStepper::step(const Drive& drive, double until) {
  steps_->follow(finger_->state(), finger_->extremes());
  if (!chosen_ && outgrown(*finger_, *steps_)) {
    finger_->set_step(safe_step(*finger_, *steps_, until - finger_->time()));
  }
  chosen_ = false;
  advance(*finger_, drive);
  accept(finger_->step(), true);
}

}  // namespace fingertip::lattice::inline dynamics::inline integrators
