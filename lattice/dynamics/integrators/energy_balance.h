/// What energy a step has made or lost.
#pragma once

#include "lattice/dynamics/integrators/stepper.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

/// Energies of a finger at one moment, and the powers that change them.
struct EnergyInstant {
  double kinetic = 0.0;      ///< of the particles, and of a rod that is not prescribed [J]
  double stored = 0.0;       ///< in springs, cells, bond and contact [J]
  double weight = 0.0;       ///< potential of gravity, of what `kinetic` counts [J]
  double dissipation = 0.0;  ///< of the rubber's dampers [W]
  double plane_power = 0.0;  ///< of the moving plane on the tip [W]
  double rod_power = 0.0;    ///< of a prescribed rod on the tip [W]
  meshes::Vector3 endpoint = meshes::Vector3::Zero();  ///< of the rod [m]
  meshes::Vector3 spin = meshes::Vector3::Zero();      ///< of the rod [rad/s]
};

/// Takes energies without changing the finger. Costs two evaluations of the forces (one without
/// damping) and one of the energy. Published surfaces have none (CutSurfaces::attempt).
class EnergyBalance {
 public:
  /// The finger must outlive it.
  explicit EnergyBalance(Finger& finger);

  EnergyInstant measure(bool prescribed);

  /// dE_kin + dE_el + D - W_ext over a step of `duration` [s] [J]; 0 for the exact motion. Energies
  /// and the work of a wrench's force and of gravity are exact, dissipation D and the other works
  /// by the trapezoidal rule.
  static double drift(const EnergyInstant& from, const EnergyInstant& to, double duration,
                      const Drive& drive);

 private:
  double dissipation(const State& state);

  Finger* finger_;
  VectorField force_, undamped_;
  State still_;
};

}  // namespace fingertip::lattice::inline dynamics::inline integrators
