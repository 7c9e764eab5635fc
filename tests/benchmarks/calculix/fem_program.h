/// One press by this project's own continuum, as a user starts it: a job folder and the program.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "child_process.h"
#include "deck.h"

namespace fingertip::benchmarks {

struct FemRun {
  Cost cost;                   ///< of the whole program: meshing, assembly, factorisation, contact
  std::size_t unknowns = 0;    ///< of the last mesh
  std::vector<double> forces;  ///< per depth on the last mesh [N]; fewer when it stopped short
};

struct FemOptions {
  double tolerance = 5e-3;  ///< of the force's estimated error
  int degree = 2;           ///< of the elements
};

/// Presses the default tip's meridian frictionlessly to `depths` [m] (`Problem::neo_hooke`: with
/// law C), with `program` on one thread in the folder `folder`, which is made: on the program's own
/// first mesh, then on adaptively refined ones until its error estimate meets the tolerance; the
/// cost is that of all of them. A run that fails or exceeds `limit` seconds comes back with
/// `cost.finished` false.
FemRun run_fem(const std::string& program, Problem problem, const FemOptions& options,
               const std::vector<double>& depths, double limit,
               const std::filesystem::path& folder);

/// The job `job` (job.json), in the same way.
FemRun run_fem_job(const std::string& program, const nlohmann::json& job, double limit,
                   const std::filesystem::path& folder);

}  // namespace fingertip::benchmarks
