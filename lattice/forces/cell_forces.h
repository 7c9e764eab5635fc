/// Forces of the cells on the particles.
#pragma once

#include "lattice/kernels/cell_kernel.h"
#include "lattice/model/cell_lattice.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline forces {

/// How far the cells are from rest, over all of them; rest itself counts among them, and `cubic` is
/// always at rest. With g >= the largest eigenvalue of F⁻¹F⁻ᵀ (Gershgorin):
struct CellExtremes {
  double smallest_jacobian = 1.0;  ///< J of the mean deformation
  /// Largest factor by which the largest eigenvalue of a cell's d²W/dF² can exceed that at rest,
  /// be it over all dF or over those of plane waves, a (x) n. `network`: with X = |G - lambda ln J|
  /// the larger of (G + (X + lambda) g)/(lambda + 2G) (waves) and (G + (X + 3 lambda) g)/(3 lambda
  /// + 2G); other laws of large strain by kernels/cell_hyperelastic.h; `volume`: J² g (1 +
  /// |J - 1|/J).
  double stiffening = 1.0;
  double thickening = 1.0;  ///< the same for the viscosity: `network` g, `volume` J² g
  double fastest = 0.0;     ///< largest |dJ/dt|/J [1/s]; 0 where tau = 0
  /// `network`: largest row sum of |dF/dt F⁻¹|, how fast a cell deforms or turns [1/s]; 0 where tau
  /// = 0.
  double velocity_gradient = 0.0;
};

/// Evaluates the cells of a lattice; allocates nothing in add(). Lattice and team must outlive it.
class CellForces {
 public:
  /// `width`: doubles per register (2, 4, 8), 0 for the widest the processor has.
  CellForces(const CellLattice& cells, Team& team, int width = 0)
      : CellForces(cells, cells.material, team, width) {}
  /// Of cells that consist of something else.
  CellForces(const CellLattice& cells, const CellMaterial& material, Team& team, int width);

  /// force += the cells' forces [N]. `cubic`: at the displacement handed over (u, or u + tau v to
  /// include damping; the velocity is not read). Others: at u, and with damping at v if tau > 0.
  /// The result is the same bits for any number of threads and any register width.
  /// Where a cell is turned inside out (J <= 0) forces are meaningless and smallest_jacobian says
  /// so. `history`: what cells with a law of large strain remember.
  CellExtremes add(const VectorField& displacement, const VectorField& velocity, VectorField& force,
                   const kernel::History& history = {});
  /// The same without a history, and what the cells store at this displacement [J], as
  /// cell_energy() but for round-off: of `network` with damping, found on the way.
  CellExtremes add(const VectorField& displacement, const VectorField& velocity, VectorField& force,
                   double& energy);

 private:
  CellExtremes add(kernel::CellSweep sweep, const VectorField& displacement,
                   const VectorField& velocity, VectorField& force, const kernel::History& history);

  const CellLattice* cells_;
  CellMaterial material_;
  Team* team_;
  kernel::CellSweep sweep_, relaxing_sweep_, storing_sweep_;
  bool sums_energy_;            ///< whether storing_sweep_ serves
  std::vector<double> stored_;  ///< per slab, so that threads do not change its sum [J]
};

}  // namespace fingertip::lattice::inline forces
