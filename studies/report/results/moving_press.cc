#include "studies/report/results/moving_press.h"

#include <algorithm>
#include <cmath>

namespace fingertip::studies::report::inline results {

namespace fs = std::filesystem;

using lattice::TraceRow;

double MovingPress::approach_speed() const {
  return largest_of(trace, &TraceRow::commanded_speed);
}

bool MovingPress::controls_force() const {
  return std::ranges::any_of(trace, &TraceRow::force_mode);
}

MovingPress read_moving_press(const fs::path& folder, const std::string& label,
                              FolderReader& reader) {
  MovingPress press;
  static_cast<PressFiles&>(press) = read_press_files(folder, reader);
  press.label = label;
  press.status = press.summary.status;
  press.response = reader.response(folder / "response.csv");
  return press;
}

std::vector<MovingPress> read_moving_presses(const RunData& run, FolderReader& reader) {
  std::vector<MovingPress> presses;
  std::vector<std::string> series;
  for (const PressEntry& entry : run.summary.presses) {
    const std::string& name = entry.series;
    const std::string label = (name.empty() ? "" : name + ", ") + entry.name;
    MovingPress press = read_moving_press(run.folder / entry.folder, label, reader);
    if (std::ranges::find(series, name) == series.end()) series.push_back(name);
    press.style = numbered_style(std::size_t(std::ranges::find(series, name) - series.begin()));
    press.style.point = 0;
    press.status = entry.status;
    press.beside = entry.beside;
    press.change = entry.change;
    press.force_error = entry.force_error;
    press.pictured = entry.pictured;
    if (!entry.continuum.empty())
      press.reference = reader.response(run.folder / entry.continuum / "response.csv");
    presses.push_back(std::move(press));
  }
  return presses;
}

std::vector<MovingPress> presses_of_models(const RunData& run) {
  std::vector<MovingPress> presses;
  for (const ModelData& model : run.models) {
    MovingPress press;
    static_cast<PressFiles&>(press) = model;
    press.label = model_label(model.name);
    press.style = model_style(model.name);
    press.status = model.summary.status;
    presses.push_back(std::move(press));
  }
  if (!presses.empty()) presses.back().pictured = true;
  return presses;
}

double force_overshoot(const std::vector<TraceRow>& trace) {
  double most = meshes::unknown;
  for (const TraceRow& row : trace)
    if (row.force_mode && row.wanted_force > 0.0)
      most = std::fmax(most, row.normal_force / row.wanted_force - 1.0);
  return std::isnan(most) ? most : std::max(most, 0.0);
}

double mode_switches(const std::vector<TraceRow>& trace) {
  if (trace.empty()) return meshes::unknown;
  double switches = 0.0;
  for (std::size_t i = 1; i < trace.size(); ++i)
    switches += trace[i].force_mode != trace[i - 1].force_mode ? 1.0 : 0.0;
  return switches;
}

}  // namespace fingertip::studies::report::inline results
