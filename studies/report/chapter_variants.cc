/// The presses of a study against their continua: figures, tables, and what they say in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "studies/report/chapters.h"
#include "studies/report/variant_data.h"

namespace fingertip::studies::reporting {
namespace {

std::string full_name(const VariantPress& press) {
  return press.series.empty() ? press.name : press.series + ", " + press.name;
}

/// Presses with other samples than the first one leave their cells empty.
Table press_table(const std::vector<VariantPress>& presses) {
  Table table;
  table.caption =
      "Error of the normal force against the press's own continuum at each indentation, the force "
      "below it in " +
      unit_name(shown_units().force) + ". Time: one thread, when the press was computed.";
  table.graded = true;
  table.header = {plain("Press"), plain("a", unit_name(shown_units().length))};
  const std::vector<double>& depths = presses.front().depth;
  for (const double depth : depths)
    table.header.push_back(plain("F", shown_units().length.text(depth)));
  table.header.push_back(plain("Time", "s"));
  for (const VariantPress& press : presses) {
    std::vector<Cell> row{plain(press.name, press.series),
                          plain(number(shown_units().length(press.spacing)))};
    for (std::size_t d = 0; d < depths.size(); ++d) {
      const bool same = d < press.depth.size() && press.depth[d] == depths[d];
      row.push_back(same ? Cell{percent(press.error[d]),
                                number(shown_units().force(press.force[d])), grade(press.error[d])}
                         : plain(""));
    }
    row.push_back(
        plain(number(press.wall_time, 2), press.status == "finished" ? "" : press.status));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table series_table(const StudyEntry& study, const std::vector<VariantPress>& presses) {
  const bool refined = std::ranges::any_of(
      study.series, [](const SeriesEntry& entry) { return std::isfinite(entry.order); });
  Table table;
  table.caption =
      "Series by series: the largest force error of all its presses, and how far errors at one "
      "depth lie apart.";
  table.header = {plain("Series"), plain("Presses"), plain("Largest error"), plain("Spread")};
  if (refined) {
    table.caption +=
        " Of series that are refined, the largest error of the finest lattice and the observed "
        "order, the slope of the largest error against the spacing in logarithms.";
    table.header.insert(table.header.end(), {plain("Finest lattice"), plain("Order")});
  }
  for (const SeriesEntry& entry : study.series) {
    const std::string name = entry.name;
    const auto count = std::ranges::count(presses, name, &VariantPress::series);
    std::vector<Cell> row{plain(name), plain(std::to_string(count)),
                          plain(percent_magnitude(entry.worst_error)),
                          plain(percent_magnitude(entry.spread))};
    if (refined) {
      row.push_back(plain(percent_magnitude(entry.finest_error)));
      row.push_back(plain(number(entry.order, 2)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

/// Estimated errors of the continua, the largest over the depths.
std::map<std::string, double> continuum_errors(const std::vector<VariantRow>& table) {
  std::map<std::string, double> worst;
  for (const VariantRow& row : table) {
    const auto [entry, added] = worst.insert({row.continuum, row.reference_error});
    entry->second = std::fmax(entry->second, row.reference_error);
  }
  return worst;
}

Table continuum_table(const RunData& run, const std::vector<VariantPress>& presses) {
  Table table;
  table.caption =
      "The continua, each with its largest estimated error over the indentations. At finite strain "
      "the material is law A, the one the network stands for.";
  table.header = {plain("Continuum"),
                  plain("Contact"),
                  plain("E", unit_name(shown_units().stress)),
                  plain("G", unit_name(shown_units().stress)),
                  plain("ν"),
                  plain("Presses"),
                  plain("Estimated error")};
  const std::map<std::string, double> errors = continuum_errors(run.variants);
  for (const ContinuumEntry& entry : run.study.continua) {
    const std::string folder = entry.folder;
    const auto count = std::ranges::count(presses, folder, &VariantPress::continuum);
    const auto error = errors.find(folder);
    table.rows.push_back({plain(entry.strain + " strain", folder), plain(entry.contact),
                          plain(number(shown_units().stress(entry.youngs_modulus))),
                          plain(number(shown_units().stress(entry.shear_modulus))),
                          plain(number(entry.poissons_ratio, 3)), plain(std::to_string(count)),
                          plain(error == errors.end() ? "–" : percent_magnitude(error->second))});
  }
  return table;
}

Table budget_table(const std::vector<BudgetEntry>& budgets) {
  Table table;
  table.caption =
      "Where the force error comes from. A tie's share is the error with the tie as it is minus "
      "the error continued to a rigid tie from softer ones; the rest is the interior and what "
      "stiff ties lock.";
  table.header = {plain("Press and part")};
  const std::vector<double> depths = budgets.front().depths;
  for (const double depth : depths)
    table.header.push_back(plain("share", shown_units().length.text(depth)));
  const auto add = [&](const std::string& what, const std::string& of,
                       const std::vector<double>& values) {
    std::vector<Cell> row{plain(what, of)};
    for (const double value : values) row.push_back(plain(percent(value)));
    row.resize(table.header.size(), plain(""));
    table.rows.push_back(std::move(row));
  };
  for (const BudgetEntry& budget : budgets) {
    const std::string name = budget.name;
    for (const PartEntry& part : budget.parts) add(part.series, name, part.share);
    add("rest", name, budget.rest);
    add("total", name, budget.total);
  }
  return table;
}

/// The press whose largest error is largest (sign 1) or smallest (-1); nullptr without any.
const VariantPress* extreme(const std::vector<VariantPress>& presses, double sign) {
  const VariantPress* found = nullptr;
  for (const VariantPress& press : presses) {
    if (!std::isfinite(press.worst())) continue;
    if (found == nullptr || sign * press.worst() > sign * found->worst()) found = &press;
  }
  return found;
}

/// What refining a series does, in words; empty without an order. One slope would hide a floor that
/// the error has reached: the last refinement is told apart.
std::string refinement(const SeriesEntry& entry, const std::vector<VariantPress>& presses) {
  const std::string name = entry.name;
  const double order = entry.order;
  if (!std::isfinite(order)) return "";
  std::vector<const VariantPress*> own;
  for (const VariantPress& press : presses)
    if (press.series == name && std::isfinite(press.worst())) own.push_back(&press);
  std::ranges::sort(own, std::greater(), &VariantPress::spacing);
  const VariantPress &coarse = *own.front(), &before = *own[own.size() - 2], &fine = *own.back();
  const double last =
      std::log(before.worst() / fine.worst()) / std::log(before.spacing / fine.spacing);
  return fmt::format(
      " {}: the largest error {} from {} at {} to {} at {}, order {}; from {} to {} alone, order "
      "{}.",
      name, fine.worst() < coarse.worst() ? "falls" : "goes", percent_magnitude(coarse.worst()),
      coarse.name, percent_magnitude(fine.worst()), fine.name, number(order, 2), before.name,
      fine.name, number(last, 2));
}

Paragraph method(const RunData& run, const std::vector<VariantPress>& presses) {
  return {"What is compared.",
          fmt::format("{} static presses of lattices, each against the continuum of the same "
                      "specimen, contact and kinematics ({} in all, listed below). Spacing, "
                      "offset, rotation and model of the lattice do not matter to the continuum, "
                      "so presses that differ in these alone share one.",
                      presses.size(), run.study.continua.size())};
}

void add_figures(Chapter& chapter, const RunData& run, const std::vector<VariantPress>& presses) {
  const std::string label = run.study.x_label;
  const auto add = [&](Figure figure, const std::string& title, const std::string& caption) {
    if (!figure.panels.empty()) chapter.blocks.push_back(FigureBlock{figure, title, caption});
  };
  add(convergence_figure(presses, run.study), "Largest force error against spacing",
      "Largest magnitude over the indentations, both axes logarithmic; the order in the legend is "
      "the slope of the straight line that fits best.");
  Figure against_x = variant_error_figure(presses, label.empty() ? "x" : label);
  const bool has_x = !against_x.panels.empty();
  add(std::move(against_x), "Force error against " + (label.empty() ? "x" : label),
      "At up to four of the indentations. The band is one per cent.");
  if (!has_x) {
    const std::vector<std::string> series = series_of(presses);
    std::vector<Figure> figures = variant_depth_figures(presses);
    for (std::size_t i = 0; i < figures.size(); ++i)
      add(std::move(figures[i]),
          "Force error against indentation" + (series[i].empty() ? "" : ": " + series[i]),
          "Every press beside its own continuum. The band is one per cent.");
  }
  add(variant_force_figure(presses), "Force against indentation",
      "Dashed black: the continua that the presses are measured against.");
}

}  // namespace

std::string variants_answer(const RunData& run) {
  const std::vector<VariantPress> presses = read_variants(run.variants);
  const VariantPress *best = extreme(presses, -1.0), *worst = extreme(presses, 1.0);
  if (best == nullptr) return "No press got far enough to be compared.";
  return fmt::format(
      "Of {} static presses, the one nearest to its continuum is {}, within {} at every "
      "indentation; the farthest is {}, off by up to {}.",
      presses.size(), full_name(*best), percent_magnitude(best->worst()), full_name(*worst),
      percent_magnitude(worst->worst()));
}

Chapter variants_chapter(const RunData& run) {
  Chapter chapter{"variants", "Presses against their continua", {}};
  const std::vector<VariantPress> presses = read_variants(run.variants);
  if (presses.empty()) return chapter;
  chapter.blocks.push_back(method(run, presses));
  std::string orders;
  for (const SeriesEntry& entry : run.study.series) orders += refinement(entry, presses);
  if (!orders.empty()) chapter.blocks.push_back(Paragraph{"Convergence.", orders.substr(1)});
  add_figures(chapter, run, presses);
  const std::vector<BudgetEntry>& budgets = run.study.budgets;
  if (!budgets.empty()) chapter.blocks.push_back(budget_table(budgets));
  if (!run.study.series.empty()) chapter.blocks.push_back(series_table(run.study, presses));
  chapter.blocks.push_back(press_table(presses));
  chapter.blocks.push_back(continuum_table(run, presses));
  return chapter;
}

std::string variants_text(const RunData& run) {
  std::string text;
  for (const VariantPress& press : read_variants(run.variants)) {
    text += fmt::format("{:<44}", full_name(press).substr(0, 43));
    for (const double error : press.error)
      text += std::isfinite(error) ? fmt::format("{:>9.2f} %", 100.0 * error)
                                   : fmt::format("{:>11}", "-");
    text += "\n";
  }
  return text + "error of the force against the continuum at the samples of each press\n";
}

}  // namespace fingertip::studies::reporting
