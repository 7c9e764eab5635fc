/// What a press leaves to be drawn: the tip's boundary, and the finger at a few moments.
#pragma once

#include <filesystem>

#include "lattice/press/press.h"

namespace fingertip::studies {

/// boundary.csv: at rest and at the end, which of it is held; boundary_springs.csv: pairs of its
/// rows.
void write_boundary(const lattice::PressOutcome& outcome, const std::filesystem::path& folder);

/// snapshots.csv: a row per moment with the rod's pose, the tip's wrench on it about its endpoint
/// and the plane; snapshot_points.csv: the boundary then, in the order of boundary.csv, to 10 nm.
/// World axes.
void write_snapshots(const lattice::PressOutcome& outcome, const std::filesystem::path& folder);

}  // namespace fingertip::studies
