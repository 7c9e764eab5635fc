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

Style family_style(const std::string& model, bool usual_steps) {
  Style style = model_style(model);
  style.point = usual_steps ? 7 : 9;
  style.point_size = usual_steps ? 0.9 : 1.2;
  style.dash = usual_steps ? "" : "(8,4)";
  style.width = 2.2;
  return style;
}

/// The presses of a family, each point with its R/n.
void add_family(Panel& panel, const JsonEntry& bench, const Family& family) {
  Series series;
  series.label = family.label;
  series.style = family_style(family.model, family.integrator == usual_integrator);
  if (family.whole) series.style.point = 11;
  if (family.hollow) {
    series.style.point -= 1;
    series.style.dash = "(2,4)";
    series.style.width = 1.4;
  }
  for (const JsonEntry& press : array_if_any(bench, "press")) {
    if (text_if_any(press, "model") != family.model ||
        text_if_any(press, "integrator") != family.integrator ||
        number_if_any(press, "threads") != family.threads ||
        press.at("whole").flag() != family.whole)
      continue;
    const double error = 100.0 * number_if_any(press, family.error_key), pace = pace_of(press);
    if (!std::isfinite(error) || !std::isfinite(pace)) continue;
    series.x.push_back(pace);
    series.y.push_back(error);
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
    series.style = model_style("reference");
    series.style.point = degree == 1 ? 4 : 5;
    series.style.point_size = 0.9;
    if (degree == 1) series.style.dash = "(6,3)";
    series.x.push_back(pace);
    series.y.push_back(error);
    panel.texts.push_back({pace, 1.22 * error, count(number_if_any(entry, "unknowns"))});
  }
  for (auto& [degree, series] : by_degree) panel.series.push_back(std::move(series));
}

/// The corner that every press should be in, behind everything else.
void add_target(Panel& panel) {
  const Range x = {real_time, panel.x_range->to}, y = {panel.y_range->from, accurate};
  Series corner;
  corner.key = "target";
  corner.filled = true;
  corner.style.colour = "#E69F00";
  corner.x = {x.from, x.to, x.to, x.from, x.from};
  corner.y = {y.from, y.from, y.to, y.to, y.from};
  panel.series.insert(panel.series.begin(), corner);
  panel.texts.push_back({std::sqrt(x.from * x.to), 1.25 * y.from, "2 %, real time"});
}

/// The range of logarithmic data with room at both ends, and `include` in it.
Range roomy(const std::vector<Series>& all, bool vertical, double include) {
  double low = include, high = include;
  for (const Series& series : all)
    for (const double value : vertical ? series.y : series.x) {
      low = std::fmin(low, value);
      high = std::fmax(high, value);
    }
  return {low / 1.6, high * 1.6};
}

/// Error of the force against the real-time factor: every way of simulating the press.
Figure pace_figure(const JsonEntry& bench) {
  Panel panel;
  panel.x_label = "real-time factor in the slowest 10 ms [1]";
  panel.y_label = fmt::format("largest force error, {} to {} [%]", shown_units().length.text(1e-3),
                              shown_units().length.text(3e-3));
  panel.log_x = panel.log_y = 10;
  panel.key = "outside right top";
  add_lattices(panel, bench);
  add_continua(panel, bench);
  if (panel.series.empty()) return {"pace", 0, 0, 1, {}};
  panel.x_range = roomy(panel.series, false, real_time);
  panel.x_range->to = std::fmax(panel.x_range->to, 10.0 * real_time);
  panel.y_range = roomy(panel.series, true, accurate);
  panel.y_range->from = std::fmin(panel.y_range->from, 0.25 * accurate);
  panel.markers = {{real_time, "#444444"}};
  add_target(panel);
  return {"pace", 940, 540, 1, {panel}};
}

std::string spacing_text(const JsonEntry& press) {
  return fmt::format("R/{:.3g}", 1.0 / number_if_any(press, "spacing_over_R"));
}

bool is_scaled(const JsonEntry& press) {
  return text_if_any(press, "integrator") == "mass-scaled";
}

/// Of the edge list in the largest cube that LAMMPS marches, too [ns per spring and step].
double edge_list_cost(const JsonEntry& bench) {
  double cost = meshes::unknown, masses = 0.0;
  for (const JsonEntry& kernel : array_if_any(bench, "kernels")) {
    const double size = number_if_any(kernel, "masses");
    if (text_if_any(kernel, "name") != "edge_list" || !(size > masses && size < 1.5e5)) continue;
    masses = size;
    cost = number_if_any(kernel, "ns_per_spring_step");
  }
  return cost;
}

