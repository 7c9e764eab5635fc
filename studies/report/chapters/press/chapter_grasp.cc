/// Grasps of a rigid block: what grip force holds it, and how it slips.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/results/grasp_run.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

using lattice::GraspRow, lattice::GripPhase;

/// Rows of a phase.
struct Span {
  std::size_t begin = 0, end = 0;
};
Span phase_span(const GraspRun& grasp, GripPhase phase) {
  const auto first = std::ranges::find(grasp.rows, phase, &GraspRow::phase);
  const auto last = std::find_if(first, grasp.rows.end(),
                                 [&](const GraspRow& row) { return row.phase != phase; });
  return {std::size_t(first - grasp.rows.begin()), std::size_t(last - grasp.rows.begin())};
}

std::vector<double> part(const std::vector<double>& values, const Span& span, double factor = 1.0) {
  std::vector<double> some;
  for (std::size_t i = span.begin; i < span.end; ++i) some.push_back(factor * values[i]);
  return some;
}

std::vector<double> ratio(const std::vector<double>& values, const std::vector<double>& by,
                          double factor) {
  std::vector<double> result;
  for (std::size_t i = 0; i < values.size(); ++i) result.push_back(factor * values[i] / by[i]);
  return result;
}

std::vector<std::string> series_names(const std::vector<GraspRun>& grasps) {
  std::vector<std::string> names;
  for (const GraspRun& grasp : grasps)
    if (std::ranges::find(names, grasp.series) == names.end()) names.push_back(grasp.series);
  return names;
}

Style points_style(std::size_t i, bool filled) {
  Style style = numbered_style(i);
  style.point = filled ? 7 : 6;
  style.point_size = 1.0;
  style.line = false;
  return style;
}

/// How high the block came, against grip force over the limit; those that are released are held.
Figure fate_figure(const std::vector<GraspRun>& grasps) {
  Panel panel;
  panel.x_label = "grip force over m (g + a)/(2 mu), less 1 [%]";
  panel.y_label = "height of the block over the lift [1]";
  panel.key = "center right";
  panel.markers.push_back({0.0, "#444444"});
  std::size_t i = 0;
  for (const std::string& name : series_names(grasps)) {
    Series held{name + ": held", "", {}, {}, {}, points_style(i, true)};
    Series lost{name + ": lost", "", {}, {}, {}, points_style(i, false)};
    for (const GraspRun& grasp : grasps) {
      if (grasp.series != name || grasp.rows.empty() || !(grasp.limit() > 0.0)) continue;
      if (grasp.released()) continue;
      const Span hold = phase_span(grasp, GripPhase::hold);
      const std::vector<double> height = column(grasp.rows, &GraspRow::height);
      Series& series = grasp.held() ? held : lost;
      series.x.push_back(100.0 * (grasp.grip() / grasp.limit() - 1.0));
      const double reached = hold.end > hold.begin ? height[hold.end - 1] : height.back();
      series.y.push_back(reached / grasp.summary.lift_height);
    }
    for (const Series& series : {held, lost})
      if (!series.x.empty()) panel.series.push_back(series);
    ++i;
  }
  panel.y_range = Range{-0.1, 1.1};
  return {"grasp_fate", 820, 400, 1, {panel}};
}

