/// What one press or one search for natural vibrations found.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <span>
#include <string>

#include "studies/files/mode_table.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

const Style single{"#0072B2", "", 2.2, 7};

SampleColumn normal_force() {
  return {"Normal force", &meshes::PressSample::normal_force, shown_units().force};
}

/// From zero, where both begin, unless inertia pulls at the rod or it lifts off.
void begin_at_zero(Panel& panel) {
  const auto range = [&](std::vector<double> Series::*numbers) {
    const bool negative = extent_of(panel.series, numbers).from < 0.0;
    return negative ? std::nullopt : std::optional(Range{0.0});
  };
  panel.x_range = range(&Series::x);
  panel.y_range = range(&Series::y);
}

Panel curve_panel(SampleRange samples, const SampleColumn& over, const SampleColumn& column) {
  Panel panel{.x_label = over.label(),
              .y_label = column.label(),
              .series = {curve("", "press", samples.size() > max_rows ? single.as_line() : single,
                               samples, in(over.unit, over.value), in(column.unit, column.value))},
              .key = ""};
  begin_at_zero(panel);
  return panel;
}

/// Error bars at the depths of the table, where errors are known.
Series error_bars(SampleRange samples) {
  Series bars{"", "estimated error", single.as_points()};
  for (const meshes::PressSample& sample : thinned(samples)) {
    if (std::isnan(sample.force_error)) continue;
    bars.add(shown_units().length(sample.indentation), shown_units().force(sample.normal_force));
    bars.error.push_back(shown_units().force(sample.force_error));
  }
  return bars;
}

/// Force of a whole program: the first loading, and then the way on from its end.
Panel loop_panel(const meshes::PressResponse& response,
                 const std::vector<lattice::TraceRow>& trace) {
  const SampleRange loading = response.pressing();
  Panel panel = curve_panel(loading, indentation(), normal_force());
  if (Series bars = error_bars(loading); !bars.x.empty()) panel.series.push_back(std::move(bars));
  if (response.following().empty()) return panel;
  Series then{"then", "then", {"#D55E00", "", 2.2, trace.empty() ? 7 : 0}};
  const auto add = [&then](const auto& row) {
    then.add(shown_units().length(row.indentation), shown_units().force(row.normal_force));
  };
  add(loading.back());
  for (const lattice::TraceRow& row : trace)
    if (row.time > loading.back().time) add(row);
  if (trace.empty())
    for (const meshes::PressSample& sample : response.following()) add(sample);
  panel.series.front().label = "first loading";
  panel.series.push_back(std::move(then));
  panel.key = "top left";
  begin_at_zero(panel);
  return panel;
}

bool is_known(SampleRange samples, const SampleColumn& column) {
  return std::ranges::any_of(samples, [&](const meshes::PressSample& sample) {
    return std::isfinite(sample.*column.value);
  });
}

/// What solvers leave, of the normal force.
constexpr double noise = 1e-7;

/// Whether a force is more than that.
bool significant(SampleRange samples, double meshes::PressSample::*force) {
  return std::ranges::any_of(samples, [force](const meshes::PressSample& sample) {
    return std::abs(sample.*force) > noise * std::abs(sample.normal_force);
  });
}

/// Of a torque about the normal.
bool holds_a_turn(SampleRange samples) {
  return std::ranges::any_of(samples, [](const meshes::PressSample& sample) {
    return std::abs(sample.spin_torque) >
           noise * sample.contact_radius * std::abs(sample.normal_force);
  });
}

/// Whether two rows are a motion of the plane at one depth.
auto moves_by(double meshes::PressSample::*way) {
  return [way](const meshes::PressSample& from, const meshes::PressSample& to) {
    return from.indentation == to.indentation && std::abs(to.*way - from.*way) > 0.0;
  };
}

void add_samples(ChapterData& chapter, SampleRange samples, const std::vector<SampleColumn>& over) {
  const std::vector<meshes::PressSample> shown = thinned(samples);
  chapter["shown"] = shown.size() < samples.size() ? std::to_string(shown.size()) : "";
  chapter["all"] = std::to_string(samples.size());
  chapter.tables["samples"] = sample_table(shown, over);
}

}  // namespace

std::string SampleColumn::label(const std::string& where) const {
  std::string text = unit.label(title + where);
  text.front() = char(std::tolower(text.front()));
  return text;
}

SampleColumn indentation() {
  return {"Indentation", &meshes::PressSample::indentation, shown_units().length};
}

std::vector<PlaneMotion> plane_motions(SampleRange samples) {
  using Sample = meshes::PressSample;
  constexpr ShownUnit degrees{"angle", "rad", "deg", "deg", degree_per_radian};
  std::vector<PlaneMotion> motions;
  if (std::ranges::adjacent_find(samples, moves_by(&Sample::lateral_displacement)) != samples.end())
    motions.push_back(
        {{"Lateral displacement", &Sample::lateral_displacement, shown_units().length},
         {"Lateral force", &Sample::lateral_force_x, shown_units().force}});
  if (std::ranges::adjacent_find(samples, moves_by(&Sample::twist)) != samples.end())
    motions.push_back({{"Twist", &Sample::twist, degrees},
                       {"Torque about the normal", &Sample::spin_torque, shown_units().torque}});
  return motions;
}

