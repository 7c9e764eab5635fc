#include "studies/report/results/grasp_run.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::report::inline results {

using lattice::GraspRow;

bool GraspRun::released() const {
  return !rows.empty() && rows.back().phase == lattice::GripPhase::release &&
         std::isfinite(summary.slip_force);
}

GraspRun read_grasp(const std::filesystem::path& folder, const std::string& series,
                    const std::string& name, FolderReader& reader) {
  GraspRun grasp;
  grasp.series = series;
  grasp.name = name;
  grasp.label = (series.empty() ? "" : series + ", ") + name;
  grasp.rows = reader.rows<GraspRow>(folder / "grasp.csv");
  grasp.summary = reader.take<GraspSummary>(reader.json(folder / "summary.json"));
  grasp.status = grasp.summary.status;
  return grasp;
}

std::vector<GraspRun> read_grasps(const RunData& run, FolderReader& reader) {
  std::vector<GraspRun> grasps;
  for (const GraspEntry& entry : run.summary.grasps) {
    grasps.push_back(read_grasp(run.folder / entry.folder, entry.series, entry.name, reader));
    grasps.back().status = entry.status;
  }
  return grasps;
}

}  // namespace fingertip::studies::report::inline results
