#include "studies/report/results/grasp_run.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::report::inline results {

namespace {

using lattice::GraspRow;

std::vector<double> mean_of(const std::vector<GraspRow>& rows,
                            std::array<double, 2> GraspRow::*quantity) {
  std::vector<double> mean;
  for (const GraspRow& row : rows) mean.push_back(0.5 * ((row.*quantity)[0] + (row.*quantity)[1]));
  return mean;
}

}  // namespace

bool GraspRun::released() const {
  return !rows.empty() && rows.back().phase == lattice::GripPhase::release &&
         std::isfinite(summary.slip_force);
}

std::vector<double> GraspRun::normal() const {
  return mean_of(rows, &GraspRow::normal);
}

std::vector<double> GraspRun::tangential() const {
  return mean_of(rows, &GraspRow::tangential);
}

std::vector<double> GraspRun::point_friction() const {
  return mean_of(rows, &GraspRow::point_friction);
}

std::vector<double> GraspRun::inward_friction() const {
  return mean_of(rows, &GraspRow::inward_friction);
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
