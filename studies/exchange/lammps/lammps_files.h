/// A lattice as LAMMPS reads it: a data file and an input script.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "meshes/base/errors.h"
#include "studies/exchange/lammps/lammps_script.h"
#include "studies/exchange/lammps/undamped_body.h"

namespace fingertip::studies::inline exchange::inline lammps {

/// What was written.
struct LammpsCensus {
  std::size_t masses = 0;
  std::size_t anchors = 0;  ///< atoms that stand for places of the rod
  std::size_t springs = 0;  ///< bonds between masses
  std::size_t bond_types = 0;
};

/// What of the model LAMMPS has no means for: springs that keep their directions at rest, cells
/// with a law, ties between points of surfaces. Empty where it can be written.
std::vector<meshes::Violation> beyond_lammps(const lattice::LatticeModel& model);

/// Writes lattice.data and lattice.in into `folder` (README: format). Atoms 1, 2, ... are
/// model.particles in their order, anchors follow; velocities are those at the time of the
/// positions. Throws InvalidInput for what is beyond_lammps.
LammpsCensus write_lammps(const UndampedBody& body, const LammpsSettings& settings,
                          const std::filesystem::path& folder);

}  // namespace fingertip::studies::inline exchange::inline lammps
