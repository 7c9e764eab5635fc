/// Joukhadar's energy-controlled step.
#pragma once

#include "lattice/dynamics/integrators/energy_balance.h"
#include "lattice/dynamics/integrators/stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

/// Symplectic Euler with the largest steps, up to the stable one, over which the energy balance
/// |dE_kin + dE_el + D - W_ext| (energy_balance.h) closes within a bound (A. Joukhadar, Adaptive
/// time step for fast converging dynamic simulation system, IROS 1996, who asks it of the system's
/// total energy). A step that breaks the bound is taken back and tried anew; the drift of
/// symplectic Euler over a step goes with its square, which tells the next length.
///
/// Steps below a thousandth of the stable one are not tried: what they lose (a stuck point that is
/// released gives up the energy of its tie at once) is counted as forced.
class EnergyStepper : public Stepper {
 public:
  /// `bound` [J] > 0; finger and controller must outlive it.
  EnergyStepper(Finger& finger, StepController& steps, double bound);

  void begin(const Drive& drive, double duration) override;
  void step(const Drive& drive, double until) override;
  std::string explanation() const override;

 private:
  double try_step(const Drive& drive, double step);

  Finger* finger_;
  StepController* steps_;
  EnergyBalance balance_;
  double bound_;
  EnergyInstant start_, end_;
};

}  // namespace fingertip::lattice::inline dynamics::inline integrators
