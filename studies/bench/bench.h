/// Everything `bench` measures, as one document.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "studies/bench/plan.h"
#include "studies/config/loader.h"
#include "studies/jobs/session.h"

namespace fingertip::studies::inline bench {

/// Measures in sub-folders of the session's run folder and returns the document of README.md. What
/// a program is missing for is null, and told under `missing`. Throws what the jobs throw.
nlohmann::ordered_json run_bench(Session& session, const LoadedConfig& loaded,
                                 const BenchPlan& plan);

/// The document for a terminal: ratios, presses, peers.
std::string bench_text(const nlohmann::ordered_json& bench);

}  // namespace fingertip::studies::inline bench
