/// Euler steps as large as stability allows.
#pragma once

#include "lattice/dynamics/integrators/stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

/// Steps that divide the span evenly and keep to the StepController's limit, chosen at the span's
/// start and whenever the cells have grown too stiff for the present step.
class EulerStepper : public Stepper {
 public:
  EulerStepper(Finger& finger, StepController& steps) : finger_(&finger), steps_(&steps) {}

  void begin(const Drive& drive, double duration) override;
  void step(const Drive& drive, double until) override;

 private:
  Finger* finger_;
  StepController* steps_;
  bool chosen_ = false;  ///< whether the step was chosen for the present state
};

/// One Euler step of the finger under a drive.
void advance(Finger& finger, const Drive& drive);

/// Whether the present step no longer suits the cells.
bool outgrown(const Finger& finger, const StepController& steps);

/// The largest safe step [s]. Throws CrushedCells; `span` [s] is what a lattice at rest would
/// divide.
double safe_step(const Finger& finger, const StepController& steps, double span);

}  // namespace fingertip::lattice::inline dynamics::inline integrators
