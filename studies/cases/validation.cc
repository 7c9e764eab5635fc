#include "studies/cases/validation.h"

#include <algorithm>

#include "studies/cases/plan.h"
#include "studies/report/report.h"
#include "studies/run/json_file.h"
#include "studies/run/press_setup.h"

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;

std::unique_ptr<Plan> plan_for(const Case& one) {
  if (!one.fits.empty()) return calibration_plan(one);
  if (!one.presses.empty()) return control_plan(one);
  if (!one.grasps.empty()) return grasp_plan(one);
  return one.variants.empty() ? core_plan(one) : variants_plan(one);
}

ordered_json judged(const std::vector<CaseCriterion>& criteria,
                    const std::map<std::string, double>& measures) {
  ordered_json list = ordered_json::array();
  for (const CaseCriterion& criterion : criteria) {
    const auto found = measures.find(criterion.measure);
    const bool known = found != measures.end();
    list.push_back({{"name", criterion.name},
                    {"measure", criterion.measure},
                    {"value", known ? ordered_json(found->second) : ordered_json()},
                    {"limit", criterion.limit},
                    {"passed", known && found->second <= criterion.limit}});
  }
  return list;
}

}  // namespace

void check_case(const Case& one) {
  if (one.variants.empty() && one.fits.empty() && one.presses.empty() && one.grasps.empty()) {
    check_validation(one.loaded);
  } else {
    plan_for(one)->jobs();
  }
}

Verdict validate(Session& session, const Case& one) {
  const std::filesystem::path& folder = session.folder().path();
  const std::unique_ptr<Plan> plan = plan_for(one);
  std::vector<JobResult> results;
  for (auto jobs = plan->jobs(); !jobs.empty(); jobs = plan->further_jobs(folder)) {
    session.expect_later(plan->later_weight());
    const std::vector<JobResult> more = session.run_all(jobs);
    results.insert(results.end(), more.begin(), more.end());
  }
  ordered_json summary = {
      {"case", one.name}, {"title", one.title}, {"description", one.description}, {"status", "ok"}};
  summary.update(plan->conclude(folder, results));
  summary["criteria"] = judged(one.criteria, plan->measures(folder, summary));
  const bool passed = std::ranges::all_of(
      summary["criteria"], [](const ordered_json& entry) { return entry["passed"].get<bool>(); });
  summary["status"] = passed ? "ok" : "criteria failed";
  write_json(summary, folder / "summary.json");
  write_report(folder);
  return passed ? Verdict::passed : Verdict::failed;
}

}  // namespace fingertip::studies
