#include "studies/cases/validation.h"

#include <algorithm>

#include "studies/cases/measures.h"
#include "studies/cases/outputs.h"
#include "studies/report/report.h"
#include "studies/run/json_file.h"

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

ordered_json judged(const std::vector<CaseCriterion>& criteria, const Measures& measures) {
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
  Planner(one).next({});
}

Verdict validate(Session& session, const Case& one) {
  const fs::path& folder = session.folder().path();
  Planner planner(one);
  std::vector<JobResult> jobs;
  for (auto planned = planner.next(folder); !planned.empty(); planned = planner.next(folder)) {
    session.expect_later(planner.later_weight());
    const std::vector<JobResult> more = session.run_all(planned);
    jobs.insert(jobs.end(), more.begin(), more.end());
  }
  const RunResults results = planner.results(folder, jobs);
  // Where people have looked for it since before it had a folder of its own.
  if (fs::exists(folder / "cubes/cubes.csv"))
    fs::copy_file(folder / "cubes/cubes.csv", folder / "cubes.csv",
                  fs::copy_options::overwrite_existing);
  write_tables(one, results, folder);
  ordered_json summary = {
      {"case", one.name}, {"title", one.title}, {"description", one.description}, {"status", "ok"}};
  summary.update(summary_of(one, planner, results, folder));
  summary["criteria"] = judged(one.criteria, take_measures(one, results));
  const bool passed = std::ranges::all_of(
      summary["criteria"], [](const ordered_json& entry) { return entry["passed"].get<bool>(); });
  summary["status"] = passed ? "ok" : "criteria failed";
  write_json(summary, folder / "summary.json");
  write_report(folder);
  return passed ? Verdict::passed : Verdict::failed;
}

}  // namespace fingertip::studies
