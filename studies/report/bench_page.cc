#include "studies/report/bench_page.h"

#include <fmt/format.h>

#include <cmath>

#include "studies/report/bench_figures.h"
#include "studies/report/run_data.h"

namespace fingertip::studies::reporting {
namespace {

using nlohmann::json;

std::string spacing_text(const json& press) {
  return fmt::format("R/{:.3g}", 1.0 / number_at(press, "spacing_over_R"));
}

Table press_table(const json& bench) {
  Table table;
  table.caption =
      "Press of the default finger to its depth. Real-time factor: simulated over elapsed time in "
      "the slowest "
      "10 ms of simulated time from the first touch on, by the wall clock; below it by the "
      "processor "
      "time of the pressing thread, which others on the machine do not lengthen. Error: the "
      "largest "
      "one against the continuum of law A; below it against that of small strain.";
  table.header = {plain("Lattice"),
                  plain("a"),
                  plain("Threads"),
                  plain("Real-time factor", "processor time"),
                  plain("Force error", "small strain"),
                  plain("Steps")};
  for (const json& press : array_at(bench, "press")) {
    const double error = number_at(press, "worst_force_error");
    const double small = number_at(press, "worst_force_error_small_strain");
    const double processor = number_at(press, "real_time_factor_processor");
    table.rows.push_back(
        {plain(fmt::format("{}, {}", text_at(press, "model"), text_at(press, "kinematics"))),
         plain(spacing_text(press)),
         plain(count(number_at(press, "threads"))),
         plain(number(number_at(press, "real_time_factor"), 3),
               std::isfinite(processor) ? number(processor, 3) : ""),
         {percent_magnitude(error), std::isfinite(small) ? percent_magnitude(small) : "",
          grade(error)},
         plain(count(number_at(press, "steps")))});
  }
  table.graded = true;
  return table;
}

Table continuum_table(const json& bench) {
  Table table;
  table.caption =
      "Quasi-static finite elements as a way to simulate the press: one equilibrium per control "
      "period of 1 ms would be real time. Solves on the whole machine, started from the one "
      "before.";
  table.header = {plain("Elements"), plain("Unknowns"), plain("Solves per second"),
                  plain("Real-time factor"), plain("Force error")};
  for (const json& one : array_at(bench, "continua")) {
    const double error = number_at(one, "worst_force_error");
    table.rows.push_back({plain(fmt::format("Q{}", number_at(one, "degree"))),
                          plain(count(number_at(one, "unknowns"))),
                          plain(number(number_at(one, "solves_per_second"), 3)),
                          plain(number(number_at(one, "real_time_factor"), 3)),
                          {percent_magnitude(error), "", grade(error)}});
  }
  return table;
}

Chapter pace_chapter(const json& bench) {
  Chapter chapter{"pace", "Error against speed", {}};
  const Figure figure = pace_figure(bench);
  if (!figure.panels.empty())
    chapter.blocks.push_back(FigureBlock{
        figure, "Error of the force against the real-time factor",
        "Down and right is better; the band is an error below 2 %, the vertical line real time. "
        "One "
        "core (processor time) for lattices; errors against the continuum of law A, hollow ones "
        "against that of small strain, which is what such a lattice computes."});
  if (!array_at(bench, "press").empty()) chapter.blocks.push_back(press_table(bench));
  if (!array_at(bench, "continua").empty()) chapter.blocks.push_back(continuum_table(bench));
  return chapter;
}

Table kernel_table(const json& bench, const char* list, const std::string& caption) {
  Table table;
  table.caption = caption;
  table.header = {plain("Kernel"),
                  plain("Registers"),
                  plain("Precision"),
                  plain("Threads"),
                  plain("Masses"),
                  plain("ns per spring and step"),
                  plain("Operations per spring"),
                  plain("Roofline")};
  for (const json& kernel : array_at(bench, list)) {
    const double fraction = number_at(kernel, "roofline_fraction");
    table.rows.push_back({plain(text_at(kernel, "name")), plain(text_at(kernel, "isa")),
                          plain(text_at(kernel, "precision")),
                          plain(count(number_at(kernel, "threads"))),
                          plain(count(number_at(kernel, "masses"))),
                          plain(number(number_at(kernel, "ns_per_spring_step"), 3)),
                          plain(number(number_at(kernel, "operations_per_spring"), 3)),
                          plain(std::isfinite(fraction) ? percent_magnitude(fraction) : "–")});
  }
  return table;
}

Table ratio_table(const json& bench) {
  Table table;
  table.caption =
      "Medians over rounds of the ratio within a round: AVX-512, double precision, damped. "
      "edge_list, lammps: their time over ours; threads: one thread over two; roofline: share of "
      "the multiply-adds this core can do.";
  table.header = {plain("Ratio"), plain("Median"), plain("Lowest"), plain("Highest"),
                  plain("Remark")};
  const json values = object_at(bench, "ratios");
  const json rounds = object_at(bench, "ratio_rounds");
  const json missing = object_at(bench, "missing_ratios");
  for (const auto& [name, value] : values.items()) {
    double low = meshes::unknown, high = meshes::unknown;
    for (const json& one : rounds.value(name, json::array())) {
      low = std::fmin(low, one.get<double>());
      high = std::fmax(high, one.get<double>());
    }
    Cell remark = plain(text_at(missing, name));
    remark.words = true;
    table.rows.push_back({plain(name), plain(number(number_at(values, name), 3)),
                          plain(number(low, 3)), plain(number(high, 3)), remark});
  }
  return table;
}

Chapter kernel_chapter(const json& bench) {
  Chapter chapter{"kernels", "Kernels", {}};
  if (!bench.contains("kernels")) return chapter;
  chapter.blocks.push_back(ratio_table(bench));
  const Figure growth = growth_figure(bench);
  if (!growth.panels.empty())
    chapter.blocks.push_back(FigureBlock{growth,
                                         "Cost per spring and step against the number of masses",
                                         "Level means that cost grows linearly with the lattice."});
  chapter.blocks.push_back(kernel_table(
      bench, "kernels",
      "Every kernel. One thread: processor time; more: wall time. Operations: of the spring engine "
      "17 "
      "multiply-adds; of the product's forces every addition, multiplication, division, root and "
      "comparison that the kernel's own source executes, idle lanes included. Springs of hookean "
      "and "
      "network are fibres, of which there are few: most of the work is in cells."));
  if (!array_at(bench, "peers").empty())
    chapter.blocks.push_back(
        kernel_table(bench, "peers",
                     "Peers on the same cubes, in the same rounds, on one thread: "
                     "LAMMPS' harmonic bonds (undamped), Bullet's links (projected positions)."));
  return chapter;
}

Chapter time_chapter(const json& bench) {
  Chapter chapter{"times", "Other times", {}};
  Table table;
  table.caption = "What else a user waits for.";
  table.header = {plain("What"), plain("Time"), plain("Remark")};
  for (const json& one : array_at(bench, "times"))
    table.rows.push_back({plain(text_at(one, "what")),
                          plain(with_prefix(number_at(one, "seconds"), "s")),
                          plain(one.value("from_cache", false) ? "from an earlier run" : "")});
  if (!table.rows.empty()) chapter.blocks.push_back(table);
  return chapter;
}

Chapter machine_chapter(const json& bench, const json& history) {
  Chapter chapter{"machine", "Machine", {}};
  const json facts = object_at(bench, "machine");
  const json probes = object_at(bench, "probes");
  Table table;
  table.header = {plain("Fact"), plain("Value")};
  for (const auto& [name, value] : facts.items())
    table.rows.push_back(
        {plain(name), plain(value.is_string() ? value.get<std::string>() : value.dump())});
  const json rates = object_at(probes, "multiply_adds_per_second");
  for (const auto& [isa, rate] : rates.items())
    if (rate.is_number())
      table.rows.push_back(
          {plain("multiply-adds, " + isa), plain(with_prefix(rate.get<double>(), "1/s"))});
  for (const char* name : {"bandwidth_L2", "bandwidth_DRAM"})
    if (const double rate = number_at(probes, name); std::isfinite(rate))
      table.rows.push_back({plain(name), plain(with_prefix(rate, "B/s"))});
  chapter.blocks.push_back(table);
  const json missing = object_at(bench, "missing_programs");
  for (const auto& [program, why] : missing.items())
    chapter.blocks.push_back(Paragraph{program, why.get<std::string>(), true});
  const Figure figure = history_figure(history);
  if (!figure.panels.empty())
    chapter.blocks.push_back(
        FigureBlock{figure, "Ratios from run to run", "One point per run in the history."});
  return chapter;
}

/// The press on which most depends, in a sentence.
std::string answer_text(const json& bench) {
  const json presses = array_at(bench, "press");
  const json* best = nullptr;
  for (const json& press : presses) {
    const double error = number_at(press, "worst_force_error");
    if (!(error <= 0.02)) continue;
    if (best == nullptr ||
        number_at(press, "real_time_factor") > number_at(*best, "real_time_factor"))
      best = &press;
  }
  if (best == nullptr)
    return "No lattice that was pressed keeps its force within 2 % of the continuum.";
  return fmt::format(
      "The fastest lattice within 2 % of the continuum is {} at {} on {} thread{}: error {}, "
      "real-time factor {} in its slowest 10 ms.",
      text_at(*best, "model"), spacing_text(*best), number_at(*best, "threads"),
      number_at(*best, "threads") == 1.0 ? "" : "s",
      percent_magnitude(number_at(*best, "worst_force_error")),
      number(number_at(*best, "real_time_factor"), 3));
}

}  // namespace

Page bench_page(const std::filesystem::path& run_folder) {
  const json bench = read_json(run_folder / "bench.json");
  json history = json::array();
  if (const auto file = run_folder / "history.json"; std::filesystem::exists(file))
    history = array_at(read_json(file), "runs");
  Page page;
  page.title = "Soft fingertip: speed";
  page.subtitle = "What kernels, presses and peers cost on this machine, " + text_at(bench, "date");
  page.status = bench.value("quick", false) ? "Quick run: coarse lattices, few repeats." : "";
  page.answer = answer_text(bench);
  page.chapters = {pace_chapter(bench), kernel_chapter(bench), time_chapter(bench),
                   machine_chapter(bench, history)};
  return page;
}

}  // namespace fingertip::studies::reporting
