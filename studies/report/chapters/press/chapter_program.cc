/// Stages of a press after its first loading.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

std::string in_seconds(double time) {
  return std::isnan(time) ? "–" : fmt::format("{:.4g}", time);
}

/// Force and indentation in time, one above the other: of the trace, else of the samples.
std::vector<Panel> time_panels(const meshes::PressResponse& response, const PressFiles& files) {
  Panel force, way;
  force.x_label = way.x_label = "time [s]";
  force.y_label = shown_units().force.label("normal force");
  way.y_label = shown_units().length.label("indentation");
  force.key = way.key = "";
  Series pressed{"", "force", {}, {}, {}, {"#0072B2", "", 2.0, 0, true}},
      gone{"", "indentation", {}, {}, {}, {"#000000", "", 1.6, 0, true}};
  const auto add = [&](double time, double indentation, double normal_force) {
    if (std::isnan(time)) return;
    for (Series* series : {&pressed, &gone}) series->x.push_back(time);
    pressed.y.push_back(shown_units().force(normal_force));
    gone.y.push_back(shown_units().length(indentation));
  };
  for (const lattice::TraceRow& row : files.trace) add(row.time, row.indentation, row.normal_force);
  if (files.trace.empty())
    for (const meshes::PressSample& sample : response.samples())
      add(sample.time, sample.indentation, sample.normal_force);
  if (pressed.x.empty()) return {};
  force.series.push_back(std::move(pressed));
  way.series.push_back(std::move(gone));
  return {force, way};
}

Table stage_table(const std::vector<StageEntry>& stages) {
  const ShownUnits& units = shown_units();
  Table table;
  table.header = {plain("Stage"),
                  plain("Indentation", unit_name(units.length)),
                  plain("Speed", unit_name(units.speed)),
                  plain("From", "s"),
                  plain("To", "s"),
                  plain("Force before", unit_name(units.force)),
                  plain("Force after", unit_name(units.force)),
                  plain("Relaxed")};
  const auto force = [&](double value) {
    return std::isnan(value) ? plain("–") : plain(number(units.force(value)), si_note(value, "N"));
  };
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const StageEntry& stage = stages[i];
    table.rows.push_back(
        {plain(std::to_string(i + 1)),
         plain(fmt::format("{:.4g}", units.length(stage.indentation))),
         plain(stage.holds()             ? "hold"
               : std::isnan(stage.speed) ? "–"
                                         : number(units.speed(stage.speed))),
         plain(in_seconds(stage.begin)), plain(in_seconds(stage.end)), force(stage.begin_force),
         force(stage.end_force),
         plain(std::isnan(stage.relaxation) ? "–" : percent_magnitude(stage.relaxation))});
  }
  return table;
}

}  // namespace

Chapter program_chapter(const meshes::PressResponse& response, const PressFiles& files) {
  const bool several = files.summary.program.size() > 1;
  if (response.following().empty() && !several) return {};
  ChapterData chapter("program");
  const PressSummary& summary = files.summary;
  const auto millijoules = [](double energy) {
    return std::isnan(energy) ? "" : number(1e3 * energy) + " mJ";
  };
  chapter["work"] = millijoules(summary.work_in);
  chapter["loop"] = millijoules(summary.loop_area);
  if (const std::vector<Panel> panels = time_panels(response, files); !panels.empty())
    chapter.figures = {{"force_time", 760, 560, 1, panels}};
  chapter.tables["stages"] = stage_table(summary.program);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
