#include "lattice/dynamics/integrator.h"

namespace fingertip::lattice::inline dynamics {

bool is_adaptive(Integrator integrator) {
  return integrator == Integrator::runge_kutta || integrator == Integrator::energy_controlled;
}

}  // namespace fingertip::lattice::inline dynamics
