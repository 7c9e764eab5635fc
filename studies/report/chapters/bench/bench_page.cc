#include "studies/report/chapters/bench/bench_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "studies/report/figure/figure.h"
#include "studies/report/figure/format.h"
#include "studies/report/page/words.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::report::inline chapters::inline bench {
namespace {

/// Worst error that counts as accurate [%], and the factor from which on a press is in real time.
constexpr double accurate = 2.0, real_time = 1.0;

constexpr const char* usual_integrator = "symplectic-euler";

/// What one core of its own would give, where that was measured.
double pace_of(const JsonEntry& press) {
  const double processor = number_if_any(press, "real_time_factor_processor");
  return std::isfinite(processor) ? processor : number_if_any(press, "real_time_factor");
}

/// Colour tells the model, the marker the integrator: circles for plain steps, triangles for scaled
/// masses, upside down of the whole tip; hollow where something else than one core against law A is
/// meant.
struct Family {
  std::string label, model, integrator, error_key;
  double threads = 1.0;
  bool hollow = false;
  double label_height = 0.84;  ///< where "R/n" is written, over the point's error; 0: nowhere
  bool whole = false;
};

/// The presses of a family, each point with its R/n.
void add_family(Panel& panel, const JsonEntry& bench, const Family& family) {
  const bool usual = family.integrator == usual_integrator;
  Style style = model_style(family.model);
  style.point = (family.whole ? 11 : usual ? 7 : 9) - (family.hollow ? 1 : 0);
  style.point_size = usual ? 0.9 : 1.2;
  style.dash = family.hollow ? "(2,4)" : usual ? "" : "(8,4)";
  style.width = family.hollow ? 1.4 : 2.2;
  Series series{family.label, "", style};
  for (const JsonEntry& press : array_if_any(bench, "press")) {
    if (text_if_any(press, "model") != family.model ||
        text_if_any(press, "integrator") != family.integrator ||
        number_if_any(press, "threads") != family.threads ||
        press.at("whole").flag() != family.whole)
      continue;
    const double error = 100.0 * number_if_any(press, family.error_key), pace = pace_of(press);
    if (!std::isfinite(error) || !std::isfinite(pace)) continue;
    series.add(pace, error);
    if (family.label_height > 0.0)
      panel.texts.push_back(
          {pace, family.label_height * error,
           fmt::format("R/{:.0f}", 1.0 / number_if_any(press, "spacing_over_R"))});
  }
  if (!series.x.empty()) panel.series.push_back(std::move(series));
}

void add_lattices(Panel& panel, const JsonEntry& bench) {
  const char *usual = usual_integrator, *scaled = "mass-scaled";
  constexpr double above = 1.22;
  const char *law_a = "worst_force_error", *small = "worst_force_error_small_strain";
  add_family(panel, bench, {"network", "network", usual, law_a});
  add_family(panel, bench, {"network, scaled masses", "network", scaled, law_a, 1.0, false, above});
  add_family(panel, bench,
             {"… on two cores (wall clock)", "network", scaled, law_a, 2.0, true, 0.0});
  add_family(panel, bench,
             {"… the whole tip (one core)", "network", scaled, law_a, 1.0, true, 0.0, true});
  add_family(panel, bench, {"hookean", "hookean", usual, law_a, 1.0, false, above});
  add_family(panel, bench, {"… against small strain", "hookean", usual, small, 1.0, true, 0.0});
  add_family(panel, bench,
             {"… against it, scaled masses", "hookean", scaled, small, 1.0, true, 0.0});
  add_family(panel, bench, {"published (1996)", "published", usual, law_a});
}

/// Each point with its number of unknowns.
void add_continua(Panel& panel, const JsonEntry& bench) {
  std::map<int, Series> by_degree;
  for (const JsonEntry& entry : array_if_any(bench, "continua")) {
    const double error = 100.0 * number_if_any(entry, "worst_force_error");
    const double pace = number_if_any(entry, "real_time_factor");
    if (!std::isfinite(error) || !std::isfinite(pace)) continue;
    const int degree = int(number_if_any(entry, "degree"));
    Series& series = by_degree[degree];
    series.label = fmt::format("quasi-static FEM, Q{}, unknowns", degree);
    series.style = {"#000000", degree == 1 ? "(6,3)" : "", 1.8, degree == 1 ? 4 : 5, true, 0.9};
    series.add(pace, error);
    panel.texts.push_back({pace, 1.22 * error, count(number_if_any(entry, "unknowns"))});
  }
  for (auto& [degree, series] : by_degree) panel.series.push_back(std::move(series));
}

/// The corner that every press should be in, behind everything else.
void add_target(Panel& panel) {
  const Range x = {real_time, panel.x_range->to}, y = {panel.y_range->from, accurate};
  Series corner{"",
                "target",
                {"#E69F00"},
                {x.from, x.to, x.to, x.from, x.from},
                {y.from, y.from, y.to, y.to, y.from}};
  corner.filled = true;
  panel.series.insert(panel.series.begin(), corner);
  panel.texts.push_back({std::sqrt(x.from * x.to), 1.25 * y.from, "2 %, real time"});
}

/// The range of logarithmic data with room at both ends, and `include` in it.
Range roomy(Range range, double include) {
  range.include(include);
  return {range.from / 1.6, range.to * 1.6};
}

/// Error of the force against the real-time factor: every way of simulating the press.
Figure pace_figure(const JsonEntry& bench) {
  Panel panel{
      .x_label = "real-time factor in the slowest 10 ms [1]",
      .y_label = fmt::format("largest force error, {} to {} [%]", shown_units().length.text(1e-3),
                             shown_units().length.text(3e-3)),
      .markers = {{real_time, "#444444"}},
      .log_x = 10,
      .log_y = 10,
      .key = "outside right top"};
  add_lattices(panel, bench);
  add_continua(panel, bench);
  if (panel.series.empty()) return {"pace", 0, 0, 1, {}};
  panel.x_range = roomy(extent_of(panel.series, &Series::x), real_time);
  panel.x_range->to = std::fmax(panel.x_range->to, 10.0 * real_time);
  panel.y_range = roomy(extent_of(panel.series, &Series::y), accurate);
  panel.y_range->from = std::fmin(panel.y_range->from, 0.25 * accurate);
  add_target(panel);
  return {"pace", 940, 540, 1, {panel}};
}

std::string spacing_text(const JsonEntry& press) {
  return fmt::format("R/{:.3g}", 1.0 / number_if_any(press, "spacing_over_R"));
}

bool is_scaled(const JsonEntry& press) {
  return text_if_any(press, "integrator") == "mass-scaled";
}

/// One rank of LAMMPS in its largest cube [ns per spring and step].
double lammps_cost(const JsonEntry& bench) {
  double cost = meshes::unknown, masses = 0.0;
  for (const JsonEntry& peer : array_if_any(bench, "peers")) {
    const double size = number_if_any(peer, "masses");
    if (text_if_any(peer, "name") != "lammps_harmonic" || number_if_any(peer, "threads") != 1.0 ||
        !(size > masses))
      continue;
    masses = size;
    cost = number_if_any(peer, "ns_per_spring_step");
  }
  return cost;
}

Table press_table(const JsonEntry& bench) {
  Table table{heads({"Lattice\nstrain, steps", "a\nmasses", "Of the tip", "Threads",
                     "Real-time factor\nprocessor time", "… in LAMMPS' springs", "Force error",
                     "… at rest", "… small strain", "Steps\nlongest", "Per mass and step"}),
              true};
  const double in_lammps = lammps_cost(bench);
  for (const JsonEntry& press : array_if_any(bench, "press")) {
    const double processor = number_if_any(press, "real_time_factor_processor"),
                 parts = number_if_any(press, "parts"), step = number_if_any(press, "time_step");
    table.rows.push_back(
        {{text_if_any(press, "model"), text_if_any(press, "kinematics") + " strain" +
                                           (is_scaled(press) ? ", scaled masses" : "")},
         {spacing_text(press), count(number_if_any(press, "particles"))},
         parts == 1.0 ? "all" : "1/" + count(parts),
         count(number_if_any(press, "threads")),
         {number(number_if_any(press, "real_time_factor"), 3),
          if_known(processor, number(processor, 3))},
         if_known(in_lammps, number(in_lammps * pace_of(press), 3)),
         magnitude_cell(number_if_any(press, "worst_force_error")),
         percent_magnitude(number_if_any(press, "static_error")),
         percent_magnitude(number_if_any(press, "worst_force_error_small_strain")),
         {count(number_if_any(press, "steps")), if_known(step, with_prefix(step, "s"))},
         with_prefix(1e-9 * number_if_any(press, "ns_per_mass_step"), "s")});
  }
  return table;
}

Table continuum_table(const JsonEntry& bench) {
  Table table{
      heads({"Elements", "Unknowns", "Solves per second", "Real-time factor", "Force error"})};
  for (const JsonEntry& entry : array_if_any(bench, "continua"))
    table.rows.push_back({fmt::format("Q{}", number_if_any(entry, "degree")),
                          count(number_if_any(entry, "unknowns")),
                          number(number_if_any(entry, "solves_per_second"), 3),
                          number(number_if_any(entry, "real_time_factor"), 3),
                          magnitude_cell(number_if_any(entry, "worst_force_error"))});
  return table;
}

/// The press on which most depends, in a sentence.
std::string answer_text(const JsonEntry& bench) {
  const JsonList presses = array_if_any(bench, "press");
  const JsonEntry* best = nullptr;
  for (const JsonEntry& press : presses)
    if (number_if_any(press, "worst_force_error") <= 0.02 &&
        (best == nullptr ||
         number_if_any(press, "real_time_factor") > number_if_any(*best, "real_time_factor")))
      best = &press;
  WordList found;
  if (best) {
    const double threads = number_if_any(*best, "threads");
    found = {{{{"model", text_if_any(*best, "model")},
               {"scaled", is_scaled(*best)},
               {"spacing", spacing_text(*best)},
               {"threads", threads == 1.0 ? "" : count(threads)},
               {"error", percent_magnitude(number_if_any(*best, "worst_force_error"))},
               {"factor", number(number_if_any(*best, "real_time_factor"), 3)}}}};
  }
  return sentences("answer_bench", {{{"none", found.empty()}, {"best", std::move(found)}}});
}

}  // namespace

Chapter pace_chapter(const JsonEntry& bench) {
  ChapterData chapter("pace");
  chapter["from"] = shown_units().length.text(1e-3);
  chapter.figures = {pace_figure(bench)};
  chapter["lammps"] = if_known(lammps_cost(bench), number(lammps_cost(bench), 3));
  chapter.tables["presses"] = press_table(bench);
  chapter.tables["continua"] = continuum_table(bench);
  return written(std::move(chapter));
}

Page bench_page(const std::filesystem::path& run_folder, FolderReader& reader) {
  const JsonEntry bench = reader.json(run_folder / "bench.json");
  Page page;
  page.title = "Soft fingertip: speed";
  page.subtitle = "What presses cost on this machine, " +
                  reader.attempt([&] { return text_if_any(bench, "date"); });
  if (reader.attempt([&] { return bench.at("quick").flag(); }))
    page.status = "Quick run: coarse lattices, few repeats.";
  page.answer = reader.attempt([&] { return answer_text(bench); });
  page.chapters.push_back(reader.attempt([&] { return pace_chapter(bench); }));
  return page;
}

}  // namespace fingertip::studies::report::inline chapters::inline bench
