/// Grasps: two fingers and a block, at grip forces around the friction limit.
#include <algorithm>
#include <set>

#include "studies/cases/folders.h"
#include "studies/cases/grasp_measures.h"
#include "studies/cases/plan.h"
#include "studies/files/case_summary.h"
#include "studies/files/json_fields.h"
#include "studies/run/grasp_job.h"

namespace fingertip::studies {

namespace {

using nlohmann::ordered_json;
namespace fs = std::filesystem;

class GraspPlan : public Plan {
 public:
  explicit GraspPlan(const Case& one) : case_(one) {}

  std::vector<PlannedJob> jobs() override;
  ordered_json conclude(const fs::path& folder, const std::vector<JobResult>& results) override;
  std::map<std::string, double> measures(const fs::path& folder,
                                         const ordered_json& summary) const override;

 private:
  void add(const CaseVariant& grasp);

  const Case& case_;
  std::vector<PlannedJob> jobs_;
  std::vector<std::string> folders_;  ///< in the order of the case's grasps
  std::map<std::string, std::string> folder_of_key_;
  std::set<std::string> taken_folders_;
  std::vector<RunMeasures> measures_;
  std::size_t not_converged_ = 0;
};

void GraspPlan::add(const CaseVariant& grasp) {
  Job job;
  try {
    job = grasp_job(grasp_setup(case_.loaded.with(grasp.sets)));
  } catch (const ConfigError& error) {
    throw at_variant(error, grasp);
  }
  std::string& folder = folder_of_key_[job.key()];
  if (folder.empty()) {
    const std::string series = grasp.series.empty() ? "" : as_folder(grasp.series) + "/";
    folder = "grasps/" + series + as_folder(grasp.name);
    while (!taken_folders_.insert(folder).second) folder += "_";
    jobs_.push_back({folder, job, true});
  }
  folders_.push_back(folder);
}

std::vector<PlannedJob> GraspPlan::jobs() {
  std::vector<Problem> problems;
  for (const CaseVariant& grasp : case_.grasps) {
    try {
      add(grasp);
    } catch (const ConfigError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw ConfigError(problems);
  // The longest first, so that the lanes end together.
  std::vector<PlannedJob> all = jobs_;
  std::ranges::stable_sort(all, std::greater(),
                           [](const PlannedJob& one) { return one.job.weight; });
  return all;
}

ordered_json GraspPlan::conclude(const fs::path& folder, const std::vector<JobResult>& results) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < folders_.size(); ++i) {
    const CaseVariant& grasp = case_.grasps[i];
    const auto job = std::ranges::find(results, folders_[i], &JobResult::name);
    if (!job->ok()) ++not_converged_;
    // What an incomplete grasp did so far must not pass for what it did.
    measures_.push_back(job->ok() ? measure_grasp(struct_of<GraspSummary>(
                                        read_entry(folder / folders_[i] / "summary.json")))
                                  : RunMeasures());
    ordered_json entry =
        meshes::json_of(GraspEntry{grasp.series, grasp.name, folders_[i], job->status});
    for (const auto& [name, value] : measures_.back()) entry[name] = value;
    list.push_back(std::move(entry));
  }
  return {{"grasps", list}};
}

std::map<std::string, double> GraspPlan::measures(const fs::path&, const ordered_json&) const {
  return take_grasp_measures(case_, measures_, not_converged_);
}

}  // namespace

std::unique_ptr<Plan> grasp_plan(const Case& one) {
  return std::make_unique<GraspPlan>(one);
}

}  // namespace fingertip::studies
