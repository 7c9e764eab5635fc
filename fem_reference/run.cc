#include "fem_reference/run.h"

#include <nlohmann/json.hpp>
#include <ostream>

#include "fem_reference/job/job.h"
#include "fem_reference/runs/runs.h"
#include "fem_reference/solvers/solver_choice.h"
#include "fem_reference/verification/verification.h"

namespace fingertip::fem_reference {

RunOutcome run_job(const std::filesystem::path& folder, std::ostream& progress,
                   const std::function<bool()>& stop_requested) {
  const ReferenceJob job = read_job(folder / "job.json");
  choose_solver(job, 0.0);  // refuses before anything is written
  if (job.analysis == Analysis::modes) return run_modes(folder, job, progress, stop_requested);
  if (job.analysis == Analysis::transient)
    return run_transient(folder, job, progress, stop_requested);
  if (job.analysis == Analysis::verification)
    return run_verification(folder, job, progress, stop_requested);
  return run_press(folder, job, progress, stop_requested);
}

RunOutcome tell_cost(const std::filesystem::path& folder, std::ostream& out) {
  const ReferenceJob job = read_job(folder / "job.json");
  choose_solver(job, 0.0);
  if (job.analysis != Analysis::static_press)
    throw meshes::InvalidInput({"analysis", std::string(name(job.analysis)),
                                "the cost is told of a static press", "choose static"});
  return outcome_of([&] {
    const PressCost cost = press_cost(folder, job);
    out << nlohmann::json{{"unknowns", cost.unknowns},
                          {"time", cost.expected.left},
                          {"memory", cost.expected.memory}}
        << '\n';
  });
}

}  // namespace fingertip::fem_reference
