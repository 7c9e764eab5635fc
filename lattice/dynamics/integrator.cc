#include "lattice/dynamics/integrator.h"

namespace fingertip::lattice::inline dynamics {

std::string_view name(Integrator integrator) {
  switch (integrator) {
    case Integrator::symplectic_euler: return "symplectic-euler";
    case Integrator::explicit_euler: return "explicit-euler";
    case Integrator::runge_kutta: return "runge-kutta";
    case Integrator::mass_scaled: return "mass-scaled";
    case Integrator::energy_controlled: return "energy-controlled";
  }
  return {};
}

bool is_adaptive(Integrator integrator) {
  return integrator == Integrator::runge_kutta || integrator == Integrator::energy_controlled;
}

}  // namespace fingertip::lattice::inline dynamics