bool makes(SampleRange samples, const PlaneMotion& motion) {
  return std::ranges::any_of(plane_motions(samples), [&](const PlaneMotion& made) {
    return made.way.value == motion.way.value;
  });
}

std::vector<PlaneMotion> motions_of(const std::vector<RunContact>& runs) {
  std::vector<PlaneMotion> motions;
  for (const RunContact& run : runs)
    for (const PlaneMotion& motion : plane_motions(moved_along_plane(*run.response)))
      if (std::ranges::none_of(motions, [&](const PlaneMotion& known) {
            return known.way.value == motion.way.value;
          }))
        motions.push_back(motion);
  return motions;
}

void append_motions(const std::vector<RunContact>& runs, const char* lateral, const char* twist,
                    std::vector<Figure>& figures) {
  for (const PlaneMotion& motion : motions_of(runs)) {
    Panel panel{.x_label = motion.way.label(), .y_label = motion.load.label(), .key = above};
    for (const RunContact& run : runs)
      if (const auto moved = moved_along_plane(*run.response); makes(moved, motion))
        panel.series.push_back(curve(run.label, "", run.style, moved,
                                     in(motion.way.unit, motion.way.value),
                                     in(motion.load.unit, motion.load.value)));
    const bool turns = motion.way.value == &meshes::PressSample::twist;
    figures.push_back({turns ? twist : lateral, 760, 420, 1, {std::move(panel)}});
  }
}

SampleRange moved_along_plane(const meshes::PressResponse& response) {
  const SampleRange all = response.samples();
  std::size_t first = all.size(), end = 0;
  for (std::size_t i = 0; i + 1 < all.size(); ++i) {
    if (!moves_by(&meshes::PressSample::lateral_displacement)(all[i], all[i + 1]) &&
        !moves_by(&meshes::PressSample::twist)(all[i], all[i + 1]))
      continue;
    first = std::min(first, i);
    end = i + 2;
  }
  return end == 0 ? SampleRange() : all.subspan(first, end - first);
}

Table sample_table(SampleRange samples, const std::vector<SampleColumn>& over) {
  const ShownUnits& units = shown_units();
  using Sample = meshes::PressSample;
  const bool lateral = significant(samples, &Sample::lateral_force_x),
             turned = holds_a_turn(samples);
  const SampleColumn columns[] = {
      normal_force(),
      {"Estimated error", &Sample::force_error, units.force},
      {"Lateral force", &Sample::lateral_force_x, units.force, "along t1, "},
      {"Estimated error", &Sample::lateral_force_error, units.force, "of the lateral force, "},
      {"Torque about the normal", &Sample::spin_torque, units.torque},
      {"Contact radius", &Sample::contact_radius, units.length},
      {"Mean pressure", &Sample::mean_pressure, units.stress},
      {"Peak pressure", &Sample::max_pressure, units.stress}};
  const auto error_of = [](const SampleColumn& column, const Sample& sample) {
    if (column.value == &Sample::contact_radius) return sample.contact_radius_error;
    return column.value == &Sample::max_pressure ? sample.max_pressure_error : meshes::unknown;
  };
  Table table;
  table.rows.resize(samples.size());
  for (const SampleColumn& place : over) {
    table.header.emplace_back(place.title, unit_name(place.unit));
    for (std::size_t i = 0; i < samples.size(); ++i)
      table.rows[i].push_back(fmt::format("{:.4g}", place.unit(samples[i].*place.value)));
  }
  for (const SampleColumn& column : columns) {
    const bool aside =
        column.value == &Sample::lateral_force_x || column.value == &Sample::lateral_force_error;
    if (aside && !lateral) continue;
    if (column.value == &Sample::spin_torque && !turned) continue;
    table.header.emplace_back(column.title, column.direction + unit_name(column.unit));
    double largest = 0.0;
    for (const Sample& sample : samples)
      largest = std::fmax(largest, std::abs(sample.*column.value));
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double value = samples[i].*column.value;
      table.rows[i].push_back(amount_cell(std::abs(value) < noise * largest ? 0.0 : value,
                                          column.unit, error_of(column, samples[i])));
    }
  }
  table.drop_unknown(over.size());
  return table;
}

Chapter press_chapter(const meshes::PressResponse& response,
                      const std::vector<lattice::TraceRow>& trace) {
  if (response.empty()) return {};
  const SampleRange samples = response.pressing();
  const SampleColumn radius{"Contact radius", &meshes::PressSample::contact_radius,
                            shown_units().length};
  ChapterData chapter("press");
  Panel force = loop_panel(response, trace);
  chapter["error"] =
      std::ranges::any_of(force.series, [](const Series& series) { return !series.error.empty(); });
  chapter.figures = {{"force_indentation", 760, 420, 1, {std::move(force)}}};
  add_samples(chapter, samples, {indentation()});
  if (is_known(samples, radius))
    chapter.figures.push_back(
        {"contact_radius", 760, 340, 1, {curve_panel(samples, indentation(), radius)}});
  return written(std::move(chapter));
}

