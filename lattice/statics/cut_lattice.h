/// The tip as a lattice with its true surfaces: cells are cut, bond and contact lie on sphere and
/// cylinder.
#pragma once

#include <array>

#include "lattice/model/cut_tip.h"
#include "lattice/model/lattice_settings.h"
#include "lattice/model/model.h"
#include "lattice/statics/lattice_body.h"
#include "meshes/press/press_protocol.h"
#include "meshes/rubber/rubber.h"
#include "meshes/shape/geometry.h"

namespace fingertip::lattice::inline statics {

/// Tie of a published particle to the plane over E a.
inline constexpr double particle_tie = 20.0;
/// central, hookean or network on cells cut by the tip's true surfaces (cut_tip, Formulation); a
/// cell gives its springs, law and mass what of them lies in its rubber, mirror planes hold the
/// displacement across them. Where fibres and a cell law make up the material, a linear
/// displacement costs the rubber's energy in every cell, and its nodal forces are those of its
/// traction on the true surfaces (patch test). Throws InvalidInput as cut_tip does.
LatticeBody build_cut_tip(const meshes::Geometry& geometry, const meshes::Rubber& rubber,
                          const LatticeSettings& settings, int sectors);

/// The published lattice, the whole tip, as lists: every spring as in the model, particles tied to
/// the rod by their ligaments, boundary particles down to R - r below the equator that touch by
/// themselves (area a² each, tie particle_tie E a). Throws InvalidInput for the other models,
/// which do not press with their staircase: see build_cut_tip.
LatticeBody body_of(const LatticeModel& model, const meshes::Geometry& geometry,
                    const meshes::Rubber& rubber);

/// The same of a free block of springs and whole cells (build_block).
LatticeBody body_of_block(const LatticeModel& model);

/// A free block of cells[0] x cells[1] x cells[2] whole cells, made like those of build_cut_tip,
/// with its lowest corner at the origin and its edges along settings.axes; without bond and outer
/// points. Throws InvalidInput for constants as build_cut_tip does, a spacing that is not positive
/// and a count below 1.
LatticeBody build_free_block(const meshes::Rubber& rubber, const LatticeSettings& settings,
                             const std::array<int, 3>& cells);

/// 4, 2 or 1: into how many mirror images grid, obstacle and way divide a press. Offsets along x
/// and y must vanish and the grid must not be rotated; tilt and lateral motion leave y -> -y alone;
/// a solid has none.
int way_symmetry(const meshes::Geometry& geometry, const LatticeSettings& settings,
                 const meshes::PressProtocol& protocol);
/// How many of them serve in equilibrium: the published lattice is computed whole.
int largest_symmetry(const meshes::Geometry& geometry, const LatticeSettings& settings,
                     const meshes::PressProtocol& protocol);

}  // namespace fingertip::lattice::inline statics
