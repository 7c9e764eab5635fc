/// One press by CalculiX: mesh, deck, run, and the forces it printed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "child_process.h"
#include "deck.h"

namespace fingertip::benchmarks {

struct CalculixRun {
  Cost cost;                   ///< of ccx alone; meshing and writing the deck are not charged to it
  std::size_t unknowns = 0;    ///< three per node of the tip
  int iterations = 0;          ///< over all steps, each with a factorisation
  std::vector<double> forces;  ///< of the whole tip, per depth [N]; fewer when it stopped short
};

/// The z components [mN] of all "total force" entries of a .dat file, in its order. Throws
/// std::runtime_error for a file that cannot be read or an entry that is cut short.
std::vector<double> read_total_forces(const std::filesystem::path& file);

/// The sum of the iterations in a .sta file; 0 when there is none.
int read_iterations(const std::filesystem::path& file);

/// Presses the default tip, its quarter meshed at `refinement` (meshes::TipMeshOptions::refined),
/// to `depths` [m] with the program `ccx` on `threads` threads in the folder `folder`, which is
/// made. A run that fails or exceeds `limit` seconds comes back with `cost.finished` false.
CalculixRun run_calculix(const std::string& ccx, double refinement,
                         const std::vector<double>& depths, const DeckOptions& options, int threads,
                         double limit, const std::filesystem::path& folder);

}  // namespace fingertip::benchmarks
