#include "lattice/dynamics/integrator.h"

#include "meshes/base/words.h"

namespace fingertip::lattice::inline dynamics {

std::string_view name(Integrator integrator) {
  return meshes::word_of(integrator, {"symplectic-euler", "explicit-euler", "runge-kutta",
                                      "mass-scaled", "energy-controlled"});
}

bool is_adaptive(Integrator integrator) {
  return integrator == Integrator::runge_kutta || integrator == Integrator::energy_controlled;
}

}  // namespace fingertip::lattice::inline dynamics
