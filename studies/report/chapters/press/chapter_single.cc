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

/// Rows of a table that a reader takes in; the figure and its CSV have every sample.
constexpr std::size_t most_rows = 20;

const Style single{"#0072B2", "", 2.2, 7, true};

using SampleRange = std::span<const meshes::PressSample>;

/// What the samples are ordered by.
struct SampleAxis {
  const char* title;
  double meshes::PressSample::*value;  ///< [m]
};
constexpr SampleAxis by_indentation{"Indentation", &meshes::PressSample::indentation};
constexpr SampleAxis by_displacement{"Lateral displacement",
                                     &meshes::PressSample::lateral_displacement};

/// From zero, where both begin, unless inertia pulls at the rod or it lifts off.
void begin_at_zero(Panel& panel) {
  const auto negative = [&](std::vector<double> Series::*values) {
    return std::ranges::any_of(panel.series, [&](const Series& series) {
      return std::ranges::any_of(series.*values, [](double value) { return value < 0.0; });
    });
  };
  panel.x_range.reset();
  panel.y_range.reset();
  if (!negative(&Series::x)) panel.x_range = Range{0.0, meshes::unknown};
  if (!negative(&Series::y)) panel.y_range = Range{0.0, meshes::unknown};
}

Panel curve_panel(SampleRange samples, const SampleAxis& axis, const char* title,
                  double meshes::PressSample::*value, const ShownUnit& unit) {
  Panel panel;
  panel.x_label = shown_units().length.label(axis.title);
  panel.x_label[0] = char(std::tolower(panel.x_label[0]));
  panel.y_label = unit.label(title);
  panel.key = "";
  Series series{"", "press", {}, {}, {}, single};
  if (samples.size() > most_rows) series.style.point = 0;
  for (const meshes::PressSample& sample : samples) {
    series.x.push_back(shown_units().length(sample.*axis.value));
    series.y.push_back(unit(sample.*value));
  }
  panel.series.push_back(std::move(series));
  begin_at_zero(panel);
  return panel;
}

/// Force of a whole program: the first loading, and then the way on from its end.
Panel loop_panel(const meshes::PressResponse& response,
                 const std::vector<lattice::TraceRow>& trace) {
  const SampleRange loading = response.pressing();
  Panel panel = curve_panel(loading, by_indentation, "normal force",
                            &meshes::PressSample::normal_force, shown_units().force);
  if (response.following().empty()) return panel;
  Series then{"then", "then", {}, {}, {}, {"#D55E00", "", 2.2, trace.empty() ? 7 : 0, true}};
  const auto add = [&then](double indentation, double force) {
    then.x.push_back(shown_units().length(indentation));
    then.y.push_back(shown_units().force(force));
  };
  add(loading.back().indentation, loading.back().normal_force);
  for (const lattice::TraceRow& row : trace)
    if (row.time > loading.back().time) add(row.indentation, row.normal_force);
  if (trace.empty())
    for (const meshes::PressSample& sample : response.following())
      add(sample.indentation, sample.normal_force);
  panel.series.front().label = "first loading";
  panel.series.push_back(std::move(then));
  panel.key = "top left";
  begin_at_zero(panel);
  return panel;
}

bool known(SampleRange samples, double meshes::PressSample::*value) {
  return std::ranges::any_of(
      samples, [value](const meshes::PressSample& sample) { return std::isfinite(sample.*value); });
}

/// A column of the samples' table.
struct Column {
  const char* title;
  const char* direction;
  double meshes::PressSample::*value;
  ShownUnit unit;
};

/// Whether a force is more than what solvers leave of the normal force.
bool significant(SampleRange samples, double meshes::PressSample::*force) {
  constexpr double left = 1e-7;
  return std::ranges::any_of(samples, [force](const meshes::PressSample& sample) {
    return std::abs(sample.*force) > left * std::abs(sample.normal_force);
  });
}

