/// One press by CalculiX: mesh, deck, run, and the forces it printed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "child_process.h"
#include "deck.h"
#include "meshes/volume_mesh/volume_mesh.h"

namespace fingertip::benchmarks {

struct CalculixRun {
  Cost cost;                   ///< of ccx alone; meshing and writing the deck are not charged to it
  std::size_t unknowns = 0;    ///< two per node of the meridian
  int iterations = 0;          ///< over all steps, each with a factorisation
  std::vector<double> forces;  ///< of the whole tip, per depth [N]; fewer when it stopped short
};

/// The y components [mN] of all "total force" entries of a .dat file, in its order. Throws
/// std::runtime_error for a file that cannot be read or an entry that is cut short.
std::vector<double> read_total_forces(const std::filesystem::path& file);

/// The sum of the iterations in a .sta file; 0 when there is none.
int read_iterations(const std::filesystem::path& file);

/// Presses the default tip, its meridian meshed by `mesh` (whose sector does not matter), to
/// `depths` [m] with the program `ccx` on one thread in the folder `folder`, which is made. A run
/// that fails or exceeds `limit` seconds comes back with `cost.finished` false.
CalculixRun run_calculix(const std::string& ccx, Problem problem, meshes::TipMeshOptions mesh,
                         const std::vector<double>& depths, const DeckOptions& options,
                         double limit, const std::filesystem::path& folder);

/// The deck press.inp in `folder`, in the same way; `unknowns` is left to the caller.
CalculixRun run_deck(const std::string& ccx, double limit, const std::filesystem::path& folder);

}  // namespace fingertip::benchmarks