Chapter sliding_chapter(const meshes::PressResponse& response) {
  // From where the press ended, which is the first sample of both.
  const SampleRange samples = moved_along_plane(response);
  const std::vector<PlaneMotion> motions = plane_motions(samples);
  if (motions.empty()) return {};
  ChapterData chapter("sliding");
  chapter["free"] = false;
  chapter["depth"] = length(samples.front().indentation);
  std::vector<SampleColumn> over;
  for (const PlaneMotion& motion : motions) {
    over.push_back(motion.way);
    const bool twist = motion.way.value == &meshes::PressSample::twist;
    if (twist ? !holds_a_turn(samples) : !significant(samples, motion.load.value)) {
      chapter["free"] = true;
      continue;
    }
    Panel panel = curve_panel(samples, motion.way, motion.load);
    const Range range = extent_of(panel.series, &Series::x);
    panel.x_range = Range{std::min(0.0, range.from), std::max(0.0, range.to)};
    panel.y_range.reset();
    chapter.figures.push_back({twist ? "spin_torque" : "lateral_force", 760, 420, 1, {panel}});
  }
  add_samples(chapter, samples, over);
  return written(std::move(chapter));
}

std::string press_answer(const meshes::PressResponse& response, const PressSummary& summary) {
  TemplateData words;
  for (const char* name :
       {"depth", "force", "radius", "moved", "held", "turned", "turns", "push", "error", "largest"})
    words[name] = "";
  if (response.empty()) return sentences("answer_press", words);
  const meshes::PressSample& last = response.pressing().back();
  words["depth"] = length(last.indentation);
  words["force"] = force(last.normal_force);
  if (const auto& error = summary.force_error) {
    words["error"] = error->statement;
    if (std::isfinite(error->largest))
      words["largest"] =
          fmt::format("{:.2g} % at {}", 100.0 * error->largest, length(error->indentation));
  }
  if (last.contact_radius > 0.0) words["radius"] = length(last.contact_radius);
  if (const SampleRange moved = moved_along_plane(response); !moved.empty()) {
    const meshes::PressSample& end = moved.back();
    words["push"] = force(end.normal_force);
    for (const PlaneMotion& motion : plane_motions(moved)) {
      const bool twist = motion.way.value == &meshes::PressSample::twist;
      const std::string way = motion.way.unit.text(end.*motion.way.value);
      words[twist ? "turned" : "moved"] = way;
      if (twist ? holds_a_turn(moved) : significant(moved, motion.load.value))
        words[twist ? "turns" : "held"] = motion.load.unit.text(end.*motion.load.value);
    }
  }
  return sentences("answer_press", words);
}

Table modes_table(const std::vector<VibrationMode>& modes) {
  Table table{heads({"Mode", "Frequency\nHz", "Estimated error\nHz", "Motion", "Mass\nacross",
                     "Mass\nalong", "Inertia\nabout the axis"})};
  table.header[3].words = true;
  for (const VibrationMode& mode : modes)
    table.rows.push_back({std::to_string(mode.number), number(mode.frequency, 5),
                          number(mode.error, 2), prose(mode.motion),
                          percent_magnitude(mode.mass.x() + mode.mass.y()),
                          percent_magnitude(mode.mass.z()), percent_magnitude(mode.inertia)});
  table.drop_unknown(2);
  return table;
}

Chapter modes_chapter(const std::vector<VibrationMode>& modes) {
  if (modes.empty()) return {};
  Panel panel{.x_label = "mode",
              .y_label = "frequency [Hz]",
              .x_range = Range{0.5, double(modes.size()) + 0.5},
              .y_range = Range{0.0},
              .key = above};
  std::map<std::string, Series> kinds;
  for (const VibrationMode& mode : modes)
    kinds
        .try_emplace(mode.motion, Series{mode.motion, "", numbered_style(kinds.size()).as_points()})
        .first->second.add(mode.number, mode.frequency);
  for (auto& [name, series] : kinds) panel.series.push_back(std::move(series));
  ChapterData chapter("modes");
  chapter["lattice"] = modes.front().of_lattice;
  chapter.figures = {{"frequencies", 760, 380, 1, {panel}}};
  chapter.tables["modes"] = modes_table(modes);
  return written(std::move(chapter));
}

std::string modes_answer(const std::vector<VibrationMode>& modes) {
  if (modes.empty()) return "";
  const VibrationMode& first = modes.front();
  TemplateData words;
  words["first"] = number(first.frequency, 4);
  words["motion"] = first.motion;
  words["modes"] = std::to_string(modes.size());
  words["last"] = number(modes.back().frequency, 4);
  return sentences("answer_modes", words);
}

}  // namespace fingertip::studies::report::inline chapters::inline press
