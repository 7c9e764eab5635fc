/// The continuum: what errors are measured against, and as a way of simulating the press itself.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "meshes/press/press_response.h"
#include "studies/bench/plan.h"
#include "studies/config/loader.h"
#include "studies/jobs/job.h"

namespace fingertip::studies::inline bench {

/// `count` even indentations [m] from plan.error_from to the plan's depth, and one before.
std::vector<double> error_depths(const BenchPlan& plan, int count);

/// Sticking contact, law A at finite strain or small strain, to the plan's depth.
Job truth_job(const LoadedConfig& loaded, const BenchPlan& plan, bool finite);

/// One mesh, no error estimate, `plan.continuum_solves` even equilibria to the plan's depth; never
/// cached.
Job continuum_job(const LoadedConfig& loaded, const BenchPlan& plan,
                  const ContinuumMesh& continuum);

/// {"degree", "refinement", "unknowns", "solves_per_second", "real_time_factor",
/// "worst_force_error"} of its folder. Quasi-static simulation in real time means one equilibrium
/// per control period: the factor is solves per second times the controller's `period` [s].
nlohmann::ordered_json continuum_entry(const std::filesystem::path& folder,
                                       const ContinuumMesh& continuum,
                                       const meshes::PressResponse& truth, const BenchPlan& plan,
                                       double period);

/// "degree2_0.5"
std::string continuum_name(const ContinuumMesh& continuum);

}  // namespace fingertip::studies::inline bench
