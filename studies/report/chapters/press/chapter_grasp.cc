/// Grasps of a rigid block: what grip force holds it, and how it slips.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/results/grasp_run.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

using lattice::GraspRow, lattice::GripPhase;
using Rows = std::span<const GraspRow>;

Rows rows_of(const GraspRun& grasp, GripPhase phase) {
  const auto first = std::ranges::find(grasp.rows, phase, &GraspRow::phase);
  const auto last = std::find_if(first, grasp.rows.end(),
                                 [&](const GraspRow& row) { return row.phase != phase; });
  return {first, last};
}

/// Of the two fingers, per row.
auto mean(std::array<double, 2> GraspRow::*quantity) {
  return
      [quantity](const GraspRow& row) { return 0.5 * ((row.*quantity)[0] + (row.*quantity)[1]); };
}

Style points_style(std::size_t i, bool filled) {
  Style style = numbered_style(i).as_points(filled ? 7 : 6);
  style.point_size = 1.0;
  return style;
}

Series line_at(double height, double to, const std::string& label) {
  return {label, "", {"#000000", "(4,4)", 1.2}, {0.0, to}, {height, height}};
}

/// How high the block came, against grip force over the limit; those that are released are held.
Figure fate_figure(const std::vector<GraspRun>& grasps) {
  Panel panel{.x_label = "grip force over m (g + a)/(2 mu), less 1 [%]",
              .y_label = "height of the block over the lift [1]",
              .y_range = Range{-0.1, 1.1},
              .markers = {{0.0, "#444444"}},
              .key = "center right"};
  std::size_t i = 0;
  for (const std::string& name : distinct(grasps, &GraspRun::series)) {
    Series held{name + ": held", "", points_style(i, true)};
    Series lost{name + ": lost", "", points_style(i++, false)};
    for (const GraspRun& grasp : grasps) {
      if (grasp.series != name || grasp.rows.empty() || !(grasp.limit() > 0.0)) continue;
      if (grasp.released()) continue;
      const Rows hold = rows_of(grasp, GripPhase::hold);
      const double reached = (hold.empty() ? grasp.rows.back() : hold.back()).height;
      (grasp.held() ? held : lost)
          .add(100.0 * (grasp.grip() / grasp.limit() - 1.0), reached / grasp.summary.lift_height);
    }
    for (const Series& series : {held, lost})
      if (!series.x.empty()) panel.series.push_back(series);
  }
  return {"grasp_fate", 820, 400, 1, {panel}};
}

/// Grip force against slip while the grip falls.
Figure release_figure(const std::vector<GraspRun>& released) {
  const ShownUnit &length = shown_units().length, &force = shown_units().force;
  Panel panel{.x_label = length.label("slip of the block along the fingers"),
              .y_label = force.label("grip force per finger"),
              .key = "top right"};
  const double limit = force(released.front().rest_limit());
  Range forces{limit, 0.0};
  double far = 0.0;
  for (std::size_t i = 0; i < released.size(); ++i) {
    const GraspRun& grasp = released[i];
    const Series fall =
        curve(grasp.label, "", numbered_style(i).as_line(), rows_of(grasp, GripPhase::release),
              in(length, &GraspRow::slip), in(force, mean(&GraspRow::normal)));
    Series onset{i + 1 == released.size() ? "all points slide" : "", "all points slide",
                 points_style(i, true)};
    const double slip_force = force(grasp.summary.slip_force) * (1.0 + 1e-9);
    const auto first = std::ranges::find_if(fall.y, [&](double y) { return y <= slip_force; });
    if (first != fall.y.end()) onset.add(fall.x[std::size_t(first - fall.y.begin())], *first);
    far = std::max(far, largest_magnitude(fall.x));
    forces.to = std::max(forces.to, largest_magnitude(fall.y));
    forces.from = std::min(forces.from, fall.y.back());
    panel.series.push_back(fall);
    panel.series.push_back(onset);
  }
  panel.series.push_back(line_at(limit, far, "m g/(2 mu)"));
  panel.x_range = Range{0.0, far};
  const double margin = 0.1 * (forces.to - forces.from);
  panel.y_range = Range{forces.from - margin, forces.to + margin};
  return {"grasp_release", 820, 430, 1, {panel}};
}

/// What the points' friction is, and what of it adds up, over mu times the normal force.
Panel friction_panel(const GraspRun& grasp, GripPhase phase, const std::string& title,
                     const std::string& x_label, double GraspRow::*x) {
  const ShownUnit& length = shown_units().length;
  Panel panel{.title = title + grasp.label,
              .x_label = length.label(x_label),
              .y_label = "over mu n [1]",
              .y_range = Range{-0.05, 1.08},
              .key = "center right"};
  const auto add = [&](const char* label, std::array<double, 2> GraspRow::*force,
                       const std::string& dash) {
    Style style = numbered_style(panel.series.size()).as_line();
    style.dash = dash;
    panel.series.push_back(
        curve(label, "", style, rows_of(grasp, phase), in(length, x), [&](const GraspRow& row) {
          return 1.0 / grasp.summary.friction * mean(force)(row) / mean(&GraspRow::normal)(row);
        }));
  };
  add("sum of the points' |t|", &GraspRow::point_friction, "(9,5)");
  add("their resultant |t|", &GraspRow::tangential, "");
  add("toward the centre", &GraspRow::inward_friction, numbered_style(2).dash);
  return panel;
}

