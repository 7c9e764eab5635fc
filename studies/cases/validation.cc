#include "studies/cases/validation.h"

#include "studies/cases/outputs.h"
#include "studies/report/report.h"

namespace fingertip::studies::inline cases {

namespace fs = std::filesystem;

void check_case(const Case& study_case) {
  if (const std::string missing = missing_data(study_case); !missing.empty())
    throw ConfigError({"case.data", study_case.data.variable, "the case cannot be carried out",
                       missing, study_case.name});
  Planner(study_case).next({});
}

Verdict validate(Session& session, const Case& study_case) {
  const fs::path& folder = session.folder().path();
  Planner planner(study_case);
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
  write_tables(study_case, results, folder);
  const CaseSummary summary = summary_of(study_case, planner, results, folder);
  write_summary(summary, results, folder / "summary.json");
  report::write_report(folder);
  return summary.status == "ok" ? Verdict::passed : Verdict::failed;
}

}  // namespace fingertip::studies::inline cases
