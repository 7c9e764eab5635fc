#include "lattice/dynamics/integrators/make_stepper.h"

#include "lattice/dynamics/integrators/energy_stepper.h"
#include "lattice/dynamics/integrators/euler_stepper.h"
#include "lattice/dynamics/integrators/mass_scaled_stepper.h"
#include "lattice/dynamics/integrators/runge_kutta.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

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

}  // namespace fingertip::lattice::inline dynamics::inline integrators
