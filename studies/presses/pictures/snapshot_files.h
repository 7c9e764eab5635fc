/// What a press leaves to be drawn: the tip's boundary, and the finger at a few moments.
#pragma once

#include <filesystem>

#include "lattice/press/press_pictures.h"

namespace fingertip::studies::inline presses::inline pictures {

/// World axes, of which the plane is at rest.
///   boundary.csv          at rest and at the end, which of it is held
///   boundary_springs.csv  pairs of its rows
///   snapshots.csv         a row per moment with the rod's pose, the tip's wrench on it about its
///                         endpoint and the plane
///   snapshot_points.csv   the boundary then, in the order of boundary.csv, to 10 nm
void write_shapes(const lattice::PressShapes& shapes, const std::filesystem::path& folder);

}  // namespace fingertip::studies::inline presses::inline pictures
