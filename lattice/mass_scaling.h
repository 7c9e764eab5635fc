/// Selective mass scaling: inertia against deformation, so that neither the stiffness nor the
/// damping of the rubber limits the time step.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/model.h"
#include "lattice/parallel.h"
#include "lattice/state.h"

namespace fingertip::lattice {

/// What ties add to a particle's inertia (tied_bond.h) [kg].
struct TieInertia {
  std::uint32_t particle = 0;                         ///< grid index
  double bond = 0.0;                                  ///< against the rod
  Eigen::Matrix3d contact = Eigen::Matrix3d::Zero();  ///< against the plane, along the grid's axes
};

/// Scratch for MassScaling::accelerate, of a model's points.
struct AccelerationFields {
  VectorField plain;                    ///< a = D⁻¹ f [m/s²]
  std::array<VectorField, 2> iterates;  ///< of the recursion
  std::vector<double> inverse;          ///< 1/D [1/kg]
  struct Contact {
    std::uint32_t particle = 0;
    Eigen::Matrix3d excess;  ///< what `inverse` is too large by [1/kg]
  };
  std::vector<Contact> contact;          ///< particles with inertia against the plane
  std::vector<meshes::Vector3> changes;  ///< per TieInertia: by how much more it accelerates [m/s²]

  explicit AccelerationFields(const LatticeModel& model);
};

/// Weights for one step length about one state. Immutable.
///
/// A symplectic Euler step takes v += dt M⁻¹ (f_el - C v) and is stable if dt² K + 2 dt C <= 4 M.
/// Here M⁻¹ becomes W = p(D⁻¹ S) D⁻¹, D the particles' mass with the inertia of their ties and S =
/// dt² times a graph Laplacian along the edges of the cells,
///
///   S = Σ_cells (dt² E/4 + dt tau V/2) a Σ_edges c_e (u_i - u_j)²,
///
/// E and V bounds on the present eigenvalues of a cell's elastic and viscous d²W/dF² [Pa], so that
/// dt² K + 2 dt C <= 4 S: the mean gradient of a cell is one of its edges' gradients, weighted with
/// the shares w_e of the rubber that they own, and (Σ w_e g_e)² <= Σ c_e g_e² if Σ w_e²/c_e <= 1.
/// c_e = w_e^(3/2) Σ √w_f does that with little weight on what light particles hang on. Then W (dt²
/// K + 2 dt C) <= 4 x p(x) with x in [0, X] the eigenvalues of D⁻¹ S, and the step is stable at any
/// length if 0
/// <= x p(x) <= 1. 1 - x p(x) = (1 + T_s(w0 - w1 x))/(1 + T_s(w0)), T_s Chebyshev's polynomial,
/// does with p(0) = 1 as long as X <= (1 + w0)/w1, about s², and costs s - 1 products with S. W
/// moves a rubber that does not deform as its mass does: its momentum is that of the forces to
/// round-off. Motions at frequency w are heavier by about a third of S, a part w² (dt² + 2 dt
/// tau)/12 times E over their own modulus. So it is for presses, not for vibrations.
///
/// Selective mass scaling: Olovsson, Simonsson & Unosson, Int. J. Numer. Meth. Engng 63 (2005)
/// 1436-1445; stabilising by Chebyshev polynomials: van der Houwen & Sommeijer, ZAMM 60 (1980)
/// 479-485.
class MassScaling {
 public:
  /// For steps of `step` [s] > 0 from `state` on, while cells stiffen by less than `room`. The
  /// model consists of cells with law `cubic` or `network` and knows their edges (model.edges);
  /// throws std::invalid_argument otherwise.
  MassScaling(const LatticeModel& model, const State& state, double step, double room = 1.3);

  /// Replaces the forces [N], which are D_m a with the tie's inertia taken off (Surfaces::hold), by
  /// those under which the particles accelerate by W f. `ties`: who has what inertia.
  void accelerate(std::span<const TieInertia> ties, Team& team, AccelerationFields& scratch,
                  VectorField& force) const;

  int products() const { return stages_ - 1; }  ///< with S, per step

 private:
  void add_cell(std::size_t cell, const State& state, double room);
  void choose_polynomial();
  void note(std::span<const TieInertia> ties, AccelerationFields& fields) const;
  void advance(const AccelerationFields& fields, const VectorField& from, double share, Team& team,
               VectorField& to) const;
  meshes::Vector3 product(const VectorField& field, std::size_t point) const;

  const LatticeModel* model_;
  double step_;
  std::array<std::vector<double>, 3> edge_;  ///< of S, from a point to the next along x, y, z [kg]
  double largest_ = 0.0;                     ///< X, an upper bound by Gershgorin's rows
  int stages_ = 1;
  double w0_ = 1.0, w1_ = 1.0;
};

}  // namespace fingertip::lattice
