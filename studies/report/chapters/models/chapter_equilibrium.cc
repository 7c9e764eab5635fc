/// The lattice without time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

/// One static press of the study, with its errors at the depths.
using StaticLattice = std::span<const EquilibriumStudyRow>;

/// By model, coarse to fine.
std::vector<StaticLattice> lattices_of(const std::vector<EquilibriumStudyRow>& study) {
  std::vector<StaticLattice> lattices =
      grouped(study, [](const EquilibriumStudyRow& a, const EquilibriumStudyRow& b) {
        return a.model == b.model && a.spacing == b.spacing;
      });
  std::ranges::stable_sort(lattices, [](const StaticLattice& a, const StaticLattice& b) {
    return std::pair(a.front().model, -a.front().spacing) <
           std::pair(b.front().model, -b.front().spacing);
  });
  return lattices;
}

Table force_table(const std::vector<StaticLattice>& lattices) {
  Table table{heads({"Lattice", "Spacing\n" + unit_name(shown_units().length)}), true};
  for (const EquilibriumStudyRow& row : lattices.front())
    table.header.emplace_back("F", shown_units().length.text(row.indentation));
  for (const StaticLattice& lattice : lattices) {
    std::vector<Cell> cells{lattice.front().model,
                            number(shown_units().length(lattice.front().spacing))};
    for (const EquilibriumStudyRow& row : lattice)
      cells.emplace_back(number(shown_units().force(row.normal_force)), percent(row.relative_error),
                         grade(row.relative_error));
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Figure error_figure(const std::vector<StaticLattice>& lattices, const RunData& run) {
  const ShownUnit& length = shown_units().length;
  Panel panel = over_indentation("force error [%]", "bottom right");
  panel.band = Band{-1.0, 1.0};
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    const EquilibriumStudyRow& first = lattices[i].front();
    // A model keeps its colour; points and dashes tell its spacings apart.
    Style style = numbered_style(i);
    style.colour = model_style(first.model).colour;
    const std::string label =
        fmt::format("{}, a = {}", first.model, with_unit(first.spacing, length, 3));
    panel.series.push_back(curve(label, label, style, lattices[i],
                                 in(length, &EquilibriumStudyRow::indentation),
                                 in_percent(&EquilibriumStudyRow::relative_error)));
  }
  if (const ModelData* moving = run.model("hookean"); moving && !moving->force_error.empty()) {
    Series& series = panel.series.emplace_back(
        Series{"hookean, moving", "hookean, moving", {"#777777", "(4,3)", 2.2}});
    for (std::size_t i = 0; i < run.depths.size(); ++i)
      series.add(length(run.depths[i]), 100.0 * moving->force_error[i]);
  }
  Range errors = extent_of(panel.series, &Series::y);
  errors.include(0.0);
  const double padding = 0.6 * (errors.to - errors.from) + 1.0;
  panel.y_range = Range{errors.from - padding, errors.to + 0.1 * padding};
  return {"equilibrium_error", 760, 430, 1, {panel}};
}

}  // namespace

Chapter equilibrium_chapter(const RunData& run) {
  const std::vector<StaticLattice> lattices = lattices_of(run.equilibrium_study);
  if (lattices.empty()) return {};
  ChapterData chapter("equilibrium");
  chapter["worst"] = chapter["spacing"] = "";
  const auto finest =
      std::find_if(lattices.rbegin(), lattices.rend(),
                   [](const StaticLattice& lattice) { return lattice.front().model == "hookean"; });
  if (finest != lattices.rend()) {
    const double worst = largest_of(*finest, &EquilibriumStudyRow::relative_error);
    chapter["spacing"] =
        if_known(worst, with_unit(finest->front().spacing, shown_units().length, 3));
    chapter["worst"] = if_known(worst, percent_magnitude(worst));
  }
  chapter.figures = {error_figure(lattices, run)};
  chapter.tables["forces"] = force_table(lattices);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
