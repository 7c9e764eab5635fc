#include "studies/report/bench_page.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "studies/report/bench_figures.h"
#include "studies/report/run_data.h"

namespace fingertip::studies::reporting {
namespace {

std::string spacing_text(const JsonEntry& press) {
  return fmt::format("R/{:.3g}", 1.0 / number_if_any(press, "spacing_over_R"));
}

bool is_scaled(const JsonEntry& press) {
  return text_if_any(press, "integrator") == "mass-scaled";
}

Table press_table(const JsonEntry& bench) {
  Table table;
  table.caption =
      "Press of the default finger to its depth. Real-time factor: simulated over elapsed time in "
      "the slowest 10 ms of simulated time from the first touch on, by the wall clock, of the "
      "fastest of up to five runs; below it by "
      "the processor time of the pressing thread, which others on the machine do not lengthen. "
      "Errors: the largest from " +
      shown_units().length.text(1e-3) +
      " on; of the press against the continuum of law A, of the "
      "same lattice at rest against it, of the press against small strain. Steps: how many, and "
      "the longest.";
  table.header = {plain("Lattice", "strain, steps"),
                  plain("a", "masses"),
                  plain("Threads"),
                  plain("Real-time factor", "processor time"),
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
    const double step = number_if_any(press, "time_step"),
                 cost = number_if_any(press, "ns_per_mass_step");
    const double small = number_if_any(press, "worst_force_error_small_strain");
    table.rows.push_back(
        {plain(text_if_any(press, "model"), text_if_any(press, "kinematics") + " strain" +
                                                (is_scaled(press) ? ", scaled masses" : "")),
         plain(spacing_text(press), count(number_if_any(press, "particles"))),
         plain(count(number_if_any(press, "threads"))),
         plain(number(number_if_any(press, "real_time_factor"), 3),
               std::isfinite(processor) ? number(processor, 3) : ""),
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
  table.caption =
      "Quasi-static finite elements as a way to simulate the press: one equilibrium per control "
      "period of 1 ms would be real time. Solves on the whole machine, started from the one "
      "before.";
  table.header = {plain("Elements"), plain("Unknowns"), plain("Solves per second"),
                  plain("Real-time factor"), plain("Force error")};
  for (const JsonEntry& one : array_if_any(bench, "continua")) {
    const double error = number_if_any(one, "worst_force_error");
    table.rows.push_back({plain(fmt::format("Q{}", number_if_any(one, "degree"))),
                          plain(count(number_if_any(one, "unknowns"))),
                          plain(number(number_if_any(one, "solves_per_second"), 3)),
                          plain(number(number_if_any(one, "real_time_factor"), 3)),
                          {percent_magnitude(error), "", grade(error)}});
  }
  return table;
}

Chapter pace_chapter(const JsonEntry& bench) {
  Chapter chapter{"pace", "Error against speed", {}};
  const Figure figure = pace_figure(bench);
  if (!figure.panels.empty())
    chapter.blocks.push_back(FigureBlock{
        figure, "Error of the force against the real-time factor",
        "Down and right is better; the coloured corner is an error below 2 % in real time or "
        "faster. Colours tell models, circles the largest safe step, triangles scaled masses. One "
        "core (processor time) unless said otherwise, errors against the continuum of law A; "
        "hollow ones of hookean against that of small strain, which it computes, at the same "
        "spacings. "
        "Squares: finite elements, with their number of unknowns."});
  if (!array_if_any(bench, "press").empty()) chapter.blocks.push_back(press_table(bench));
  if (!array_if_any(bench, "continua").empty()) chapter.blocks.push_back(continuum_table(bench));
  return chapter;
}

Table kernel_table(const JsonEntry& bench, const char* list, const std::string& caption) {
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
  for (const JsonEntry& kernel : array_if_any(bench, list)) {
    const double fraction = number_if_any(kernel, "roofline_fraction");
    table.rows.push_back({plain(text_if_any(kernel, "name")), plain(text_if_any(kernel, "isa")),
                          plain(text_if_any(kernel, "precision")),
                          plain(count(number_if_any(kernel, "threads"))),
                          plain(count(number_if_any(kernel, "masses"))),
                          plain(number(number_if_any(kernel, "ns_per_spring_step"), 3)),
                          plain(number(number_if_any(kernel, "operations_per_spring"), 3)),
                          plain(std::isfinite(fraction) ? percent_magnitude(fraction) : "–",
                                text_if_any(kernel, "remark"))});
  }
  return table;
}

/// What each ratio is hoped to reach: at least, or for the peers' own at most.
std::string aim_of(const std::string& name) {
  static const std::map<std::string, const char*> aims = {
      {"edge_list_48_1t", "9"},
      {"edge_list_20_1t", "6"},
      {"edge_list_48_2t", "16"},
      {"edge_list_20_2t", "11"},
      {"lammps_48_1t", "10"},
      {"lammps_20_1t", "7"},
      {"lammps_48_2t", "10"},
      {"lammps_20_2t", "7"},
      {"roofline_48_1t", "0.50"},
      {"roofline_20_1t", "0.38"},
      {"threads_48", "1.85"},
      {"threads_20", "1.85"},
      {"edge_list_over_lammps_48", "at most 1.1"},
      {"edge_list_over_lammps_20", "at most 1.1"}};
  const auto aim = aims.find(name);
  return aim == aims.end() ? "" : aim->second;
}

Table ratio_table(const JsonEntry& bench) {
  Table table;
  table.caption =
      "Medians over rounds of the ratio within a round: AVX-512, double precision, damped. "
      "edge_list, lammps: their time over ours (2t: ours on two threads, LAMMPS on two ranks or, "
      "where those take longer, one, the "
      "edge list on one thread), in cubes of 48 and 20 masses a side; threads: one thread over "
      "two; roofline: share of the multiply-adds this core can do; edge_list_over_lammps: how good "
      "a peer the edge list is. With two threads by the wall clock, which only an idle machine "
      "does justice.";
  table.header = {plain("Ratio"),  plain("Median"),  plain("Aim"),
                  plain("Lowest"), plain("Highest"), plain("Remark")};
  const JsonEntry values = object_if_any(bench, "ratios");
  const JsonEntry rounds = object_if_any(bench, "ratio_rounds");
  const JsonEntry missing = object_if_any(bench, "missing_ratios");
  for (const auto& [name, value] : values.members()) {
    double low = meshes::unknown, high = meshes::unknown;
    for (const double one : numbers_if_any(rounds, name)) {
      low = std::fmin(low, one);
      high = std::fmax(high, one);
    }
    Cell remark = plain(text_if_any(missing, name));
    remark.words = true;
    table.rows.push_back({plain(name), plain(number(value.number(), 3)), plain(aim_of(name)),
                          plain(number(low, 3)), plain(number(high, 3)), remark});
  }
  return table;
}

Chapter kernel_chapter(const JsonEntry& bench) {
  Chapter chapter{"kernels", "Kernels", {}};
  if (!bench.contains("kernels")) return chapter;
  chapter.blocks.push_back(ratio_table(bench));
  chapter.blocks.push_back(kernel_table(
      bench, "kernels",
      "Every kernel. One thread: processor time; more: wall time. Operations: of the spring engine "
      "the 17 in multiply pipes, of the product's forces every addition, multiplication, division, "
      "root and comparison that the kernel's own source executes, idle lanes included. Roofline: "
      "share of what the cores do at best, multiply-adds for the engine, additions and "
      "multiplications in turns for the others, which are compiled without fusing them. Springs of "
      "hookean and network are fibres, of which there are few: most of the work is in cells."));
  if (!array_if_any(bench, "peers").empty())
    chapter.blocks.push_back(kernel_table(
        bench, "peers",
        "Peers on the same cubes, in the same rounds: LAMMPS' harmonic bonds (undamped, "
        "threads are MPI ranks), Bullet's links (projected positions)."));
  return chapter;
}

/// Least and largest cost of a spring [ns], of the engine on one thread with the widest registers,
/// for lattices of `from` to `to` masses; NaN where there are none.
std::pair<double, double> costs_between(const JsonEntry& bench, double from, double to) {
  std::pair<double, double> costs{meshes::unknown, meshes::unknown};
  for (const JsonEntry& kernel : array_if_any(bench, "kernels")) {
    const double masses = number_if_any(kernel, "masses");
    if (text_if_any(kernel, "name") != "springs" || text_if_any(kernel, "precision") != "float64" ||
        text_if_any(kernel, "isa") !=
            text_if_any(object_if_any(bench, "machine"), "isa_measured") ||
        number_if_any(kernel, "threads") != 1.0 || !(masses >= from && masses <= to))
      continue;
    const double cost = number_if_any(kernel, "ns_per_spring_step");
    costs = {std::fmin(costs.first, cost), std::fmax(costs.second, cost)};
  }
  return costs;
}

/// How far the cost of a spring goes apart from 1e4 masses on, and why.
std::string growth_text(const JsonEntry& bench) {
  std::string text =
      "Level means that cost grows linearly with the lattice. Grey: what arithmetic and DRAM alone "
      "would take; a mass is 48 bytes of position and velocity, read and written once per step. "
      "Vertical lines: lattices that fill the second and the third cache.";
  const JsonEntry probes = object_if_any(bench, "probes");
  const double held = number_if_any(probes, "cache_L3") / 48.0;
  const auto inside = costs_between(bench, 1e4, held);
  const auto beyond = costs_between(bench, held, 1e9);
  if (inside.second > inside.first)
    text += fmt::format(
        " From 10 000 masses to as many as the third cache holds, a spring costs {} "
        "to {} ns on one thread, a factor {}.",
        number(inside.first, 3), number(inside.second, 3), number(inside.second / inside.first, 3));
  if (std::isfinite(beyond.first) && std::isfinite(inside.first))
    text += fmt::format(
        " Beyond, the way to memory comes on top: {} ns and DRAM's {} ns make {}, "
        "measured {}.",
        number(inside.first, 3), number(dram_cost(bench), 3),
        number(inside.first + dram_cost(bench), 3), number(beyond.second, 3));
  return text;
}

Chapter growth_chapter(const JsonEntry& bench) {
  Chapter chapter{"growth", "Growth with the number of masses", {}};
  const Figure engine = growth_figure(bench), presses = press_growth_figure(bench);
  if (!engine.panels.empty())
    chapter.blocks.push_back(FigureBlock{
        engine, "Cost per spring and step against the number of masses", growth_text(bench)});
  if (!presses.panels.empty())
    chapter.blocks.push_back(FigureBlock{
        presses, "Cost per mass and step of the presses",
        "Whole presses on one thread, processor time: forces, contact, rod, control, choice of the "
        "step. Scaled masses take a dearer step, seldom."});
  return chapter;
}

Chapter time_chapter(const JsonEntry& bench) {
  Chapter chapter{"times", "Other times", {}};
  Table table;
  table.caption = "What else a user waits for.";
  table.header = {plain("What"), plain("Time"), plain("Remark")};
  for (const JsonEntry& one : array_if_any(bench, "times"))
    table.rows.push_back({plain(text_if_any(one, "what")),
                          plain(with_prefix(number_if_any(one, "seconds"), "s")),
                          plain(one.at("from_cache").flag() ? "from an earlier run" : "")});
  if (!table.rows.empty()) chapter.blocks.push_back(table);
  return chapter;
}

Chapter machine_chapter(const JsonEntry& bench, const JsonList& history) {
  Chapter chapter{"machine", "Machine", {}};
  const JsonEntry facts = object_if_any(bench, "machine");
  const JsonEntry probes = object_if_any(bench, "probes");
  Table table;
  table.header = {plain("Fact"), plain("Value")};
  for (const auto& [name, value] : facts.members()) {
    const bool bytes = name.ends_with(" [B]") && value.is_number();
    const std::string text = value.text();
    const bool fraction = value.is_number() && text.find_first_of(".e") != text.npos;
    table.rows.push_back({plain(bytes ? name.substr(0, name.size() - 4) : name),
                          plain(bytes      ? with_prefix(value.number(), "B")
                                : fraction ? number(value.number(), 3)
                                           : text)});
  }
  const JsonEntry rates = object_if_any(probes, "multiply_adds_per_second");
  for (const auto& [isa, rate] : rates.members())
    if (!rate.is_null())
      table.rows.push_back(
          {plain("multiply-adds, " + isa), plain(with_prefix(rate.number(), "/s"))});
  const JsonEntry mixed = object_if_any(probes, "operations_per_second");
  for (const auto& [isa, rate] : mixed.members())
    if (!rate.is_null())
      table.rows.push_back({plain("additions and multiplications, " + isa),
                            plain(with_prefix(rate.number(), "/s"))});
  for (const char* name : {"bandwidth_L2", "bandwidth_DRAM"})
    if (const double rate = number_if_any(probes, name); std::isfinite(rate))
      table.rows.push_back({plain(name), plain(with_prefix(rate, "B/s"))});
  chapter.blocks.push_back(table);
  const JsonEntry missing = object_if_any(bench, "missing_programs");
  for (const auto& [program, why] : missing.members())
    chapter.blocks.push_back(Paragraph{program, why.text(), true});
  const Figure figure = history_figure(history);
  if (!figure.panels.empty())
    chapter.blocks.push_back(
        FigureBlock{figure, "Ratios from run to run", "One point per run in the history."});
  return chapter;
}

/// The press on which most depends, in a sentence.
std::string answer_text(const JsonEntry& bench) {
  if (bench.contains("missing_reference"))
    return "No force errors: the continuum they are measured against is not in the cache, and a "
           "quick run does not compute it.";
  const JsonList presses = array_if_any(bench, "press");
  const JsonEntry* best = nullptr;
  for (const JsonEntry& press : presses) {
    const double error = number_if_any(press, "worst_force_error");
    if (!(error <= 0.02)) continue;
    if (best == nullptr ||
        number_if_any(press, "real_time_factor") > number_if_any(*best, "real_time_factor"))
      best = &press;
  }
  if (best == nullptr)
    return "No lattice that was pressed keeps its force within 2 % of the continuum.";
  return fmt::format(
      "The fastest lattice within 2 % of the continuum is {} at {} on {}: error {}, real-time "
      "factor {} in its slowest 10 ms.",
      text_if_any(*best, "model") + (is_scaled(*best) ? " with scaled masses" : ""),
      spacing_text(*best),
      number_if_any(*best, "threads") == 1.0 ? "one thread"
                                             : count(number_if_any(*best, "threads")) + " threads",
      percent_magnitude(number_if_any(*best, "worst_force_error")),
      number(number_if_any(*best, "real_time_factor"), 3));
}

}  // namespace

Page bench_page(const std::filesystem::path& run_folder, FolderReader& reader) {
  const JsonEntry bench = reader.json(run_folder / "bench.json");
  const JsonEntry log = reader.json(run_folder / "history.json");
  const JsonList history = reader.attempt([&] { return array_if_any(log, "runs"); });
  Page page;
  page.title = "Soft fingertip: speed";
  page.subtitle = "What kernels, presses and peers cost on this machine, " +
                  reader.attempt([&] { return text_if_any(bench, "date"); });
  if (reader.attempt([&] { return bench.at("quick").flag(); }))
    page.status = "Quick run: coarse lattices, few repeats.";
  page.answer = reader.attempt([&] { return answer_text(bench); });
  for (const auto chapter : {pace_chapter, kernel_chapter, growth_chapter, time_chapter})
    page.chapters.push_back(reader.attempt([&] { return chapter(bench); }));
  page.chapters.push_back(reader.attempt([&] { return machine_chapter(bench, history); }));
  return page;
}

}  // namespace fingertip::studies::reporting
