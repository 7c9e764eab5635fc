/// The presses of a study against their continua: figures, tables, and what they say in words.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/chapters/models/variant_figures.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

std::string full_name(const VariantPress& press) {
  return press.series.empty() ? press.name : press.series + ", " + press.name;
}

/// Presses with other samples than the first one leave their cells empty.
Table press_table(const std::vector<VariantPress>& presses) {
  Table table;
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

Table series_table(const StudyEntry& study, const std::vector<VariantPress>& presses,
                   bool refined) {
  Table table;
  table.header = {plain("Series"), plain("Presses"), plain("Largest error"), plain("Spread")};
  if (refined) table.header.insert(table.header.end(), {plain("Finest lattice"), plain("Order")});
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
  if (budgets.empty()) return table;
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

/// What refining the series with an order does. One slope would hide a floor that the error has
/// reached: the last refinement is told apart.
WordList refinements(const StudyEntry& study, const std::vector<VariantPress>& presses) {
  WordList all;
  for (const SeriesEntry& entry : study.series) {
    if (!std::isfinite(entry.order)) continue;
    std::vector<const VariantPress*> own;
    for (const VariantPress& press : presses)
      if (press.series == entry.name && std::isfinite(press.worst())) own.push_back(&press);
    if (own.size() < 2) continue;
    std::ranges::sort(own, std::greater(), &VariantPress::spacing);
    const VariantPress &coarse = *own.front(), &before = *own[own.size() - 2], &fine = *own.back();
    const double last =
        std::log(before.worst() / fine.worst()) / std::log(before.spacing / fine.spacing);
    Words& words = all.emplace_back();
    words["series"] = std::string(entry.name);
    words["falls"] = fine.worst() < coarse.worst();
    words["coarse"] = coarse.name;
    words["coarse_error"] = percent_magnitude(coarse.worst());
    words["before"] = before.name;
    words["fine"] = fine.name;
    words["fine_error"] = percent_magnitude(fine.worst());
    words["order"] = number(entry.order, 2);
    words["last_order"] = number(last, 2);
  }
  return all;
}

void add_figures(ChapterData& chapter, const StudyEntry& study,
                 const std::vector<VariantPress>& presses) {
  const std::string x = study.x_label.empty() ? "x" : study.x_label;
  Figure against_x = variant_error_figure(presses, x);
  WordList depths;
  if (against_x.panels.empty()) {
    chapter.figures = variant_depth_figures(presses);
    for (const std::string& series : series_of(presses)) {
      Words& words = depths.emplace_back();
      words["figure"] = chapter.figures[depths.size() - 1].name;
      words["series"] = series;
    }
  }
  chapter["x"] = x;
  chapter["depths"] = std::move(depths);
  chapter.figures.push_back(convergence_figure(presses, study));
  chapter.figures.push_back(std::move(against_x));
  chapter.figures.push_back(variant_force_figure(presses));
}

/// Programs: what followed the first loading.
void add_later_figures(ChapterData& chapter, const std::vector<LaterRow>& table) {
  WordList all;
  const std::vector<std::string> series = series_of(table);
  for (Figure& figure : variant_later_figures(table)) {
    Words& words = all.emplace_back();
    words["figure"] = figure.name;
    words["series"] = series[all.size() - 1];
    chapter.figures.push_back(std::move(figure));
  }
  chapter["later"] = std::move(all);
}

}  // namespace

std::string variants_answer(const RunData& run) {
  const std::vector<VariantPress> presses = read_variants(run.variants);
  const VariantPress *best = extreme(presses, -1.0), *worst = extreme(presses, 1.0);
  Words words;
  words["complete"] = best != nullptr;
  words["presses"] = std::to_string(presses.size());
  words["best"] = best ? full_name(*best) : "";
  words["best_error"] = best ? percent_magnitude(best->worst()) : "";
  words["worst"] = best ? full_name(*worst) : "";
  words["worst_error"] = best ? percent_magnitude(worst->worst()) : "";
  return sentences("answer_variants", words);
}

Chapter variants_chapter(const RunData& run) {
  const std::vector<VariantPress> presses = read_variants(run.variants);
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
  add_figures(chapter, run.study, presses);
  add_later_figures(chapter, run.later);
  chapter.tables["budgets"] = budget_table(run.study.budgets);
  chapter.tables["series"] = series_table(run.study, presses, refined);
  chapter.tables["presses"] = press_table(presses);
  chapter.tables["continua"] = continuum_table(run, presses);
  return written(std::move(chapter));
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

}  // namespace fingertip::studies::report::inline chapters::inline models
