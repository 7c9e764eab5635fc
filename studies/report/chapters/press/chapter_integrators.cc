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
      found = all.insert(all.end(), {name, "", style});
    }
    found->add(press->summary.steps.force_evaluations, 100.0 * press->change);
  }
  return all;
}

Figure cost_figure(const std::vector<MovingPress>& presses) {
  const Panel panel{.x_label = "force evaluations of the press [1]",
                    .y_label = "largest difference of the force [%]",
                    .series = cost_series(presses),
                    .log_x = 10,
                    .log_y = 10,
                    .key = "top right"};
  return {"cost_of_integrators", 820, 460, 1, {panel}};
}

Table cost_table(const std::vector<MovingPress>& presses) {
  double cheapest = meshes::unknown;
  for (const MovingPress& press : presses) cheapest = std::fmin(cheapest, press.summary.wall_time);
  Table table{heads({"Integrator", "Step or bound", "Steps", "rejected", "Force evaluations",
                     "Wall time\nquickest = 1", "Momentum balance", "Difference of the force"})};
  for (const MovingPress& press : presses) {
    const PressSummary& s = press.summary;
    table.rows.push_back({integrator_of(press),
                          setting_of(press),
                          count(s.steps.accepted),
                          count(s.steps.rejected),
                          count(s.steps.force_evaluations),
                          number(s.wall_time / cheapest, 3),
                          number(s.momentum_defect, 2),
                          {is_compared(press) ? percent_magnitude(press.change) : "–",
                           press.beside.empty() ? "the measure" : ""}});
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
  const MovingPress* best = largest_in(presses, [](const MovingPress& press) {
    return is_compared(press) ? -press.change : meshes::unknown;
  });
  TemplateData words;
  words["beside"] = best ? best->beside : "";
  words["press"] = best ? best->label : "";
  words["change"] = best ? percent_magnitude(best->change) : "";
  words["evaluations"] = best ? count(best->summary.steps.force_evaluations) : "";
  return sentences("answer_integrators", words);
}

Chapter integrators_chapter(const std::vector<MovingPress>& presses) {
  if (!compares_integrators(presses)) return {};
  ChapterData chapter("integrators");
  chapter.figures = {cost_figure(presses)};
  chapter.tables["costs"] = cost_table(presses);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline press
