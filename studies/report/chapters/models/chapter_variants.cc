/// The presses of a study against their continua: figures, tables, and what they say in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/chapters/models/variant_figures.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

std::string full_name(const VariantPress& press) {
  const VariantRow& row = press.front();
  return (row.series.empty() ? "" : row.series + ", ") + row.name;
}

/// Presses with other samples than the first one leave their cells empty.
Table press_table(const std::vector<VariantPress>& presses) {
  const ShownUnits& units = shown_units();
  Table table{heads({"Press", "a\n" + unit_name(units.length)}), true};
  const VariantPress& first = presses.front();
  for (const VariantRow& row : first)
    table.header.emplace_back("F", units.length.text(row.indentation));
  table.header.emplace_back("Time", "s");
  for (const VariantPress& press : presses) {
    const VariantRow& own = press.front();
    std::vector<Cell> cells{{own.name, own.series}, number(units.length(own.spacing))};
    for (std::size_t d = 0; d < first.size(); ++d) {
      const bool same = d < press.size() && press[d].indentation == first[d].indentation;
      cells.push_back(
          same ? error_cell(press[d].relative_error, number(units.force(press[d].normal_force)))
               : Cell());
    }
    cells.emplace_back(number(own.wall_time, 2), own.status == "finished" ? "" : own.status);
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Table series_table(const StudyEntry& study, const std::vector<VariantPress>& presses,
                   bool refined) {
  Table table{heads({"Series", "Presses", "Largest error", "Spread"})};
  if (refined) table.header.insert(table.header.end(), {"Finest lattice", "Order"});
  for (const SeriesEntry& entry : study.series) {
    const auto count = std::ranges::count(
        presses, entry.name, [](const VariantPress& press) { return press.front().series; });
    std::vector<Cell> row{entry.name, std::to_string(count), percent_magnitude(entry.worst_error),
                          percent_magnitude(entry.spread)};
    if (refined)
      row.insert(row.end(), {percent_magnitude(entry.finest_error), number(entry.order, 2)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table continuum_table(const RunData& run, const std::vector<VariantPress>& presses) {
  const ShownUnit& stress = shown_units().stress;
  Table table{heads({"Continuum", "Contact", "E\n" + unit_name(stress), "G\n" + unit_name(stress),
                     "ν", "Presses", "Estimated error"})};
  for (const ContinuumEntry& entry : run.study.continua) {
    const auto count = std::ranges::count(
        presses, entry.folder, [](const VariantPress& press) { return press.front().continuum; });
    double error = meshes::unknown;  // the largest over the depths
    for (const VariantRow& row : run.variants)
      if (row.continuum == entry.folder) error = std::fmax(error, row.reference_error);
    table.rows.push_back({{entry.strain + " strain", entry.folder},
                          entry.contact,
                          number(stress(entry.youngs_modulus)),
                          number(stress(entry.shear_modulus)),
                          number(entry.poissons_ratio, 3),
                          std::to_string(count),
                          percent_magnitude(error)});
  }
  return table;
}

Table budget_table(const std::vector<BudgetEntry>& budgets) {
  if (budgets.empty()) return {};
  Table table{{"Press and part"}};
  for (const double depth : budgets.front().depths)
    table.header.emplace_back("share", shown_units().length.text(depth));
  const auto add = [&](const std::string& what, const std::string& of,
                       const std::vector<double>& values) {
    std::vector<Cell> row{{what, of}};
    for (const double value : values) row.emplace_back(percent(value));
    row.resize(table.header.size());
    table.rows.push_back(std::move(row));
  };
  for (const BudgetEntry& budget : budgets) {
    for (const PartEntry& part : budget.parts) add(part.series, budget.name, part.share);
    add("rest", budget.name, budget.rest);
    add("total", budget.name, budget.total);
  }
  return table;
}

/// What refining the series with an order does. One slope would hide a floor that the error has
/// reached: the last refinement is told apart.
WordList refinements(const StudyEntry& study, const std::vector<VariantPress>& presses) {
  const auto spacing = [](const VariantPress& press) { return press.front().spacing; };
  WordList all;
  for (const SeriesEntry& entry : study.series) {
    if (!std::isfinite(entry.order)) continue;
    std::vector<VariantPress> own;
    for (const VariantPress& press : presses)
      if (press.front().series == entry.name && std::isfinite(worst_error(press)))
        own.push_back(press);
    if (own.size() < 2) continue;
    std::ranges::sort(own, std::greater(), spacing);
    const VariantPress &coarse = own.front(), &before = own[own.size() - 2], &fine = own.back();
    const double last = std::log(worst_error(before) / worst_error(fine)) /
                        std::log(spacing(before) / spacing(fine));
    TemplateData& words = all.emplace_back();
    words["series"] = entry.name;
    words["falls"] = worst_error(fine) < worst_error(coarse);
    words["coarse"] = coarse.front().name;
    words["coarse_error"] = percent_magnitude(worst_error(coarse));
    words["before"] = before.front().name;
    words["fine"] = fine.front().name;
    words["fine_error"] = percent_magnitude(worst_error(fine));
    words["order"] = number(entry.order, 2);
    words["last_order"] = number(last, 2);
  }
  return all;
}

void add_figures(ChapterData& chapter, const RunData& run) {
  const std::string x = run.study.x_label.empty() ? "x" : run.study.x_label;
  Figure against_x = variant_error_figure(run.variants, x);
  WordList depths;
  if (against_x.panels.empty()) {
    chapter.figures = variant_depth_figures(run.variants);
    for (const std::string& series : distinct(run.variants, &VariantRow::series)) {
      TemplateData& words = depths.emplace_back();
      words["figure"] = chapter.figures[depths.size() - 1].name;
      words["series"] = series;
    }
  }
  chapter["x"] = x;
  chapter["depths"] = std::move(depths);
  chapter.figures.push_back(convergence_figure(run.variants, run.study));
  chapter.figures.push_back(std::move(against_x));
  chapter.figures.push_back(variant_force_figure(run.variants));
}

/// Programs: what followed the first loading.
void add_later_figures(ChapterData& chapter, const std::vector<LaterRow>& table) {
  WordList all;
  const std::vector<std::string> series = distinct(table, &LaterRow::series);
  for (Figure& figure : variant_later_figures(table)) {
    TemplateData& words = all.emplace_back();
    words["figure"] = figure.name;
    words["series"] = series[all.size() - 1];
    chapter.figures.push_back(std::move(figure));
  }
  chapter["later"] = std::move(all);
}

}  // namespace

std::string variants_answer(const RunData& run) {
  const std::vector<VariantPress> presses = presses_of(run.variants);
  const VariantPress* worst = largest_in(presses, worst_error);
  const VariantPress* best =
      largest_in(presses, [](const VariantPress& press) { return -worst_error(press); });
  TemplateData words;
  words["complete"] = best != nullptr;
  words["presses"] = std::to_string(presses.size());
  words["best"] = best ? full_name(*best) : "";
  words["best_error"] = best ? percent_magnitude(worst_error(*best)) : "";
  words["worst"] = best ? full_name(*worst) : "";
  words["worst_error"] = best ? percent_magnitude(worst_error(*worst)) : "";
  return sentences("answer_variants", words);
}

Chapter variants_chapter(const RunData& run) {
  const std::vector<VariantPress> presses = presses_of(run.variants);
  if (presses.empty()) return {};
  const bool refined = std::ranges::any_of(
      run.study.series, [](const SeriesEntry& entry) { return std::isfinite(entry.order); });
  ChapterData chapter("variants");
  chapter["presses"] = std::to_string(presses.size());
  chapter["continua"] = std::to_string(run.study.continua.size());
  WordList series = refinements(run.study, presses);
  chapter["converges"] = !series.empty();
  chapter["refinements"] = std::move(series);
  chapter["refined"] = refined;
  add_figures(chapter, run);
  add_later_figures(chapter, run.later);
  chapter.tables["budgets"] = budget_table(run.study.budgets);
  chapter.tables["series"] = series_table(run.study, presses, refined);
  chapter.tables["presses"] = press_table(presses);
  chapter.tables["continua"] = continuum_table(run, presses);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
