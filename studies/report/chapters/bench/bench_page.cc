#include "studies/report/chapters/bench/bench_page.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <utility>

#include "studies/report/chapters/bench/bench_figures.h"
#include "studies/report/page/words.h"
#include "studies/report/results/run_data.h"

namespace fingertip::studies::reporting {
namespace {

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
    const double step = number_if_any(press, "time_step"),
                 cost = number_if_any(press, "ns_per_mass_step");
    const double small = number_if_any(press, "worst_force_error_small_strain");
    table.rows.push_back(
        {plain(text_if_any(press, "model"), text_if_any(press, "kinematics") + " strain" +
                                                (is_scaled(press) ? ", scaled masses" : "")),
         plain(spacing_text(press), count(number_if_any(press, "particles"))),
         plain(parts_of(press) == 1.0 ? "all" : "1/" + count(parts_of(press))),
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

/// Where a step with scaled masses goes, beside what moving its memory once would take.
Table part_table(const JsonEntry& bench) {
  Table table;
  table.header = {plain("Part"),
                  plain("Time"),
                  plain("Share of the step"),
                  plain("Memory touched"),
                  plain("From L2", "at least"),
                  plain("From DRAM", "at least")};
  const JsonList parts = array_if_any(bench, "parts");
  const JsonEntry probes = object_if_any(bench, "probes");
  double whole = meshes::unknown;
  for (const JsonEntry& part : parts)
    if (text_if_any(part, "part") == "whole step") whole = number_if_any(part, "seconds");
  for (const JsonEntry& part : parts) {
    const double seconds = number_if_any(part, "seconds"), bytes = number_if_any(part, "bytes");
    const auto moved = [&](const char* bandwidth) {
      const double least = bytes / number_if_any(probes, bandwidth);
      return plain(std::isfinite(least) ? with_prefix(least, "s") : "–");
    };
    table.rows.push_back({plain(text_if_any(part, "part")), plain(with_prefix(seconds, "s")),
                          plain(percent_magnitude(seconds / whole)),
                          plain(std::isfinite(bytes) ? with_prefix(bytes, "B") : "–"),
                          moved("bandwidth_L2"), moved("bandwidth_DRAM")});
  }
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
  chapter.tables["parts"] = part_table(bench);
  chapter.tables["continua"] = continuum_table(bench);
  return written(std::move(chapter));
}

Table kernel_table(const JsonEntry& bench, const char* list) {
  Table table;
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
  table.header = {plain("Ratio"),  plain("Median"),  plain("Aim"),
                  plain("Lowest"), plain("Highest"), plain("Remark")};
  const JsonEntry values = object_if_any(bench, "ratios");
  const JsonEntry rounds = object_if_any(bench, "ratio_rounds");
  const JsonEntry missing = object_if_any(bench, "missing_ratios");
  for (const auto& [name, value] : values.members()) {
    double low = meshes::unknown, high = meshes::unknown;
    for (const double ratio : numbers_if_any(rounds, name)) {
      low = std::fmin(low, ratio);
      high = std::fmax(high, ratio);
    }
    Cell remark = plain(text_if_any(missing, name));
    remark.words = true;
    table.rows.push_back({plain(name), plain(number(value.number(), 3)), plain(aim_of(name)),
                          plain(number(low, 3)), plain(number(high, 3)), remark});
  }
  return table;
}

Chapter kernel_chapter(const JsonEntry& bench) {
  if (!bench.contains("kernels")) return {};
  ChapterData chapter("kernels");
  chapter.tables["ratios"] = ratio_table(bench);
  for (const char* list : {"kernels", "peers"}) chapter.tables[list] = kernel_table(bench, list);
  return written(std::move(chapter));
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
Chapter growth_chapter(const JsonEntry& bench) {
  const double held = number_if_any(object_if_any(bench, "probes"), "cache_L3") / 48.0;
  const auto [least, most] = costs_between(bench, 1e4, held);
  const auto beyond = costs_between(bench, held, 1e9);
  const bool both = std::isfinite(beyond.first) && std::isfinite(least);
  ChapterData chapter("growth");
  chapter["least"] = number(least, 3);
  chapter["most"] = number(most, 3);
  chapter["factor"] = most > least ? number(most / least, 3) : "";
  chapter["dram"] = number(dram_cost(bench), 3);
  chapter["sum"] = number(least + dram_cost(bench), 3);
  chapter["beyond"] = both ? number(beyond.second, 3) : "";
  chapter.figures = {growth_figure(bench), press_growth_figure(bench)};
  return written(std::move(chapter));
}

Chapter time_chapter(const JsonEntry& bench) {
  ChapterData chapter("times");
  Table table;
  table.header = {plain("What"), plain("Time"), plain("Remark")};
  for (const JsonEntry& entry : array_if_any(bench, "times"))
    table.rows.push_back({plain(text_if_any(entry, "what")),
                          plain(with_prefix(number_if_any(entry, "seconds"), "s")),
                          plain(entry.at("from_cache").flag() ? "from an earlier run" : "")});
  chapter.tables["times"] = std::move(table);
  return written(std::move(chapter));
}

Chapter machine_chapter(const JsonEntry& bench, const JsonList& history) {
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
  WordList missing;
  const JsonEntry programs = object_if_any(bench, "missing_programs");
  for (const auto& [program, why] : programs.members()) {
    missing.emplace_back()["program"] = program;
    missing.back()["why"] = why.text();
  }
  ChapterData chapter("machine");
  chapter["missing"] = std::move(missing);
  chapter.figures = {history_figure(history)};
  chapter.tables["facts"] = std::move(table);
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
