/// Presses under a controller: what was commanded, what became of it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

constexpr double speed_limit = 1.0;      ///< tolerated deviation from the commanded speed [%]
constexpr double tilt_limit = 0.05;      ///< tolerated tilt [degrees]
constexpr double force_limit = 5.0;      ///< tolerated overshoot of a force [%]
constexpr double settling = 0.050;       ///< the speed is judged from then on [s] ...
constexpr double first_contact = 0.020;  ///< ... but not for so long after first touch [s]

using lattice::TraceRow;

double touch_time(const MovingPress& press) {
  return press.summary.first_touch_time;
}

/// Deviation from the commanded speed in percent; NaN while nothing is commanded.
double speed_deviation(const TraceRow& row) {
  return row.commanded_speed > 0.0 && !row.force_mode
             ? 100.0 * (row.speed / row.commanded_speed - 1.0)
             : meshes::unknown;
}

/// One group of presses: they share a column of panels and thereby the axis of time.
using Group = std::vector<const MovingPress*>;

/// Presses of equal approach speed, the slowest first; those that control a force apart.
std::vector<Group> groups_of(const std::vector<MovingPress>& presses, bool force) {
  std::map<long, Group> by_speed;
  for (const MovingPress& press : presses) {
    if (press.trace.empty() || press.controls_force() != force) continue;
    by_speed[std::lround(1e5 * press.approach_speed())].push_back(&press);
  }
  std::vector<Group> groups;
  for (auto& [speed, group] : by_speed) groups.push_back(std::move(group));
  return groups;
}

/// A quantity of the trace of every press of the group against time.
Panel trace_panel(const Group& group, const std::string& label,
                  const std::function<double(const TraceRow&)>& value) {
  Panel panel{.x_label = "time [s]", .y_label = label, .key = ""};
  for (const MovingPress* press : group) {
    Style style = press->style;
    if (group.size() == 1) style.dash.clear();
    panel.series.push_back(curve(press->label, "", style, press->trace, &TraceRow::time, value));
  }
  panel.x_range = Range{0.0, extent_of(panel.series, &Series::x).to};
  return panel;
}

/// First touch, and when it counts as over. With several models the markers have their colours.
void mark_phases(const Group& group, Panel& panel) {
  for (const MovingPress* press : group) {
    const double touch = touch_time(*press);
    if (!std::isfinite(touch)) continue;
    const bool alone = press == group.front();
    panel.markers.push_back({touch, group.size() > 1 ? press->style.colour : "#444444"});
    const bool over = touch + first_contact < panel.x_range->to;
    if (alone && over) panel.markers.push_back({touch + first_contact, "#999999"});
  }
}

/// The words "approach", "first contact" and "pressing" at `height` where there is room for them.
void name_phases(const Group& group, double height, Panel& panel) {
  const double touch = touch_time(*group.front()), end = panel.x_range->to;
  if (!std::isfinite(touch) || !(end > touch)) return;
  const auto name = [&](double from, double to, const char* text, double letters) {
    if (to - from > 0.02 * letters * end) panel.texts.push_back({0.5 * (from + to), height, text});
  };
  name(0.0, touch, "approach", 8.0);
  name(touch, touch + first_contact, "first contact", 13.0);
  name(std::min(touch + first_contact, end), end, "pressing", 8.0);
}

Panel speed_panel(const Group& group) {
  const ShownUnit& unit = shown_units().speed;
  Panel panel = trace_panel(group, unit.label("approach speed"), in(unit, &TraceRow::speed));
  const double speed = group.front()->approach_speed();
  panel.title = unit.text(speed);
  panel.y_range = Range{0.0, 1.3 * unit(speed)};
  panel.key = "bottom right";
  name_phases(group, 1.18 * unit(speed), panel);
  return panel;
}

Panel deviation_panel(const Group& group) {
  Panel panel = trace_panel(group, "speed off command [%]", speed_deviation);
  panel.y_range = Range{-3.0, 3.0};
  panel.band = Band{-speed_limit, speed_limit};
  return panel;
}

/// Its rod keeps to mirror planes: that it does not tilt is no result.
bool is_part(const MovingPress& press) {
  return press.summary.census.sectors > 1;
}

Panel tilt_panel(const Group& group) {
  Panel panel = trace_panel(group, "tilt [degrees]",
                            [](const TraceRow& row) { return degree_per_radian * row.tilt; });
  const double most = std::fmax(tilt_limit, extent_of(panel.series, &Series::y).to);
  panel.y_range = Range{0.0, 1.15 * most};
  panel.band = Band{0.0, tilt_limit};
  return panel;
}

Panel command_panel(const Group& group) {
  const ShownUnit& unit = shown_units().force;
  return trace_panel(group, unit.label("commanded force"), in(unit, &TraceRow::command_force));
}

