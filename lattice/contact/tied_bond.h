/// The rubber's bond to the rod on their common true surface.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "lattice/contact/tie_inertia.h"
#include "lattice/kernels/bond_kernel.h"
#include "lattice/model/model.h"
#include "lattice/model/rod.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline contact {

/// A particle of the bond that touches the plane as well.
struct SharedLoad {
  std::uint32_t particle = 0;  ///< grid index
  Eigen::Matrix3d stiffness =
      Eigen::Matrix3d::Zero();  ///< of the contact, along the grid's axes [N/m]
  meshes::Vector3 held_back = meshes::Vector3::Zero();  ///< what the contact's inertia takes [N]
};

/// The ties of model.bond, energy Σ ½ k |x - T(X)|² over the points X of the rod's surface, T the
/// rod's pose. Trilinear weights reproduce linear fields, so a tie's stretch is the weighted sum of
/// the slips s_i = x_i - T(X_i) of its corners, and all ties together are one matrix of scalars:
/// energy ½ Σ K_ij s_i·s_j, force -K s.
///
/// The ties are far stiffer than the rubber and must not dictate the time step, so they act as they
/// will be at its end (backward Euler): -K (s + step ds/dt) - step² K a, a the particles'
/// acceleration. The last term is made diagonal: a particle takes the force F of the others and of
/// the first term as F m/(m + step² d_i), d_i = Σ_j |K_ij|, as if it were heavier in its motion
/// against the rod, which there is next to none of. Since K <= diag(d), symplectic Euler is then
/// stable at any step the rubber allows. Forces in equilibrium are untouched, and the rod receives
/// exactly what the particles do not.
class TiedBond {
 public:
  /// Model and team must outlive it. `width`: doubles per register (2, 4, 8), 0 for the widest the
  /// processor has.
  TiedBond(const LatticeModel& model, Team& team, int width = 0);

  /// Adds the bond to `force`, which holds all other forces on the particles; returns its wrench on
  /// the rod about the rod's endpoint. Particles in `shared` are heavier by both inertias; what the
  /// contact's takes is noted there. `stored`: receives energy() if it is asked for, found on the
  /// way.
  Wrench add(const State& state, const RodState& rod, double step, VectorField& force,
             std::vector<SharedLoad>* shared = nullptr, double* stored = nullptr);
  /// What the particles' inertia against the rod is in steps of `step` [s], by increasing index.
  void list_inertia(double step, std::vector<BondInertia>& ties) const;
  double energy(const State& state, const RodState& rod) const;  ///< [J]

 private:
  using Field = std::array<std::vector<double>, 3>;

  void number_particles();
  std::uint32_t number_of(std::uint32_t point) const;  ///< of a particle of the bond
  kernel::BondArrays arrays(const State& state) const;
  kernel::Carried carried(const RodState& rod, double ahead) const;
  Wrench share(SharedLoad& load, const State& state, double square, VectorField& force);

  const LatticeModel* model_;
  Team* team_;
  const kernel::BondKernels* kernels_;
  std::size_t slices_ = 0;             ///< of particles, the last one filled up
  std::vector<std::uint32_t> points_;  ///< grid index per particle of the bond; neighbours near
  std::vector<std::pair<std::uint32_t, std::uint32_t>>
      numbers_;               ///< (grid index, number) of all, increasing
  Field rest_;                ///< X_i along the grid's axes [m]
  std::vector<double> mass_;  ///< [kg]
  std::vector<double> sum_;   ///< d_i [N/m]
  std::vector<std::uint32_t> first_, column_;
  std::vector<kernel::Lanes> value_;     ///< K_ij [N/m]; as in kernel::BondArrays
  std::vector<kernel::Pulled> partial_;  ///< of fixed portions of the slices
  /// Along the grid's axes [m], as in kernel::BondArrays. Scratch of energy(), too: whoever asks
  /// for one must not step meanwhile.
  mutable Field slip_, still_;
};

}  // namespace fingertip::lattice::inline contact
