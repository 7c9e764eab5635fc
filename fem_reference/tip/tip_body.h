/// The tip as a Body, in the axes of the plane. deal.II's side.
#pragma once

#include <filesystem>
#include <memory>

#include "fem_reference/contact/contact_surface.h"
#include "fem_reference/elements/body.h"
#include "meshes/volume_mesh/volume_mesh.h"

namespace fingertip::fem_reference::inline tip {

/// Reads the gmsh mesh of a tip (dim = 3: quarter, half or all; dim = 2: the meridian) and turns it
/// about y by -`tilt` [rad], so that the plane's normal becomes the z axis whatever the tilt: n =
/// (-sin tilt, 0, -cos tilt) in rod axes is (0, 0, -1) in plane axes, and t1 is their x axis.
/// Refined cells keep to the true sphere and cylinder, or to the parts of `geometry`'s boundary.
/// Collective over `communicator`. Throws InvalidInput when the mesh cannot be read, is damaged or
/// has inverted elements. A meridian takes no tilt.
template <int dim>
std::unique_ptr<Body<dim>> read_tip(MPI_Comm communicator, const std::filesystem::path& mesh_file,
                                    int degree, double tilt, const meshes::Geometry& geometry = {},
                                    int components = dim);

/// What holds the tip: all of `bond`, and on the symmetry planes that the mesh has (the axis, of a
/// meridian) the component across them; on the axis u_phi, too.
template <int dim>
std::vector<FixedComponent> tip_supports(int components = dim);

/// The nodes of the outer surface that are free to move along z, sorted by position. The pole of a
/// meridian has no area: Gauss-Lobatto quadrature gives it no force, and that of an even pressure
/// on quadratic elements vanishes there.
template <int dim>
std::vector<SurfaceNode> outer_nodes(const Body<dim>& tip);

/// Lumped area per unknown of the outer surface (hanging nodes condensed), at the z unknowns [m²].
/// With `displacement`, the area of the deformed surface projected on the plane.
template <int dim>
Vector outer_area(const Body<dim>& tip, const Vector* displacement = nullptr);

/// Of nodes, seen along the press; at rest without a displacement [m²].
template <int dim>
std::vector<double> seen_areas(const Body<dim>& tip, const std::vector<SurfaceNode>& nodes,
                               const Vector* displacement);

/// Of nodes of a meridian, of any but a pole: the mean of r² over the surface, weighted by the
/// node's shape function [m²]. Its force over its area is the pressure where r² has this value,
/// were p linear in r²: at a node in the middle of a side not its own place.
std::vector<double> mean_squares(const Body<2>& tip, const std::vector<SurfaceNode>& nodes,
                                 const Vector* displacement);

}  // namespace fingertip::fem_reference::inline tip