Table press_table(const JsonEntry& bench) {
  Table table;
  table.header = {plain("Lattice", "strain, steps"),
                  plain("a", "masses"),
                  plain("Of the tip"),
                  plain("Threads"),
                  plain("Real-time factor", "processor time"),
                  plain("… in edge lists"),
                  plain("Force error"),
                  plain("… at rest"),
                  plain("… small strain"),
                  plain("Steps", "longest"),
                  plain("Per mass and step")};
  const auto error_cell = [](double error) {
    return Cell{std::isfinite(error) ? percent_magnitude(error) : "–", "", grade(error)};
  };
  for (const JsonEntry& press : array_if_any(bench, "press")) {
    const double processor = number_if_any(press, "real_time_factor_processor");
    const double parts = number_if_any(press, "parts");
    const double step = number_if_any(press, "time_step"),
                 cost = number_if_any(press, "ns_per_mass_step");
    const double small = number_if_any(press, "worst_force_error_small_strain");
    table.rows.push_back(
        {plain(text_if_any(press, "model"), text_if_any(press, "kinematics") + " strain" +
                                                (is_scaled(press) ? ", scaled masses" : "")),
         plain(spacing_text(press), count(number_if_any(press, "particles"))),
         plain(parts == 1.0 ? "all" : "1/" + count(parts)),
         plain(count(number_if_any(press, "threads"))),
         plain(number(number_if_any(press, "real_time_factor"), 3),
               std::isfinite(processor) ? number(processor, 3) : ""),
         plain(number(
             edge_list_cost(bench) *
                 (std::isfinite(processor) ? processor : number_if_any(press, "real_time_factor")),
             3)),
         error_cell(number_if_any(press, "worst_force_error")),
         plain(error_cell(number_if_any(press, "static_error")).text),
         plain(error_cell(small).text),
         plain(count(number_if_any(press, "steps")),
               std::isfinite(step) ? with_prefix(step, "s") : ""),
         plain(std::isfinite(cost) ? with_prefix(1e-9 * cost, "s") : "–")});
  }
  table.graded = true;
  return table;
}

Table continuum_table(const JsonEntry& bench) {
  Table table;
  table.header = {plain("Elements"), plain("Unknowns"), plain("Solves per second"),
                  plain("Real-time factor"), plain("Force error")};
  for (const JsonEntry& entry : array_if_any(bench, "continua")) {
    const double error = number_if_any(entry, "worst_force_error");
    table.rows.push_back({plain(fmt::format("Q{}", number_if_any(entry, "degree"))),
                          plain(count(number_if_any(entry, "unknowns"))),
                          plain(number(number_if_any(entry, "solves_per_second"), 3)),
                          plain(number(number_if_any(entry, "real_time_factor"), 3)),
                          {percent_magnitude(error), "", grade(error)}});
  }
  return table;
}

Chapter pace_chapter(const JsonEntry& bench) {
  ChapterData chapter("pace");
  chapter["from"] = shown_units().length.text(1e-3);
  chapter.figures = {pace_figure(bench)};
  chapter["edge_list"] = number(edge_list_cost(bench), 3);
  chapter.tables["presses"] = press_table(bench);
  chapter.tables["continua"] = continuum_table(bench);
  return written(std::move(chapter));
}

/// The press on which most depends, in a sentence.
std::string answer_text(const JsonEntry& bench) {
  const JsonList presses = array_if_any(bench, "press");
  const JsonEntry* best = nullptr;
  for (const JsonEntry& press : presses) {
    const double error = number_if_any(press, "worst_force_error");
    if (!(error <= 0.02)) continue;
    if (best == nullptr ||
        number_if_any(press, "real_time_factor") > number_if_any(*best, "real_time_factor"))
      best = &press;
  }
  const bool missing = bench.contains("missing_reference");
  WordList found;
  if (best && !missing) {
    const double threads = number_if_any(*best, "threads");
    Words& words = found.emplace_back();
    words["model"] = text_if_any(*best, "model");
    words["scaled"] = is_scaled(*best);
    words["spacing"] = spacing_text(*best);
    words["threads"] = threads == 1.0 ? "" : count(threads);
    words["error"] = percent_magnitude(number_if_any(*best, "worst_force_error"));
    words["factor"] = number(number_if_any(*best, "real_time_factor"), 3);
  }
  Words words;
  words["no_reference"] = missing;
  words["none"] = found.empty() && !missing;
  words["best"] = std::move(found);
  return sentences("answer_bench", words);
}

}  // namespace

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
