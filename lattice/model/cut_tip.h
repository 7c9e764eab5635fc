/// The tip cut out of a cubic grid along its true surfaces: cells, and points of the surfaces
/// embedded to them. What statics and the moving lattice have in common.
#pragma once

#include <vector>

#include "lattice/model/embedded_points.h"
#include "lattice/model/formulation.h"
#include "lattice/model/grid_cells.h"
#include "lattice/model/lattice_settings.h"
#include "lattice/model/sector.h"
#include "lattice/model/tie_layer.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline model {

/// Cells with less rubber than this are left out.
inline constexpr double smallest_fraction = 1e-6;
/// The finest lattice over R: beyond, surface_points has none that near, and the grid would not
/// fit.
inline constexpr double smallest_spacing = 3.1e-3;

/// Immutable. Corners of embedded points are particle numbers of `cells`. Bond and outer points lie
/// at most a/3 apart; the outer ones cover the hemisphere and R - r of the sleeve. Ties:
/// tie_stiffness C44/a per area, the bond's times ligament_stiffness, the outer ones times
/// contact_stiffness. Those of the bond are linear, and all at small strain and in lattices of
/// central springs; the network's outer ones stiffen with the depth as layers of its rubber do.
struct CutTip {
  GridCells cells;
  Sector sector;
  Formulation formulation;
  std::vector<EmbeddedPoint> bond, outer;
  TieLaw contact;  ///< of the outer ones
};

/// `sectors` = 4, 2 or 1 asks for the quarter (x, y >= 0), half (y >= 0) or whole tip; mirror
/// planes must go through grid points, and the grid of a part begins a layer before them. The
/// directions of `cells.grid()` are those of the settings, renamed in turn so that x is nearest the
/// finger's axis. `spare_rows` adds that
/// many empty points at the end of every row of the grid. Throws InvalidInput for a specimen that
/// breaks a rule, the published model, a spacing above (R - r)/2 or below R/320, a rotation or
/// offset out of range, constants that are negative or without a diagonal, nu < 0 in the network at
/// finite strain, sectors the grid's symmetry does not have, and a lattice in several pieces.
CutTip cut_tip(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
               const LatticeSettings& settings, int sectors, int spare_rows = 0);

/// The grid of a tip or of one of `sectors` parts of it, which CutTip describes, for any model.
/// Throws InvalidInput for a spacing, offset or rotation out of range.
meshes::CubicGrid tip_grid(const meshes::Geometry& geometry, const LatticeSettings& settings,
                           int sectors);

/// 4, 2 or 1: into how many mirror images the grid's planes through x = 0 and y = 0 divide the tip;
/// 1 for a solid.
int grid_symmetry(const meshes::Geometry& geometry, const LatticeSettings& settings);

/// Empty if the tip divides into so many parts along planes of grid points.
std::vector<meshes::Violation> sector_violations(const meshes::Geometry& geometry,
                                                 const LatticeSettings& settings, int sectors);

/// Deepest height at which the outer surface can meet the plane [m]: a sleeve as long as the rubber
/// is thick, since no press goes deeper than that.
double lowest_contact(const meshes::Geometry& geometry);

}  // namespace fingertip::lattice::inline model
