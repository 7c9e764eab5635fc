/// What a cell owns of the twelve edges between its corners.
#pragma once

#include <array>

#include "lattice/model/grid_cells.h"

namespace fingertip::lattice::inline model {

/// Values of the edges, four along x, four along y, four along z, as edge_start() numbers them.
struct CellEdges {
  /// Shares of the rubber: the mean gradient along d is Σ_e mean_e (u_end - u_start)/a. Σ_e = 1.
  std::array<double, 12> mean{};
  /// Times a [m], edge stiffnesses [N/m] per pascal whose energy is not below that of the cell with
  /// a law of unit stiffness for its mean gradient,
  std::array<double, 12> majorant{};
  /// and for what the gradients of its edges differ by.
  std::array<double, 12> spread{};
};

/// (Σ w_e g_e)² <= Σ c_e g_e² where Σ w_e²/c_e <= 1 (Cauchy and Schwarz). Of the c_e that meet it,
/// c_e = w_e^(3/2) Σ_f √w_f hangs little on corners that have little mass.
CellEdges cell_edges(const CornerMoments& moments);

}  // namespace fingertip::lattice::inline model
