/// The stepper of an integrator.
#pragma once

#include <memory>
#include <optional>

#include "lattice/dynamics/integrator.h"
#include "lattice/dynamics/integrators/stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

/// What a stepper has to keep to.
struct StepperSettings {
  Integrator integrator = Integrator::symplectic_euler;
  std::optional<double> time_step;  ///< largest one [s]
  double tolerance = 1e-6;          ///< runge_kutta.h
  double energy_bound = 1e-7;       ///< energy_stepper.h
  double energy_scale = 0.0;        ///< [J]
};

/// Finger and controller must outlive it.
std::unique_ptr<Stepper> make_stepper(const StepperSettings& settings, Finger& finger,
                                      StepController& steps);

}  // namespace fingertip::lattice::inline dynamics::inline integrators