/// The last that grew its load in vain, and the last whose grip fell.
Figure friction_figure(const std::vector<GraspRun>& grasps) {
  Figure figure{"grasp_friction", 980, 400, 0, {}};
  const auto slid = std::find_if(grasps.rbegin(), grasps.rend(), [](const GraspRun& grasp) {
    return grasp.fate() == "not lifted" && std::isfinite(grasp.summary.slip_ratio);
  });
  if (slid != grasps.rend())
    figure.panels.push_back(friction_panel(*slid, GripPhase::load, "the load grows: ",
                                           "rise of the fingers", &GraspRow::finger_height));
  const auto fell = std::find_if(grasps.rbegin(), grasps.rend(), std::mem_fn(&GraspRun::released));
  if (fell != grasps.rend()) {
    figure.panels.push_back(friction_panel(
        *fell, GripPhase::release, "the grip falls: ", "slip of the block", &GraspRow::slip));
    figure.panels.back().x_range = Range{0.0, 0.5};
    if (figure.panels.size() > 1) figure.panels.front().key.clear();  // they share a legend
  }
  figure.columns = int(figure.panels.size());
  return figure;
}

/// Forces and ways of one grasp.
Figure time_figure(const GraspRun& grasp) {
  const ShownUnit &length = shown_units().length, &force = shown_units().force;
  const double end = grasp.rows.back().time, limit = force(grasp.rest_limit());
  Panel forces{.x_label = "time [s]", .y_label = force.label("force"), .key = "bottom right"};
  Panel ways{.x_label = "time [s]", .y_label = length.label("way")};
  forces.x_range = ways.x_range = Range{0.0, end};
  const auto add = [&](Panel& panel, const char* label, const auto& value) {
    panel.series.push_back(curve(label, "", numbered_style(panel.series.size()).as_line(),
                                 grasp.rows, &GraspRow::time, value));
  };
  add(forces, "grip of each finger", in(force, mean(&GraspRow::normal)));
  add(forces, "tangential force of each finger", in(force, mean(&GraspRow::tangential)));
  // There is none without Coulomb's friction.
  if (limit > 0.0) forces.series.push_back(line_at(limit, end, "m g/(2 mu)"));
  add(ways, "rise of the fingers", in(length, &GraspRow::finger_height));
  add(ways, "rise of the block", in(length, &GraspRow::height));
  add(ways, "indentation", in(length, &GraspRow::indentation));
  return {"grasp_in_time", 860, 620, 1, {forces, ways}};
}

/// "+1.2 %" of `value` against `wanted`.
std::string off(double value, double wanted) {
  return percent(value / wanted - 1.0);
}

Table grasp_table(const std::vector<GraspRun>& grasps) {
  const ShownUnit& force = shown_units().force;
  Table table{heads({"Grasp", "Grip force\n" + unit_name(force), "Over the limit\nm (g + a)/(2 mu)",
                     "Fate", "Load\nover weight, less 1",
                     "All slide from\n" + unit_name(force) + ", over m g/(2 mu)",
                     "|t|/(mu n) there\nless 1", "at the end\nless 1", "Momentum balance"})};
  for (const GraspRun& grasp : grasps) {
    const GraspSummary& s = grasp.summary;
    table.rows.push_back(
        {{grasp.label, trouble(grasp.status)},
         amount_cell(grasp.grip(), force),
         off(grasp.grip(), grasp.limit()),
         grasp.fate(),
         off(s.held_load, 1.0),
         grasp.released() ? Cell(number(force(s.slip_force)), off(s.slip_force, grasp.rest_limit()))
                          : Cell("–"),
         off(s.slip_ratio, s.friction),
         off(s.sliding_ratio, s.friction),
         number(s.momentum_defect, 2)});
  }
  return table;
}

std::vector<GraspRun> released_of(const std::vector<GraspRun>& grasps) {
  std::vector<GraspRun> some;
  for (const GraspRun& grasp : grasps)
    if (grasp.released()) some.push_back(grasp);
  return some;
}

}  // namespace

std::string grasp_answer(const std::vector<GraspRun>& grasps) {
  double weakest = meshes::unknown, strongest = meshes::unknown;
  for (const GraspRun& grasp : grasps) {
    const double surplus = grasp.grip() / grasp.limit() - 1.0;
    if (grasp.held())
      weakest = std::fmin(weakest, surplus);
    else if (!grasp.fate().empty())
      strongest = std::fmax(strongest, surplus);
  }
  const std::vector<GraspRun> released = released_of(grasps);
  TemplateData words;
  words["single"] = grasps.size() == 1;
  words["fate"] = grasps.empty() ? "" : grasps.front().fate();
  words["weakest"] = if_known(weakest, percent(weakest));
  words["strongest"] = if_known(strongest, percent(strongest));
  words["slip"] = words["label"] = "";
  if (!released.empty()) {
    const GraspRun& last = released.back();
    words["slip"] = off(last.summary.slip_force, last.rest_limit());
    words["label"] = last.label;
  }
  return sentences("answer_grasp", words);
}

Chapter grasp_chapter(const std::vector<GraspRun>& grasps) {
  if (grasps.empty()) return {};
  const std::vector<GraspRun> released = released_of(grasps);
  const GraspRun& shown = released.empty() ? grasps.back() : released.back();
  ChapterData chapter("grasp");
  chapter["shown"] = shown.label;
  chapter.figures = {friction_figure(grasps)};
  if (grasps.size() > 1) chapter.figures.push_back(fate_figure(grasps));
  if (!released.empty()) chapter.figures.push_back(release_figure(released));
  if (!shown.rows.empty()) chapter.figures.push_back(time_figure(shown));
  chapter.tables["grasps"] = grasp_table(grasps);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
