/// The tip as a lattice with its true surfaces: cells are cut, bond and contact lie on sphere and
/// cylinder.
#pragma once

#include <array>

#include "lattice/model.h"
#include "lattice/settings.h"
#include "lattice/statics/lattice_body.h"
#include "meshes/geometry.h"
#include "meshes/press_protocol.h"
#include "meshes/rubber.h"

namespace fingertip::lattice {

/// Share s of the shear energy that is carried by the fibres along the cells' edges; the rest sees
/// the cell's mean gradient. With s = 1/3 the bilinear modes of a cell cost what they cost in the
/// continuum (edges see y² = 1/4 where the mean over the cell is 1/12).
inline constexpr double fibre_share = 1.0 / 3.0;
/// Stiffness of the ties to rod and plane per area over C44/a. Softer ties are felt, stiffer ones
/// lock the lattice (README: measured).
inline constexpr double tie_stiffness = 160.0;
/// Tie of a published particle to the plane over E a.
inline constexpr double particle_tie = 20.0;
/// Cells with less rubber than this are left out.
inline constexpr double smallest_fraction = 1e-6;

/// central, hookean or network on cells cut by the tip's true surfaces. `sectors` = 4, 2 or 1 asks
/// for the quarter (x, y >= 0), half (y >= 0) or whole tip; mirror planes must go through grid
/// points and hold the displacement across them. A cell gives its springs, law and mass what of
/// them lies in its rubber:
///
///   hookean, small    isotropic fibres s C44 a along the edges, CellLaw::cubic
///   network, finite   isotropic fibres s G a, CellLaw::network: law A of the continuum, no stress
///                     at rest in cut cells either
///   network, small    hookean with the rubber's closed form for its constants
///   hookean, finite   central springs k1, k2, k3 and CellLaw::volume
///   central           central springs k1, k2, k3; the cells carry no law
///
/// settings.constants are those of hookean (kappa included) and central, the network takes G and
/// lambda of the rubber. Bond and outer points lie at most a/3 apart; the outer ones cover the
/// hemisphere and R - r of the sleeve. Ties: tie_stiffness C44/a per area, the bond's times
/// ligament_stiffness, the outer ones times contact_stiffness. Where fibres and a cell law make up
/// the material (the first three), a linear displacement costs the rubber's energy in every cell,
/// and its nodal forces are those of its traction on the true surfaces (patch test). Throws
/// InvalidInput for a specimen that breaks a rule, the published model, a spacing above (R - r)/2
/// or below R/320, a rotation or offset out of range, constants that are negative or without a
/// diagonal, nu < 0 in the network at finite strain, sectors the grid's symmetry does not have, and
/// a lattice in several pieces.
LatticeBody build_cut_tip(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                          const LatticeSettings& settings, int sectors);

/// The published lattice, the whole tip, as lists: every spring as in the model, particles tied to
/// the rod by their ligaments, boundary particles down to R - r below the equator that touch by
/// themselves (area a² each, tie particle_tie E a). Throws InvalidInput for the other models,
/// which do not press with their staircase: see build_cut_tip.
LatticeBody body_of(const LatticeModel& model, const meshes::Geometry& geometry,
                    const meshes::Rubber& rubber);

/// A free block of cells[0] x cells[1] x cells[2] whole cells, made like those of build_cut_tip,
/// with its lowest corner at the origin and its edges along settings.axes; without bond and outer
/// points. Throws InvalidInput for constants as build_cut_tip does, a spacing that is not positive
/// and a count below 1.
LatticeBody build_free_block(const meshes::Rubber& rubber, const LatticeSettings& settings,
                             const std::array<int, 3>& cells);

/// 4, 2 or 1: how many equal parts the press and the grid allow. Offsets along x and y must vanish
/// and the grid must not be rotated; tilt and lateral motion leave y -> -y alone; the published
/// lattice is always computed whole.
int largest_symmetry(const LatticeSettings& settings, const meshes::PressProtocol& protocol);

}  // namespace fingertip::lattice
