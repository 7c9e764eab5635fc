/// Grasps, read back from their folders.
#pragma once

#include <string>
#include <vector>

#include "lattice/grasp/grasp_table.h"
#include "studies/files/grasp_summary.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline results {

/// One grasp; what its folder does not hold is empty.
struct GraspRun {
  std::string series, name;
  std::string label;   ///< "series, name"
  std::string status;  ///< "finished", or why not
  std::vector<lattice::GraspRow> rows;
  GraspSummary summary;

  double grip() const { return summary.wanted_force; }               ///< [N]
  double limit() const { return summary.least_force; }               ///< m (g + a)/(2 mu)
  double rest_limit() const { return summary.least_force_at_rest; }  ///< m g/(2 mu)
  const std::string& fate() const { return summary.fate; }
  bool held() const { return fate() == "held"; }
  /// Whether the grip force fell after the hold until the block slipped.
  bool released() const;
};

GraspRun read_grasp(const std::filesystem::path& folder, const std::string& series,
                    const std::string& name, FolderReader& reader);

/// The grasps that `run` lists in its summary.
std::vector<GraspRun> read_grasps(const RunData& run, FolderReader& reader);

}  // namespace fingertip::studies::report::inline results