/// Grip force against slip while the grip falls.
Figure release_figure(const std::vector<GraspRun>& released) {
  Panel panel;
  panel.x_label = shown_units().length.label("slip of the block along the fingers");
  panel.y_label = shown_units().force.label("grip force per finger");
  panel.key = "top right";
  double far = 0.0, highest = 0.0, lowest = shown_units().force(released.front().rest_limit());
  for (std::size_t i = 0; i < released.size(); ++i) {
    const GraspRun& grasp = released[i];
    const Span span = phase_span(grasp, GripPhase::release);
    Style style = numbered_style(i);
    style.point = 0;
    Series curve{grasp.label,
                 "",
                 part(column(grasp.rows, &GraspRow::slip), span, shown_units().length.factor),
                 part(grasp.normal(), span, shown_units().force.factor),
                 {},
                 style};
    const double slip_force = shown_units().force(grasp.summary.slip_force);
    Series onset{i + 1 == released.size() ? "all points slide" : "",
                 "all points slide",
                 {},
                 {},
                 {},
                 points_style(i, true)};
    for (std::size_t k = 0; k < curve.y.size(); ++k) {
      if (onset.x.empty() && curve.y[k] <= slip_force * (1.0 + 1e-9)) {
        onset.x = {curve.x[k]};
        onset.y = {curve.y[k]};
      }
    }
    far = std::max(far, largest_magnitude(curve.x));
    highest = std::max(highest, largest_magnitude(curve.y));
    lowest = std::min(lowest, curve.y.back());
    panel.series.push_back(std::move(curve));
    panel.series.push_back(std::move(onset));
  }
  const double limit = shown_units().force(released.front().rest_limit());
  panel.series.push_back(
      {"m g/(2 mu)", "", {0.0, far}, {limit, limit}, {}, {"#000000", "(4,4)", 1.2, 0, true}});
  panel.x_range = Range{0.0, far};
  panel.y_range = Range{lowest - 0.1 * (highest - lowest), highest + 0.1 * (highest - lowest)};
  return {"grasp_release", 820, 430, 1, {panel}};
}

/// What the points' friction is, and what of it adds up, over mu times the normal force.
Panel friction_panel(const GraspRun& grasp, const std::string& title, const std::string& x_label,
                     const std::vector<double>& x, const Span& span) {
  Panel panel;
  panel.title = title;
  panel.x_label = x_label;
  panel.y_label = "over mu n [1]";
  panel.key = "center right";
  const double per_mu = 1.0 / grasp.summary.friction;
  const std::vector<double> normal = grasp.normal();
  const auto curve = [&](const char* label, const std::vector<double>& force, std::size_t style) {
    Style look = numbered_style(style);
    look.point = 0;
    panel.series.push_back({label, "", x, part(ratio(force, normal, per_mu), span), {}, look});
  };
  curve("sum of the points' |t|", grasp.point_friction(), 0);
  curve("their resultant |t|", grasp.tangential(), 1);
  curve("toward the centre", grasp.inward_friction(), 2);
  panel.series[0].style.dash = "(9,5)";
  panel.series[1].style.dash.clear();
  panel.y_range = Range{-0.05, 1.08};
  return panel;
}

/// The last that grew its load in vain, and the last whose grip fell.
Figure friction_figure(const std::vector<GraspRun>& grasps) {
  Figure figure{"grasp_friction", 980, 400, 0, {}};
  const auto slid = std::find_if(grasps.rbegin(), grasps.rend(), [](const GraspRun& grasp) {
    return grasp.fate() == "not lifted" && std::isfinite(grasp.summary.slip_ratio);
  });
  if (slid != grasps.rend()) {
    const Span span = phase_span(*slid, GripPhase::load);
    figure.panels.push_back(friction_panel(
        *slid, "the load grows: " + slid->label, shown_units().length.label("rise of the fingers"),
        part(column(slid->rows, &GraspRow::finger_height), span, shown_units().length.factor),
        span));
  }
  const auto fell = std::find_if(grasps.rbegin(), grasps.rend(),
                                 [](const GraspRun& grasp) { return grasp.released(); });
  if (fell != grasps.rend()) {
    const Span span = phase_span(*fell, GripPhase::release);
    figure.panels.push_back(friction_panel(
        *fell, "the grip falls: " + fell->label, shown_units().length.label("slip of the block"),
        part(column(fell->rows, &GraspRow::slip), span, shown_units().length.factor), span));
    figure.panels.back().x_range = Range{0.0, 0.5};
    if (figure.panels.size() > 1) figure.panels.front().key.clear();  // they share a legend
  }
  figure.columns = int(figure.panels.size());
  return figure;
}

