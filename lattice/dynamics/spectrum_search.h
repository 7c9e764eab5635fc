/// The largest eigenvalues about a deformed state, found in small portions while time goes on.
#pragma once

#include <Eigen/Core>
#include <array>

#include "lattice/dynamics/spectrum.h"
#include "lattice/forces/forces.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline dynamics {

/// Largest eigenvalues of M⁻¹K and M⁻¹C with the rod held, one force evaluation at a time, by
/// Rayleigh-Ritz on few vectors: the three uppermost that the last search found (modes change
/// slowly under compression, and one that overtakes the uppermost was among these before), and a
/// Krylov chain that starts from what the uppermost lacks to be an eigenvector and from noise, so
/// that modes which rise elsewhere are seen. The values come from below.
class SpectrumSearch {
  static constexpr int vectors = 10;  ///< of a search, per quantity
  static constexpr int max_kept = 3;  ///< for the next one
  /// In storage of its own size.
  using Coefficients = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, vectors, 1>;
  using Projection = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, vectors, vectors>;

 public:
  /// Model must outlive it. Found values are the same bits for any number of threads.
  explicit SpectrumSearch(const LatticeModel& model, const Team& team = Team(1));

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
    Projection projected;                 ///< basis' image, of the known ones
    std::array<Eigen::MatrixXd, 2> kept;  ///< of the last search, orthonormal
  };

  /// Searches at rest until the vectors to start from are good.
  void finish(Memory& memory);
  /// Begins a search about a state; it is copied. Once converged, neither this nor advance()
  /// allocates.
  void begin(Memory& memory, const State& at);
  /// A portion of an active search, at most one force evaluation; it is no longer active when
  /// `found` is new.
  void advance(Memory& memory);

 private:
  /// Eigenvalues of the projected operator, the uppermost first, and coefficients of their vectors.
  struct Ritz {
    Coefficients values;
    Projection vectors;
  };
  static Ritz ritz(const Projection& projected, Eigen::Index columns);

  void apply(Memory& memory);
  void propose(Memory& memory);
  void start_chain(Memory& memory);
  void continue_chain(Memory& memory);
  void finish_quantity(Memory& memory);
  double move_along(Memory& memory);

  Eigen::Index rows() const { return scale_.size(); }
  template <typename Body>
  void in_portions(Eigen::Index rows, const Body& body);
  Coefficients project(const Eigen::MatrixXd& columns, Eigen::Index count,
                       const Eigen::MatrixXd& of, Eigen::Index column);
  double sum_of_partials() const;
  void normalize(Memory& memory);

  const LatticeModel* model_;
  Team team_;
  InternalForces forces_;
  VectorField force_;
  Eigen::MatrixX3d scale_;                                  ///< mobility()
  Eigen::Matrix<double, vectors, Eigen::Dynamic> partial_;  ///< sums over fixed portions of rows
};

}  // namespace fingertip::lattice::inline dynamics
