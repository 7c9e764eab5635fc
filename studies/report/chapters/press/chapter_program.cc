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
  const ShownUnit &length = shown_units().length, &force = shown_units().force;
  Series pressed{"", "force", {"#0072B2"}}, gone{"", "indentation", {"#000000", "", 1.6}};
  const auto add = [&](const auto& rows) {
    for (const auto& row : rows) {
      if (std::isnan(row.time)) continue;
      pressed.add(row.time, force(row.normal_force));
      gone.add(row.time, length(row.indentation));
    }
  };
  add(files.trace);
  if (files.trace.empty()) add(response.samples());
  if (pressed.x.empty()) return {};
  return {
      {.x_label = "time [s]",
       .y_label = force.label("normal force"),
       .series = {pressed},
       .key = ""},
      {.x_label = "time [s]", .y_label = length.label("indentation"), .series = {gone}, .key = ""}};
}

}  // namespace

/// A move's speed, or what is done at an indentation.
std::string way_of(const StageEntry& stage) {
  if (stage.kind == "lateral") return "aside to " + length(stage.lateral);
  if (stage.kind == "twist")
    return "twist to " + fmt::format("{:.4g} deg", degree_per_radian * stage.twist);
  return stage.holds() ? "hold" : number(shown_units().speed(stage.speed));
}

Table stage_table(const std::vector<StageEntry>& stages) {
  const ShownUnits& units = shown_units();
  Table table{
      heads({"Stage", "Indentation\n" + unit_name(units.length), "Speed\n" + unit_name(units.speed),
             "From\ns", "To\ns", "Force before\n" + unit_name(units.force),
             "Force after\n" + unit_name(units.force), "Relaxed"})};
  double largest = 0.0;
  for (const StageEntry& stage : stages)
    largest = std::fmax(largest, std::fmax(stage.begin_force, stage.end_force));
  // What is no more than round-off is not told by its digits.
  const auto force = [&](double value) {
    return amount_cell(std::abs(value) < 1e-6 * largest ? 0.0 : value, units.force);
  };
  for (const StageEntry& stage : stages)
    table.rows.push_back({std::to_string(table.rows.size() + 1),
                          fmt::format("{:.4g}", units.length(stage.indentation)), way_of(stage),
                          in_seconds(stage.begin), in_seconds(stage.end), force(stage.begin_force),
                          force(stage.end_force), percent_magnitude(stage.relaxation)});
  return table;
}

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
