/// One press by this project's own continuum, as a user starts it: a job folder and the program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "child_process.h"

namespace fingertip::benchmarks {

struct FemRun {
  Cost cost;                   ///< of the whole program: meshing, assembly, factorisation, contact
  std::size_t unknowns = 0;    ///< of the last mesh
  std::vector<double> forces;  ///< per depth on the last mesh [N]; fewer when it stopped short
};

/// Presses the default tip frictionlessly to `depths` [m], with `program` on `threads` threads in
/// the folder `folder`, which is made: on the program's own first mesh, then on adaptively refined
/// ones, as long as they have at most `max_unknowns`; the cost is that of all of them. A run that
/// fails or exceeds `limit` seconds comes back with `cost.finished` false.
FemRun run_fem(const std::string& program, double max_unknowns, const std::vector<double>& depths,
               int threads, double limit, const std::filesystem::path& folder);

}  // namespace fingertip::benchmarks
