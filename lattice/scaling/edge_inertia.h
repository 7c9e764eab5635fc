/// A graph Laplacian above the elastic and viscous stiffness of cells.
#pragma once

#include <array>
#include <vector>

#include "lattice/model.h"
#include "lattice/parallel.h"
#include "lattice/state.h"

namespace fingertip::lattice {

/// Per point, of the edges to the next point along x, y, z [kg].
using EdgeInertia = std::array<std::vector<double>, 3>;

/// S = Σ_cells (dt² E/4 + dt tau V/2) a Σ_edges c_e (u_i - u_j)²,
///
/// E and V bounds on the present eigenvalues of a cell's elastic and viscous d²W/dF² [Pa], so that
/// dt² K + 2 dt C <= 4 S: the mean gradient of a cell is one of its edges' gradients, weighted with
/// the shares w_e of the rubber that they own, and (Σ w_e g_e)² <= Σ c_e g_e² if Σ w_e²/c_e <= 1
/// (cells/cell_edges.h).
class EdgeInertiaRule {
 public:
  /// The model's cells have law `cubic` or `network` and it knows their edges (model.edges); throws
  /// std::invalid_argument otherwise.
  explicit EdgeInertiaRule(const LatticeModel& model);

  /// For steps of `step` [s] > 0 about a state, multiplied with `room`: what cells may stiffen by
  /// later. `edges` of the model's points. Returns a measure of S [kg].
  double find(const State& state, double step, double room, Team& team, EdgeInertia& edges);

 private:
  /// Eight cells.
  struct Pack {
    std::array<std::uint32_t, lanes> corner{};  ///< lowest
    double mean[12][lanes] = {};                ///< CellEdges::mean
    double majorant[12][lanes] = {};            ///< CellEdges::majorant
    double stiffness[lanes] = {};               ///< of S, for a cell as it is now [kg/m] * a
  };

  const LatticeModel* model_;
  std::array<std::ptrdiff_t, 3> next_;
  std::vector<Pack> packs_;
};

}  // namespace fingertip::lattice
