#include "studies/report/grasp_run.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::reporting {

namespace {

std::vector<double> mean_of(const CsvTable& rows, const std::string& quantity) {
  std::vector<double> mean = rows.numbers(quantity + "_1 [N]");
  const std::vector<double> second = rows.numbers(quantity + "_2 [N]");
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] = 0.5 * (mean[i] + second[i]);
  return mean;
}

}  // namespace

bool GraspRun::released() const {
  const std::vector<std::string> phases = rows.texts("phase");
  return !phases.empty() && phases.back() == "release" &&
         std::isfinite(number_at(summary, "slip_force"));
}

std::vector<double> GraspRun::normal() const {
  return mean_of(rows, "normal_force");
}

std::vector<double> GraspRun::tangential() const {
  return mean_of(rows, "tangential_force");
}

std::vector<double> GraspRun::point_friction() const {
  return mean_of(rows, "point_friction");
}

std::vector<double> GraspRun::inward_friction() const {
  return mean_of(rows, "inward_friction");
}

GraspRun read_grasp(const std::filesystem::path& folder, const std::string& series,
                    const std::string& name, FolderReader& reader) {
  GraspRun grasp;
  grasp.series = series;
  grasp.name = name;
  grasp.label = (series.empty() ? "" : series + ", ") + name;
  grasp.rows = reader.csv(folder / "grasp.csv");
  grasp.summary = reader.json(folder / "summary.json");
  grasp.status = reader.attempt([&] { return text_at(grasp.summary, "status"); });
  return grasp;
}

std::vector<GraspRun> read_grasps(const RunData& run, FolderReader& reader) {
  std::vector<GraspRun> grasps;
  for (const JsonEntry& entry : run.grasps) {
    grasps.push_back(read_grasp(run.folder / text_at(entry, "folder"), text_at(entry, "series"),
                                text_at(entry, "name"), reader));
    grasps.back().status = text_at(entry, "status");
  }
  return grasps;
}

}  // namespace fingertip::studies::reporting