Panel force_panel(const Group& group) {
  const ShownUnit& unit = shown_units().force;
  Panel panel =
      trace_panel(group, unit.label("force of the tip"), in(unit, &TraceRow::normal_force));
  for (const MovingPress* press : group) {
    if (std::isnan(largest_of(press->trace, &TraceRow::wanted_force))) continue;
    panel.series.push_back(curve("wanted", press->label + " wanted", {"#000000", "(4,4)", 1.2},
                                 press->trace, &TraceRow::time, in(unit, &TraceRow::wanted_force)));
    const double last = panel.series.back().y.back();
    if (last > 0.0)
      panel.band = Band{last * (1.0 - 0.01 * force_limit), last * (1.0 + 0.01 * force_limit)};
  }
  return panel;
}

/// A column per group.
Figure columns_figure(const std::string& name, const std::vector<Group>& groups,
                      const std::vector<Panel (*)(const Group&)>& rows) {
  Figure figure;
  figure.name = name;
  figure.columns = int(groups.size());
  figure.width = std::max(760, 400 * figure.columns);
  figure.height = int(groups.size() == 1 ? 210 : 250) * int(rows.size());
  for (const auto& row : rows) {
    for (const Group& group : groups) {
      Panel panel = row(group);
      mark_phases(group, panel);
      if (figure.columns == 1) panel.title.clear();
      const bool last = row == rows.back();
      if (figure.columns > 1 && !last) panel.x_label = "time [s]";
      figure.panels.push_back(std::move(panel));
    }
  }
  return figure;
}

/// What is no more than round-off is not told by its digits.
std::string degrees(double angle) {
  if (!std::isfinite(angle)) return "–";
  return angle < 1e-9 ? "less than 1e-9 degrees" : number(angle, 2) + " degrees";
}

Table tracking_table(const std::vector<MovingPress>& presses) {
  const ShownUnits& units = shown_units();
  Table table{heads({"Press", "Approach\n" + unit_name(units.speed), "First touch\ns",
                     "Speed deviation\nlargest", "Speed deviation\nat first touch", "Tilt\nlargest",
                     "Peak force\n" + unit_name(units.force), "Overshoot\nof the force",
                     "Changes of mode"})};
  for (const MovingPress& press : presses) {
    if (press.trace.empty()) continue;
    const TrackingEntry& tracking = press.summary.tracking;
    const bool force = press.controls_force();
    const auto deviation = [&](double value) { return force ? "–" : percent_magnitude(value); };
    table.rows.push_back(
        {{press.label, trouble(press.status)},
         number(units.speed(press.approach_speed())),
         number(touch_time(press)),
         deviation(tracking.speed_deviation),
         deviation(tracking.speed_deviation_at_touch),
         degrees(tracking.tilt_deg),
         amount_cell(largest_of(press.trace, &TraceRow::normal_force), units.force),
         percent(force_overshoot(press.trace)),
         force ? number(mode_switches(press.trace)) : "–"});
  }
  table.drop_unknown(7);
  return table;
}

/// The largest of a measure over presses that follow a way; NaN when none has it.
double worst_of(const std::vector<MovingPress>& presses, double TrackingEntry::*measure) {
  double worst = meshes::unknown;
  for (const MovingPress& press : presses)
    if (!press.controls_force()) worst = std::fmax(worst, press.summary.tracking.*measure);
  return worst;
}

}  // namespace

std::string control_answer(const std::vector<MovingPress>& presses) {
  const double speed = worst_of(presses, &TrackingEntry::speed_deviation);
  double force = meshes::unknown;
  for (const MovingPress& press : presses) force = std::fmax(force, press.force_error);
  TemplateData words;
  words["speed"] = if_known(speed, percent_magnitude(speed));
  const double tilt = worst_of(presses, &TrackingEntry::tilt_deg);
  words["tilt"] = if_known(tilt, degrees(tilt));
  words["force"] = if_known(force, percent_magnitude(force));
  return sentences("answer_control", words);
}

Chapter control_chapter(const std::vector<MovingPress>& presses) {
  const std::vector<Group> tracked = groups_of(presses, false), forced = groups_of(presses, true);
  if (tracked.empty() && forced.empty()) return {};
  const bool forces = std::ranges::any_of(presses, &MovingPress::controls_force);
  const bool may_tilt = !std::ranges::all_of(presses, is_part);
  ChapterData chapter("control");
  chapter["forces"] = forces;
  chapter["may_tilt"] = may_tilt;
  chapter["parts"] = std::ranges::any_of(presses, is_part);
  std::vector<Panel (*)(const Group&)> followed{speed_panel, deviation_panel, tilt_panel,
                                                command_panel, force_panel};
  if (!may_tilt) std::erase(followed, tilt_panel);
  chapter.figures = {
      columns_figure("tracking", tracked, followed),
      columns_figure("force_control", forced, {speed_panel, command_panel, force_panel})};
  chapter.tables["tracking"] = tracking_table(presses);
  return written(std::move(chapter));
}

Chapter control_chapter(const RunData& run) {
  return control_chapter(presses_of_models(run));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