/// Forces and ways of one grasp.
Figure time_figure(const GraspRun& grasp) {
  const std::vector<double> time = column(grasp.rows, &GraspRow::time);
  const auto curve = [&](const char* label, const std::vector<double>& values, double factor,
                         std::size_t i) {
    Style style = numbered_style(i);
    style.point = 0;
    return Series{label, "", time, part(values, {0, values.size()}, factor), {}, style};
  };
  Panel forces, ways;
  forces.x_label = ways.x_label = "time [s]";
  forces.y_label = shown_units().force.label("force");
  ways.y_label = shown_units().length.label("way");
  forces.key = "bottom right";
  ways.key = "top left";
  forces.x_range = ways.x_range = Range{0.0, time.back()};
  const double limit = shown_units().force(grasp.rest_limit());
  forces.series = {
      curve("grip of each finger", grasp.normal(), shown_units().force.factor, 0),
      curve("tangential force of each finger", grasp.tangential(), shown_units().force.factor, 1)};
  if (limit > 0.0)  // there is none without Coulomb's friction
    forces.series.push_back({"m g/(2 mu)",
                             "",
                             {0.0, time.back()},
                             {limit, limit},
                             {},
                             {"#000000", "(4,4)", 1.2, 0, true}});
  ways.series = {curve("rise of the fingers", column(grasp.rows, &GraspRow::finger_height),
                       shown_units().length.factor, 0),
                 curve("rise of the block", column(grasp.rows, &GraspRow::height),
                       shown_units().length.factor, 1),
                 curve("indentation", column(grasp.rows, &GraspRow::indentation),
                       shown_units().length.factor, 2)};
  return {"grasp_in_time", 860, 620, 1, {forces, ways}};
}

/// "+1.2 %" of `value` against `wanted`.
std::string off(double value, double wanted) {
  return std::isfinite(value / wanted) ? percent(value / wanted - 1.0) : "–";
}

Table grasp_table(const std::vector<GraspRun>& grasps) {
  Table table;
  table.header = {plain("Grasp"),
                  plain("Grip force", unit_name(shown_units().force)),
                  plain("Over the limit", "m (g + a)/(2 mu)"),
                  plain("Fate"),
                  plain("Load", "over weight, less 1"),
                  plain("All slide from", unit_name(shown_units().force) + ", over m g/(2 mu)"),
                  plain("|t|/(mu n) there", "less 1"),
                  plain("at the end", "less 1"),
                  plain("Momentum balance")};
  for (const GraspRun& grasp : grasps) {
    const GraspSummary& s = grasp.summary;
    const double mu = s.friction, slip = s.slip_force;
    const bool fell = grasp.released() && std::isfinite(slip);
    table.rows.push_back(
        {plain(grasp.label, grasp.status == "finished" || grasp.status == "ok" ? "" : grasp.status),
         plain(number(shown_units().force(grasp.grip())), si_note(grasp.grip(), "N")),
         plain(off(grasp.grip(), grasp.limit())), plain(grasp.fate()), plain(off(s.held_load, 1.0)),
         fell ? plain(number(shown_units().force(slip)), off(slip, grasp.rest_limit()))
              : plain("–"),
         plain(off(s.slip_ratio, mu)), plain(off(s.sliding_ratio, mu)),
         plain(number(s.momentum_defect, 2))});
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
  Words words;
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

std::string grasp_text(const std::vector<GraspRun>& grasps) {
  std::string text = fmt::format("{:<36}{:>12}{:>12}{:>14}{:>14}{:>14}\n", "grasp",
                                 shown_units().force.label("grip"), "over limit", "fate",
                                 shown_units().force.label("slips at"), "t/(mu n) there");
  for (const GraspRun& grasp : grasps) {
    const double slip = shown_units().force(grasp.summary.slip_force);
    const double share = grasp.summary.slip_ratio / grasp.summary.friction;
    text +=
        fmt::format("{:<36}{:>12.4f}{:>10.2f} %{:>14}{:>14}{:>14}\n", grasp.label.substr(0, 35),
                    shown_units().force(grasp.grip()), 100.0 * (grasp.grip() / grasp.limit() - 1.0),
                    grasp.fate(), std::isfinite(slip) ? fmt::format("{:.4f}", slip) : "-",
                    std::isfinite(share) ? fmt::format("{:.4f}", share) : "-");
  }
  return text + "limit: m (g + a)/(2 mu)\n";
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
