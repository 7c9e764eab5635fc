#include "studies/cases/control_measures.h"

#include <algorithm>
#include <cmath>

#include "studies/report/moving_press.h"

namespace fingertip::studies {

namespace {

namespace fs = std::filesystem;

/// Whether the case asks for the measure of this press.
bool is_meant(const CasePress& press, const std::string& measure) {
  if (measure == "force_error") return press.continuum;
  if (measure == "change") return !press.beside.empty();
  return true;
}

}  // namespace

const std::vector<std::string>& press_measures() {
  static const std::vector<std::string> names = {"speed_deviation", "speed_deviation_at_touch",
                                                 "tilt_deg",        "momentum_defect",
                                                 "force_error",     "change",
                                                 "force_overshoot", "mode_switches"};
  return names;
}

RunMeasures tracking_measures(const fs::path& folder) {
  RunMeasures measures;
  if (fs::exists(folder / "summary.json")) {
    const auto summary = struct_of<PressSummary>(read_entry(folder / "summary.json"));
    measures["speed_deviation"] = summary.tracking.speed_deviation;
    measures["speed_deviation_at_touch"] = summary.tracking.speed_deviation_at_touch;
    measures["tilt_deg"] = summary.tracking.tilt_deg;
    measures["momentum_defect"] = summary.momentum_defect;
  }
  std::vector<lattice::TraceRow> trace;
  if (fs::exists(folder / "trace.csv"))
    trace = meshes::read_rows<lattice::TraceRow>(folder / "trace.csv");
  measures["force_overshoot"] = reporting::force_overshoot(trace);
  measures["mode_switches"] = reporting::mode_switches(trace);
  std::erase_if(measures, [](const auto& entry) { return std::isnan(entry.second); });
  return measures;
}

std::vector<std::string> control_measure_names(const Case& one) {
  std::vector<std::string> names = {"presses.not_converged", "reference.force_error"};
  for (const CasePress& press : one.presses) {
    for (const std::string& judged : judged_names(press)) {
      for (const std::string& measure : press_measures()) {
        const std::string name = judged + "." + measure;
        if (is_meant(press, measure) && std::ranges::find(names, name) == names.end())
          names.push_back(name);
      }
    }
  }
  return names;
}

std::map<std::string, double> take_control_measures(const Case& one,
                                                    const std::vector<RunMeasures>& presses,
                                                    std::size_t not_converged,
                                                    double reference_error) {
  std::map<std::string, double> taken;
  taken["presses.not_converged"] = double(not_converged);
  taken["reference.force_error"] = reference_error;
  for (std::size_t i = 0; i < one.presses.size(); ++i) {
    for (const std::string& measure : press_measures()) {
      if (!is_meant(one.presses[i], measure)) continue;
      enter(one.presses[i], measure, presses[i], taken);
    }
  }
  std::erase_if(taken, [](const auto& entry) { return std::isnan(entry.second); });
  return taken;
}

}  // namespace fingertip::studies
