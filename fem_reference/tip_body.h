/// The tip as a Body, in the axes of the plane. deal.II's side.
#pragma once

#include <filesystem>
#include <memory>

#include "fem_reference/body.h"
#include "fem_reference/contact_surface.h"
#include "meshes/volume_mesh.h"

namespace fingertip::fem_reference {

/// Reads the gmsh mesh of a quarter or half tip and turns it about y by -`tilt` [rad], so that the
/// plane's normal becomes the z axis whatever the tilt: n = (-sin tilt, 0, -cos tilt) in rod axes
/// is (0, 0, -1) in plane axes, and t1 is their x axis. Refined cells keep to the true sphere and
/// cylinder. Collective over `communicator`. Throws InvalidInput when the mesh cannot be read, is
/// damaged or has inverted elements.
std::unique_ptr<Body> read_tip(MPI_Comm communicator, const std::filesystem::path& mesh_file,
                               int degree, double tilt);

/// What holds the tip: all of `bond`, and on the symmetry planes that the mesh has the component
/// across them.
std::vector<FixedComponent> tip_supports();

/// All nodes of the outer surface that are free to move along z, sorted by position.
std::vector<SurfaceNode> outer_nodes(const Body& tip);

/// Lumped area per unknown of the outer surface (hanging nodes condensed), at the z unknowns [m²].
/// With `displacement`, the area of the deformed surface projected on the plane.
Vector outer_area(const Body& tip, const Vector* displacement = nullptr);

}  // namespace fingertip::fem_reference
