/// The lattice of the tip as it is built once and then only read: where particles and cells are,
/// what they weigh, how stiff and how viscous their connections are.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lattice/kernels/stencil.h"
#include "lattice/kernels/tie_law.h"
#include "lattice/model/cell_edges.h"
#include "lattice/model/cell_lattice.h"
#include "lattice/model/constants.h"
#include "lattice/model/embedded_points.h"
#include "lattice/model/formulation.h"
#include "lattice/model/grid_cells.h"
#include "lattice/model/lattice_settings.h"
#include "lattice/model/sector.h"
#include "meshes/cells/cubic_grid.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline model {

/// What hangs a published particle on the rod: an isotropic spring with zero force at rest between
/// the particle and the point of the rigid rod (extended beyond its surface) that coincides with it
/// at rest. Energy ½ k |x_p - T(X_p)|², T the rod's pose (README of contact/).
struct Ligament {
  std::size_t particle = 0;                        ///< grid index
  meshes::Vector3 rest = meshes::Vector3::Zero();  ///< X_p [m]
  double stiffness = 0.0;                          ///< k [N/m]
  double damping = 0.0;                            ///< mu [N s/m]
};

/// Immutable after construction. All arrays named "per point" run over the grid's points, x
/// fastest, plus `lanes` padding zeros at the end; the grid keeps one layer of empty points around
/// the particles, so that every neighbour index of a particle exists.
///
/// The published model consists of springs, ligaments and boundary particles; the others of springs
/// (central, hookean at finite strain), cells with a law (all but central), and points of the true
/// surfaces embedded between the corners of their cells.
struct LatticeModel {
  ModelKind kind = ModelKind::hookean;
  Kinematics kinematics = Kinematics::small;
  SpringConstants constants;
  meshes::CubicGrid grid;
  /// Which part of the tip this is. Masses, springs and ties on its mirror planes are its share.
  Sector sector;
  /// Per axis of the grid: the particles on the mirror plane across it, which do not move along it.
  std::array<std::vector<std::uint32_t>, 3> held;

  std::vector<std::uint8_t> is_particle;  ///< per point: 1 where a particle sits
  std::vector<double> mass;               ///< per point [kg], 0 where there is no particle
  std::vector<double> inverse_mass;       ///< per point [1/kg], 0 where there is no particle
  /// Per direction of the half stencil and point: how much of the spring from the point to its
  /// neighbour exists (1 = a full spring k of its class, 0 = none).
  std::array<std::vector<double>, directions> weight;

  std::array<double, 3> stiffness{};  ///< k per class [N/m]
  std::array<double, 3> damping{};    ///< mu per class [N s/m]
  /// tau = mu/k [s] where it is the same for springs and cells (Kelvin-Voigt); else 0, and the
  /// dampers are per class.
  double retardation_time = 0.0;
  bool proportional_damping = false;  ///< whether mu = tau k throughout
  meshes::Relaxation relaxation;      ///< of springs and cells; what they are otherwise is after
                                      ///< long times

  std::vector<std::uint32_t> particles;  ///< grid indices of the particles, increasing
  std::vector<std::uint32_t> cells;      ///< grid indices of the cells' lowest corners
  std::vector<std::uint32_t> blocks;     ///< first points of the runs of `lanes` points that
                                         ///< cover every particle once
  std::vector<CellEdges> edges;          ///< per cell; if cut cells alone store energy
  CellLattice cell_lattice;              ///< the cells that carry a law; may be empty
  std::size_t fibres = 0;                ///< edges that carry a share of the cells' energy
  /// Particles of the outer skin: fewer than 26 neighbours and nearer to the outer surface than
  /// to the rod. Published: candidates for contact.
  std::vector<std::uint32_t> boundary;
  std::vector<Ligament> ligaments;  ///< published
  /// On the rod's surface and where the plane may touch; corners are grid indices. Not published.
  std::vector<EmbeddedPoint> bond, outer;
  TieLaw contact;           ///< of the outer points' ties
  double added_mass = 0.0;  ///< what light particles at cut cells were given [kg] (build_cut_model)

  std::size_t points() const { return is_particle.size(); }  ///< including the padding
  double spacing() const { return grid.spacing; }            ///< a [m]
  double rest_length(Family family) const;                   ///< l0 [m]
  meshes::Vector3 rest_position(std::size_t point) const;    ///< X [m]
  std::array<int, 3> place(std::size_t point) const;         ///< its indices on the grid
  double total_mass() const;                                 ///< of the whole tip [kg]
  std::size_t spring_count() const;                          ///< springs and fibres
  bool has_springs() const { return stiffness[0] + stiffness[1] + stiffness[2] > 0.0; }
  bool is_cut() const { return !outer.empty(); }  ///< whether it has true surfaces
};

/// The published tip: the paper's particles, a full spring between every two neighbours, ligaments.
/// Throws InvalidInput for another model, a spacing or offset outside their ranges or constants
/// that are not finite. `sectors` as of cut_tip (cut_tip.h).
LatticeModel build_published_tip(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                                 const LatticeSettings& settings, int sectors = 1);

/// Empty points at the end of every row of a model's grid, so that a block that starts at a row's
/// last particle does not reach the particles of the next row.
inline constexpr int row_margin = int(lanes) - 1;

/// The model that `formulation` makes of these cells, without bond, outer points and boundary;
/// masses are moments of the shape functions. The grid needs a layer of empty points on every side
/// and row_margin more at the end of its rows. Throws InvalidInput for constants that are not
/// finite.
LatticeModel build_model(const GridCells& cells, ModelKind kind, const Formulation& formulation,
                         double density, const Sector& sector = {});

/// Fills in `boundary`.
void find_boundary(LatticeModel& model, const meshes::Geometry& geometry);

/// A free block of cells[0] x cells[1] x cells[2] whole cells of springs with its lowest corner at
/// the origin, without bond and boundary: central, or hookean with kappa in its cells
/// (spring_formulation), with Kelvin-Voigt dampers of `retardation_time`, or published with the
/// paper's dampers.
LatticeModel build_block(ModelKind kind, Kinematics kinematics, const SpringConstants& constants,
                         double spacing, const std::array<int, 3>& cells, double density,
                         double retardation_time);

}  // namespace fingertip::lattice::inline model
