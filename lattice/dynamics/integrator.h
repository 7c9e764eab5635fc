/// How the moving lattice is integrated in time.
#pragma once

#include "meshes/base/names.h"

namespace fingertip::lattice::inline dynamics {

/// Time integration of x' = v, v' = f/m.
enum class Integrator {
  symplectic_euler,   ///< v first, then x with the new v; the default
  explicit_euler,     ///< as printed in the paper's Fig. 4: x with the old v, then v
  runge_kutta,        ///< explicit, of order 5, its step chosen by the estimated error
  mass_scaled,        ///< symplectic Euler with inertia against deformation, at long steps
  energy_controlled,  ///< symplectic Euler, its step chosen by the energy it gains or loses
};
using meshes::name, meshes::values;
constexpr auto names_of(Integrator) {
  using enum Integrator;
  return meshes::names<Integrator>({{symplectic_euler, "symplectic-euler"},
                                    {explicit_euler, "explicit-euler"},
                                    {runge_kutta, "runge-kutta"},
                                    {mass_scaled, "mass-scaled"},
                                    {energy_controlled, "energy-controlled"}});
}
/// Whether it chooses every step by what the last ones did, not by stability alone.
bool is_adaptive(Integrator integrator);

}  // namespace fingertip::lattice::inline dynamics
