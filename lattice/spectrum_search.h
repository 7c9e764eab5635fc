/// The largest eigenvalues about a deformed state, found in small portions while time goes on.
#pragma once

#include <Eigen/Core>
#include <array>

#include "lattice/forces.h"
#include "lattice/model.h"
#include "lattice/parallel.h"
#include "lattice/spectrum.h"
#include "lattice/state.h"

namespace fingertip::lattice {

/// Largest eigenvalues of M⁻¹K and M⁻¹C with the rod held, one force evaluation at a time, by
/// Rayleigh-Ritz on few vectors: the three uppermost that the last search found (modes change
/// slowly under compression, and one that overtakes the uppermost was among these before), and a
/// Krylov chain that starts from what the uppermost lacks to be an eigenvector and from noise, so
/// that modes which rise elsewhere are seen. The values come from below.
class SpectrumSearch {
 public:
  /// Model must outlive it.
  explicit SpectrumSearch(const LatticeModel& model);

  /// All that a search knows.
  struct Memory {
    bool active = false;
    SpectralBounds found;  ///< by the last search that ended; no retardation times

   private:
    friend class SpectrumSearch;
    State at, moved;                      ///< where it began; tried last
    VectorField force;                    ///< there [N]
    bool based = false;                   ///< whether `force` is known
    std::size_t quantity = 0;             ///< 0: stiffness, 1: damping
    Eigen::Index count = 0;               ///< vectors whose images are known
    unsigned searches = 0;                ///< begun so far
    Eigen::MatrixXd basis, image;         ///< q and M^(-1/2) A M^(-1/2) q, by columns
    Eigen::MatrixXd projected;            ///< basis' image, of the known ones
    std::array<Eigen::MatrixXd, 2> kept;  ///< of the last search, orthonormal
  };

  /// Searches at rest until the vectors to start from are good.
  void settle(Memory& memory);
  /// Begins a search about a state; it is copied.
  void begin(Memory& memory, const State& at);
  /// A portion of an active search, at most one force evaluation; it is no longer active when
  /// `found` is new.
  void advance(Memory& memory);

 private:
  void apply(Memory& memory);
  void propose(Memory& memory);
  void finish_quantity(Memory& memory);

  const LatticeModel* model_;
  Team team_;
  InternalForces forces_;
  VectorField force_;
  Eigen::VectorXd scale_;  ///< m^(-1/2) per particle [kg^(-1/2)]
};

}  // namespace fingertip::lattice
