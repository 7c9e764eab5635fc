/// A lattice as lists of what stores energy: the form in which equilibrium is sought.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "lattice/model/cell_law.h"
#include "lattice/model/embedded_points.h"
#include "lattice/model/tie_layer.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline statics {

/// A point of a cubic grid, counted along its axes.
using GridPlace = std::array<int, 3>;

/// Two particles and the constant k [N/m] between them.
struct Spring {
  std::array<std::uint32_t, 2> ends{};
  double stiffness = 0.0;
};

/// What a cell's law sees of its eight corners: the displacement gradient averaged over the cell's
/// rubber, H = Σ_c u_c gradient_cᵀ. A linear displacement u = H X gives H exactly.
struct MeanCell {
  std::array<std::uint32_t, 8> corners{};
  Eigen::Matrix<double, 3, 8> gradients;  ///< mean of grad N_c over the rubber [1/m]
  double volume = 0.0;                    ///< of the rubber in the cell [m³]
  /// |Σ_c u_c modes_cᵀ|² is what edges' gradients differ by, times the fibres' share [1/m]. Zero
  /// where fibres are springs of their own.
  Eigen::Matrix<double, 4, 8> modes = Eigen::Matrix<double, 4, 8>::Zero();
};

/// Immutable. Everything in the tip's frame (meshes/shape/geometry.h); energies of a displacement
/// u:
///   fibres   ½ k (|d|² - |d0|²), small: ½ k |du|²   d = x_b - x_a; isotropic springs of the rubber
///            network, whose tension at rest is balanced by the cells
///   springs  ½ k (|d| - |d0|)², small: ½ k (d0^·du)²    central springs
///   cells    volume x CellLaw(H, excess); laws beyond `network` have the fibres in them
///   bond     ½ stiffness |x - rest|²                the rod stands still
struct LatticeBody {
  std::vector<meshes::Vector3> rest;  ///< X per particle [m]
  std::vector<double> mass;           ///< per particle [kg]
  /// Per particle, counted from the point next to the origin, through which mirror planes go. Empty
  /// if they lie on no grid.
  std::vector<GridPlace> places;
  std::vector<Spring> fibres, springs;
  std::vector<MeanCell> cells;
  CellLaw law;
  bool finite = false;               ///< kinematics of springs, fibres and law
  std::vector<EmbeddedPoint> bond;   ///< on the rod's surface
  std::vector<EmbeddedPoint> outer;  ///< where the plane may touch
  TieLaw contact;                    ///< of their ties
  /// Per unknown (3 particle + component): 1 where a mirror plane holds it.
  std::vector<std::uint8_t> fixed;
  int sectors = 1;  ///< how often this body makes up the tip: 1, 2 (y >= 0) or 4 (x, y >= 0)

  Eigen::Index unknowns() const { return 3 * Eigen::Index(rest.size()); }
};

}  // namespace fingertip::lattice::inline statics
