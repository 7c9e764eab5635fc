/// What a case computes and what it concludes from it. A case with variants compares static
/// presses, one with fits calibrations and what they predict, one with presses controllers, one
/// with grasps how a block is held; others follow the core plan.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "studies/cases/case_file.h"
#include "studies/run/session.h"

namespace fingertip::studies {

/// One use: jobs, further_jobs until there are none, then conclude, then measures.
class Plan {
 public:
  virtual ~Plan() = default;

  /// In the order in which they should start. Throws ConfigError.
  virtual std::vector<PlannedJob> jobs() = 0;

  /// What needs the results in `folder` of the jobs before; none when everything is computed.
  virtual std::vector<PlannedJob> further_jobs(const std::filesystem::path& /*folder*/) {
    return {};
  }

  /// What the jobs that further_jobs will return weigh, as far as that is known.
  virtual double later_weight() const { return 0.0; }

  /// Reads what the jobs left in `folder`, writes the tables that need several of them, and returns
  /// the plan's part of summary.json.
  virtual nlohmann::ordered_json conclude(const std::filesystem::path& folder,
                                          const std::vector<JobResult>& results) = 0;

  /// What criteria are judged by. A measure that could not be taken is absent.
  virtual std::map<std::string, double> measures(const std::filesystem::path& folder,
                                                 const nlohmann::ordered_json& summary) const = 0;
};

/// Continuum, fits, cubes, a press of each model, studies of the published and the static lattice.
/// `one` must outlive the plan, here and below.
std::unique_ptr<Plan> core_plan(const Case& one);

/// Calibrations, and presses with what they found beside the continuum.
std::unique_ptr<Plan> calibration_plan(const Case& one);

/// Presses under controllers, and the continua at their speeds.
std::unique_ptr<Plan> control_plan(const Case& one);

/// Two fingers that grasp a block, at one grip force after another.
std::unique_ptr<Plan> grasp_plan(const Case& one);

/// A static press per variant and the continua they are measured against.
std::unique_ptr<Plan> variants_plan(const Case& one);

}  // namespace fingertip::studies
