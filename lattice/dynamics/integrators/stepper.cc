#include "lattice/dynamics/integrators/stepper.h"

#include <sstream>

#include "lattice/dynamics/integrators/energy_stepper.h"
#include "lattice/dynamics/integrators/euler_stepper.h"
#include "lattice/dynamics/integrators/mass_scaled_stepper.h"
#include "lattice/dynamics/integrators/runge_kutta.h"

namespace fingertip::lattice {

void Stepper::accept(double step, bool whole) {
  ++count_.accepted;
  if (whole && !(count_.smallest > 0.0 && count_.smallest <= step)) count_.smallest = step;
}

std::string Stepper::counted() const {
  std::ostringstream text;
  text << count_.accepted << " steps, " << count_.rejected << " rejected";
  if (count_.forced > 0) text << ", " << count_.forced << " of the smallest size beyond the bound";
  return text.str();
}

std::unique_ptr<Stepper> make_stepper(const StepperSettings& settings, Finger& finger,
                                      StepController& steps) {
  switch (settings.integrator) {
    case Integrator::runge_kutta:
      return std::make_unique<RungeKutta>(finger, steps, settings.tolerance, settings.time_step);
    case Integrator::mass_scaled: return std::make_unique<MassScaledStepper>(finger, steps);
    case Integrator::energy_controlled:
      return std::make_unique<EnergyStepper>(finger, steps,
                                             settings.energy_bound * settings.energy_scale);
    default: return std::make_unique<EulerStepper>(finger, steps);
  }
}

}  // namespace fingertip::lattice
