#include "studies/report/moving_press.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::reporting {

namespace fs = std::filesystem;

double MovingPress::approach_speed() const {
  return largest_magnitude(trace.numbers("commanded_speed [m/s]"));
}

bool MovingPress::controls_force() const {
  return largest_magnitude(trace.numbers_if_any("force_mode")) > 0.0;
}

MovingPress read_moving_press(const fs::path& folder, const std::string& label,
                              FolderReader& reader) {
  MovingPress press;
  press.label = label;
  reader.note_missing(folder);
  press.summary = reader.json(folder / "summary.json");
  press.status = reader.attempt([&] { return text_at(press.summary, "status"); });
  press.trace = reader.csv(folder / "trace.csv");
  press.boundary = reader.csv(folder / "boundary.csv");
  press.boundary_springs = reader.csv(folder / "boundary_springs.csv");
  press.snapshots = reader.csv(folder / "snapshots.csv");
  press.snapshot_points = reader.csv(folder / "snapshot_points.csv");
  press.response = reader.response(folder / "response.csv");
  return press;
}

std::vector<MovingPress> read_moving_presses(const RunData& run, FolderReader& reader) {
  std::vector<MovingPress> presses;
  std::vector<std::string> series;
  for (const JsonEntry& entry : run.presses) {
    const std::string name = text_at(entry, "series");
    const std::string label = (name.empty() ? "" : name + ", ") + text_at(entry, "name");
    MovingPress press = read_moving_press(run.folder / text_at(entry, "folder"), label, reader);
    if (std::ranges::find(series, name) == series.end()) series.push_back(name);
    press.style = numbered_style(std::size_t(std::ranges::find(series, name) - series.begin()));
    press.style.point = 0;
    press.status = text_at(entry, "status");
    press.beside = text_at(entry, "beside");
    press.change = number_at(entry, "change");
    press.force_error = number_at(entry, "force_error");
    press.pictured = entry.at("pictured").flag();
    if (const std::string continuum = text_at(entry, "continuum"); !continuum.empty())
      press.reference = reader.response(run.folder / continuum / "response.csv");
    presses.push_back(std::move(press));
  }
  return presses;
}

std::vector<MovingPress> presses_of_models(const RunData& run) {
  std::vector<MovingPress> presses;
  for (const ModelData& model : run.models) {
    MovingPress press;
    press.label = model_label(model.name);
    press.style = model_style(model.name);
    press.status = text_at(model.summary, "status");
    press.summary = model.summary;
    press.trace = model.trace;
    press.boundary = model.boundary;
    press.boundary_springs = model.boundary_springs;
    press.snapshots = model.snapshots;
    press.snapshot_points = model.snapshot_points;
    presses.push_back(std::move(press));
  }
  if (!presses.empty()) presses.back().pictured = true;
  return presses;
}

double force_overshoot(const CsvTable& trace) {
  const std::vector<double> force = trace.numbers("normal_force [N]");
  const std::vector<double> wanted = trace.numbers_if_any("wanted_force [N]");
  const std::vector<double> mode = trace.numbers_if_any("force_mode");
  double most = meshes::unknown;
  for (std::size_t i = 0; i < force.size(); ++i)
    if (mode[i] > 0.0 && wanted[i] > 0.0) most = std::fmax(most, force[i] / wanted[i] - 1.0);
  return std::isnan(most) ? most : std::max(most, 0.0);
}

double mode_switches(const CsvTable& trace) {
  const std::vector<double> mode = trace.numbers_if_any("force_mode");
  if (mode.empty() || std::isnan(mode.front())) return meshes::unknown;
  double switches = 0.0;
  for (std::size_t i = 1; i < mode.size(); ++i) switches += mode[i] != mode[i - 1] ? 1.0 : 0.0;
  return switches;
}

}  // namespace fingertip::studies::reporting
