/// Graph Laplacians above the elastic and viscous stiffness of cells.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/dynamics/scaling/edge_sweeps.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "lattice/threads/parallel.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

using sweeps::Single;

/// Per component of a displacement and axis, of the edges from each point to the next [kg].
using EdgeInertia = std::array<std::array<std::vector<Single>, 3>, 3>;

/// S = Σ_cells a Σ_components Σ_edges (M_cd c_e + N b_e) (u_c,i - u_c,j)², d the axis of edge e,
///
///   M = dt² E/4 + dt tau V/2,  N = (dt²/4 + dt tau/2) mu_h [Pa s²],
///
/// so that dt² K + 2 dt C <= 4 S. E_cd and V_cd bound the row sums of |d²W/dF²| and of its viscous
/// counterpart over all entries of F; as diagonal forms, Σ E_cd dF_cd², they are not below them
/// (Gershgorin). At rest they are 3 lambda + 2 G where c = d and 2 G elsewhere: only stretches
/// along the axes meet the bulk, so that what shears is not made as heavy as what swells. The mean
/// gradient of a cell is one of its edges' gradients, weighted with the shares w_e of the rubber
/// that they own, and (Σ w_e g_e)² <= Σ c_e g_e² if Σ w_e²/c_e <= 1; b_e are for what the edges
/// differ by (model/cell_edges.h), but for the small part of their damping that hangs on how much
/// they differ already.
///
/// Law `network`, T = F⁻ᵀ, r_c and k_d the sums of |T| along row c and column d, s that of all:
///   d²W/dF²  G dF:dF + (G - lambda ln J) tr (F⁻¹ dF)² + lambda (T:dF)²,
///            E_cd = G + p r_c k_d + lambda s |T_cd|,  p = G + lambda (max(J, 1/J) - 1),
///   viscous  with L = dF F⁻¹ G (L:L + L:Lᵀ) + lambda (tr L)²,
///            V_cd = G (Σ_e |TᵀT|_de + r_c k_d) + lambda s |T_cd|.
class EdgeInertiaRule {
 public:
  /// The model's cells have law `cubic` or `network` and it knows their edges (model.edges); throws
  /// std::invalid_argument otherwise.
  explicit EdgeInertiaRule(const LatticeModel& model);

  /// For steps of `step` [s] > 0 about a state, multiplied with `allowance`: what cells may stiffen
  /// by later; never less than at rest. `edges` of at least the model's points. Returns the sum
  /// of those that stretch, a measure of S [kg].
  double find(const State& state, double step, double allowance, Team& team, EdgeInertia& edges);

 private:
  sweeps::EdgeFactors factors(double elastic, double viscous) const;

  const LatticeModel* model_;
  std::vector<sweeps::EdgeShares> shares_;  ///< the first is that of whole cells
  std::vector<sweeps::EdgePack> packs_;
};

}  // namespace fingertip::lattice::inline dynamics::inline scaling
