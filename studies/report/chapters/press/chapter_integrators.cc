/// Cost of integrators against the error of the force.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/page/words.h"
#include "studies/report/results/moving_press.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

/// What stands before the comma of "symplectic-euler, 1 us", and after it.
std::string integrator_of(const MovingPress& press) {
  return press.label.substr(0, press.label.find(", "));
}
std::string setting_of(const MovingPress& press) {
  const std::size_t comma = press.label.find(", ");
  return comma == std::string::npos ? "" : press.label.substr(comma + 2);
}

bool is_compared(const MovingPress& press) {
  return !press.beside.empty() && std::isfinite(press.change);
}

/// A curve per integrator, its points by increasing cost.
std::vector<Series> cost_series(const std::vector<MovingPress>& presses) {
  std::vector<Series> all;
  std::vector<const MovingPress*> sorted;
  for (const MovingPress& press : presses)
    if (is_compared(press)) sorted.push_back(&press);
  std::ranges::stable_sort(
      sorted, {}, [](const MovingPress* press) { return press->summary.steps.force_evaluations; });
  for (const MovingPress* press : sorted) {
    const std::string name = integrator_of(*press);
    auto found = std::ranges::find(all, name, &Series::label);
    if (found == all.end()) {
      Style style = press->style;
      style.point = 7 + 2 * int(all.size());
      style.point_size = 0.9;
      found = all.insert(all.end(), Series{name, "", {}, {}, {}, style});
    }
    found->x.push_back(press->summary.steps.force_evaluations);
    found->y.push_back(100.0 * press->change);
  }
  return all;
}

Figure cost_figure(const std::vector<MovingPress>& presses) {
  Panel panel;
  panel.x_label = "force evaluations of the press [1]";
  panel.y_label = "largest difference of the force [%]";
  panel.log_x = panel.log_y = 10;
  panel.key = "top right";
  panel.series = cost_series(presses);
  return {"cost_of_integrators", 820, 460, 1, {panel}};
}

Table cost_table(const std::vector<MovingPress>& presses) {
  double cheapest = meshes::unknown;
  for (const MovingPress& press : presses) cheapest = std::fmin(cheapest, press.summary.wall_time);
  Table table;
  table.header = {plain("Integrator"),
                  plain("Step or bound"),
                  plain("Steps"),
                  plain("rejected"),
                  plain("Force evaluations"),
                  plain("Wall time", "quickest = 1"),
                  plain("Momentum balance"),
                  plain("Difference of the force")};
  for (const MovingPress& press : presses) {
    const double wall = press.summary.wall_time;
    table.rows.push_back(
        {plain(integrator_of(press)), plain(setting_of(press)),
         plain(count(press.summary.steps.accepted)), plain(count(press.summary.steps.rejected)),
         plain(count(press.summary.steps.force_evaluations)), plain(number(wall / cheapest, 3)),
         plain(number(press.summary.momentum_defect, 2)),
         plain(is_compared(press) ? percent_magnitude(press.change) : "–",
               press.beside.empty() ? "the measure" : "")});
  }
  return table;
}

}  // namespace

bool compares_integrators(const std::vector<MovingPress>& presses) {
  return !presses.empty() && std::ranges::all_of(presses, [](const MovingPress& press) {
    return press.summary.mode == "quasi-static";
  });
}

std::string integrators_answer(const std::vector<MovingPress>& presses) {
  const MovingPress* best = nullptr;
  for (const MovingPress& press : presses)
    if (is_compared(press) && (!best || press.change < best->change)) best = &press;
  Words words;
  words["beside"] = best ? best->beside : "";
  words["press"] = best ? best->label : "";
  words["change"] = best ? percent_magnitude(best->change) : "";
  words["evaluations"] = best ? count(best->summary.steps.force_evaluations) : "";
  return sentences("answer_integrators", words);
}

std::string integrators_text(const std::vector<MovingPress>& presses) {
  std::string text = fmt::format("{:<36}{:>12}{:>12}{:>16}{:>14}\n", "press", "steps", "rejected",
                                 "evaluations", "difference");
  for (const MovingPress& press : presses)
    text += fmt::format("{:<36}{:>12}{:>12}{:>16}{:>14}\n", press.label.substr(0, 35),
                        press.summary.steps.accepted, press.summary.steps.rejected,
                        press.summary.steps.force_evaluations,
                        is_compared(press) ? fmt::format("{:.4f} %", 100.0 * press.change) : "-");
  return text + "largest difference of the normal force from the press compared with\n";
}

Chapter integrators_chapter(const std::vector<MovingPress>& presses) {
  if (!compares_integrators(presses)) return {};
  ChapterData chapter("integrators");
  chapter.figures = {cost_figure(presses)};
  chapter.tables["costs"] = cost_table(presses);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
