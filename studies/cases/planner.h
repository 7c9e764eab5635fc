/// From the runs of a case to jobs, and from what these left to results.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "studies/cases/run_result.h"
#include "studies/fits/runs/calibration_stages.h"
#include "studies/jobs/session.h"

namespace fingertip::studies::inline cases {

/// Letters, digits, '-' and, but for the first place, '.'; anything else becomes '_'.
std::string as_folder(std::string text);

/// What [[case.run]] may name as its verb.
const std::vector<std::string>& run_verbs();

/// A continuum that presses are measured against. Lattice, offset and rotation do not matter to it.
struct Continuum {
  std::string folder;
  fem_reference::ReferenceJob reference;
  std::string key;  ///< of its job
};

class Planner {
 public:
  /// `study_case` must outlive the planner. Throws ConfigError with every problem of every run.
  explicit Planner(const Case& study_case);

  /// The jobs that may run now, given the results of those before in `folder`, in the order in
  /// which they should start. None: everything is computed.
  std::vector<PlannedJob> next(const std::filesystem::path& folder);

  /// What the jobs that `next` will still return weigh, as far as that is known.
  double later_weight() const;

  /// What the jobs left in `folder`.
  RunResults results(const std::filesystem::path& folder, const std::vector<JobResult>& jobs) const;

  const std::vector<Continuum>& continua() const { return continua_; }

 private:
  struct Fit {
    CalibrationStages stages;
    bool done = false;
  };

  void add(const CaseRun& run);
  void add_press(const LoadedConfig& loaded, RunResult& result);
  std::shared_ptr<const DisplacementFile> measured(const CaseRun& run);
  void keep_skin(const RunResult& result, const std::string& folder);
  void add_fit(const LoadedConfig& loaded, RunResult result);
  void add_prediction(const CaseRun& prediction, const RunResult& fit);
  Job job_of(const LoadedConfig& loaded, RunResult& result);
  /// The folder of the job, which is planned unless an equal one is.
  std::string planned(const RunResult& result, Job job);
  std::string free_folder(const CaseRun& run);
  /// The folder of a continuum, which is planned unless an equal one is.
  std::string continuum_of(const fem_reference::ReferenceJob& reference);
  std::vector<PlannedJob> predictions(const std::filesystem::path& folder);

  const Case& case_;
  RunResults results_;
  std::vector<Continuum> continua_;
  std::vector<Fit> fits_;
  std::vector<PlannedJob> jobs_;  ///< not handed out yet
  bool predicted_ = false;
  std::map<std::string, std::string> folder_of_key_;
  std::set<std::string> folders_;
  std::map<std::string, std::shared_ptr<const DisplacementFile>> measured_;  ///< by their paths
  std::map<std::string, std::string> skins_;  ///< of folders with a taxels.csv, as text
};

}  // namespace fingertip::studies::inline cases