Table sample_table(SampleRange samples, const SampleAxis& axis) {
  const ShownUnits& units = shown_units();
  const Column columns[] = {
      {"Normal force", "", &meshes::PressSample::normal_force, units.force},
      {"Estimated error", "", &meshes::PressSample::force_error, units.force},
      {"Lateral force", "along t1, ", &meshes::PressSample::lateral_force_x, units.force},
      {"Contact radius", "", &meshes::PressSample::contact_radius, units.length},
      {"Peak pressure", "", &meshes::PressSample::max_pressure, units.stress}};
  Table table;
  table.header = {plain(axis.title, unit_name(units.length))};
  std::vector<Column> shown;
  for (const Column& column : columns) {
    if (!known(samples, column.value)) continue;
    if (column.value == &meshes::PressSample::lateral_force_x &&
        !significant(samples, column.value))
      continue;
    shown.push_back(column);
    table.header.push_back(plain(column.title, column.direction + unit_name(column.unit)));
  }
  // Every 2nd, 5th, 10th ... so that depths stay round, and the last one is among them.
  std::size_t every = 1;
  for (const std::size_t step : {2, 5, 10, 20, 50, 100, 200, 500, 1000})
    if ((samples.size() + every - 1) / every > most_rows) every = step;
  for (std::size_t i = (samples.size() - 1) % every; i < samples.size(); i += every) {
    const auto& sample = samples[i];
    std::vector<Cell> row{plain(fmt::format("{:.4g}", units.length(sample.*axis.value)))};
    for (const Column& column : shown) {
      const double value = sample.*column.value;
      row.push_back(std::isnan(value) ? plain("–")
                                      : plain(number(column.unit(value)),
                                              si_note(value, std::string(column.unit.si))));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

void add_samples(ChapterData& chapter, SampleRange samples, const SampleAxis& axis) {
  Table table = sample_table(samples, axis);
  const std::size_t rows = table.rows.size();
  chapter["shown"] = rows < samples.size() ? std::to_string(rows) : "";
  chapter["all"] = std::to_string(samples.size());
  chapter.tables["samples"] = std::move(table);
}

/// Pressure of the points on the plane against their distance from the contact's centre, and the
/// peak that is told at that depth.
Figure pressure_figure(const std::vector<ContactRow>& contact, const meshes::PressSample& last) {
  double weight = 0.0;
  meshes::Vector3 sum = meshes::Vector3::Zero();
  for (const ContactRow& point : contact) {
    const double force = std::max(point.pressure, 0.0);
    weight += force, sum += force * point.deformed;
  }
  // A quarter or half of a contact has its centre on the mirror planes.
  const auto centre = [&](int axis) {
    const bool cut = std::ranges::all_of(
        contact, [&](const ContactRow& point) { return point.deformed[axis] >= 0.0; });
    return cut || !(weight > 0.0) ? 0.0 : sum[axis] / weight;
  };
  const double cx = centre(0), cy = centre(1);
  Panel panel;
  panel.x_label = shown_units().length.label("distance from the contact's centre");
  panel.y_label = shown_units().stress.label("pressure");
  panel.key = "";
  Series series{"", "points", {}, {}, {}, {"#0072B2", "", 1.0, 7, false, 0.45}};
  for (const ContactRow& point : contact) {
    if (!(point.pressure > 0.0)) continue;
    series.x.push_back(
        shown_units().length(std::hypot(point.deformed.x() - cx, point.deformed.y() - cy)));
    series.y.push_back(shown_units().stress(point.pressure));
  }
  panel.series.push_back(std::move(series));
  if (!std::isnan(last.max_pressure)) {
    const double peak = shown_units().stress(last.max_pressure);
    panel.series.push_back({"peak pressure as told",
                            "",
                            {0.0, shown_units().length(last.contact_radius)},
                            {peak, peak},
                            {},
                            {"#333333", "(7,4)", 1.6, 0, true}});
    panel.key = "top right";
  }
  panel.x_range = Range{0.0, meshes::unknown};
  return {"contact_pressure", 760, 380, 1, {panel}};
}

}  // namespace

Chapter press_chapter(const meshes::PressResponse& response, const std::vector<ContactRow>& contact,
                      const std::vector<lattice::TraceRow>& trace) {
  if (response.empty()) return {};
  const SampleRange samples = response.pressing();
  ChapterData chapter("press");
  chapter.figures = {{"force_indentation", 760, 420, 1, {loop_panel(response, trace)}}};
  add_samples(chapter, samples, by_indentation);
  if (known(samples, &meshes::PressSample::contact_radius))
    chapter.figures.push_back(
        {"contact_radius",
         760,
         340,
         1,
         {curve_panel(samples, by_indentation, "contact radius",
                      &meshes::PressSample::contact_radius, shown_units().length)}});
  if (!contact.empty()) chapter.figures.push_back(pressure_figure(contact, samples.back()));
  return written(std::move(chapter));
}

Chapter sliding_chapter(const meshes::PressResponse& response) {
  if (response.sliding().empty()) return {};
  // From where the press ended, which is the first sample of both.
  const SampleRange samples =
      SampleRange(response.samples()).subspan(response.pressing().size() - 1);
  const bool free = !significant(samples, &meshes::PressSample::lateral_force_x);
  ChapterData chapter("sliding");
  chapter["free"] = free;
  chapter["depth"] = length(response.depth());
  add_samples(chapter, samples, by_displacement);
  if (!free) {
    Panel panel = curve_panel(samples, by_displacement, "lateral force",
                              &meshes::PressSample::lateral_force_x, shown_units().force);
    const double end = shown_units().length(samples.back().lateral_displacement);
    panel.x_range = Range{std::min(0.0, end), std::max(0.0, end)};
    chapter.figures = {{"lateral_force", 760, 420, 1, {panel}}};
  }
  return written(std::move(chapter));
}

std::string press_answer(const meshes::PressResponse& response) {
  Words words;
  for (const char* name : {"depth", "force", "radius", "moved", "held", "push"}) words[name] = "";
  if (response.empty()) return sentences("answer_press", words);
  const meshes::PressSample& last = response.pressing().back();
  words["depth"] = length(last.indentation);
  words["force"] = force(last.normal_force);
  if (last.contact_radius > 0.0) words["radius"] = length(last.contact_radius);
  if (!response.sliding().empty()) {
    const meshes::PressSample& end = response.sliding().back();
    words["moved"] = length(end.lateral_displacement);
    words["push"] = force(end.normal_force);
    if (significant(response.sliding(), &meshes::PressSample::lateral_force_x))
      words["held"] = force(end.lateral_force_x);
  }
  return sentences("answer_press", words);
}

Chapter modes_chapter(const std::vector<VibrationMode>& modes) {
  if (modes.empty()) return {};
  const bool lattice = modes.front().of_lattice;
  const bool errors = std::ranges::any_of(
      modes, [](const VibrationMode& mode) { return std::isfinite(mode.error); });
  Panel panel;
  panel.x_label = "mode";
  panel.y_label = "frequency [Hz]";
  panel.key = "outside top center horizontal";
  panel.x_range = Range{0.5, double(modes.size()) + 0.5};
  panel.y_range = Range{0.0, meshes::unknown};
  std::map<std::string, Series> kinds;
  Table table;
  table.header = {plain("Mode"), plain("Frequency", "Hz")};
  if (errors) table.header.push_back(plain("Estimated error", "Hz"));
  table.header.push_back({"Motion", "", Grade::none, true});
  if (lattice)
    for (const auto& [what, note] : {std::pair{"Mass", "across"}, std::pair{"Mass", "along"},
                                     std::pair{"Inertia", "about the axis"}})
      table.header.push_back(plain(what, note));
  for (const VibrationMode& mode : modes) {
    auto [kind, fresh] = kinds.try_emplace(mode.motion);
    if (fresh) {
      kind->second.label = mode.motion;
      kind->second.style = numbered_style(kinds.size() - 1);
      kind->second.style.line = false;
    }
    kind->second.x.push_back(mode.number);
    kind->second.y.push_back(mode.frequency);
    std::vector<Cell> row{plain(std::to_string(mode.number)), plain(number(mode.frequency, 5))};
    if (errors) row.push_back(plain(number(mode.error, 2)));
    row.push_back({mode.motion, "", Grade::none, true});
    if (lattice) {
      row.push_back(plain(percent_magnitude(mode.mass.x() + mode.mass.y())));
      row.push_back(plain(percent_magnitude(mode.mass.z())));
      row.push_back(plain(percent_magnitude(mode.inertia)));
    }
    table.rows.push_back(std::move(row));
  }
  for (auto& [name, series] : kinds) panel.series.push_back(std::move(series));
  ChapterData chapter("modes");
  chapter["lattice"] = lattice;
  chapter.figures = {{"frequencies", 760, 380, 1, {panel}}};
  chapter.tables["modes"] = std::move(table);
  return written(std::move(chapter));
}

std::string modes_answer(const std::vector<VibrationMode>& modes) {
  if (modes.empty()) return "";
  const VibrationMode& first = modes.front();
  Words words;
  words["first"] = number(first.frequency, 4);
  words["motion"] = first.motion;
  words["modes"] = std::to_string(modes.size());
  words["last"] = number(modes.back().frequency, 4);
  return sentences("answer_modes", words);
}

}  // namespace fingertip::studies::report::inline chapters::inline press
