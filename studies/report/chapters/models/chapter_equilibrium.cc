/// The lattice without time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

/// One static press of the study, with its errors at the depths.
struct StaticLattice {
  std::string model;
  double spacing = 0.0;
  std::vector<double> depth, force, error;

  std::string label() const {
    return fmt::format("{}, a = {}", model, with_unit(spacing, shown_units().length, 3));
  }
  /// Largest |error|; NaN when there is none.
  double worst() const { return largest_magnitude(error); }
};

/// By model, coarse to fine.
std::vector<StaticLattice> read_lattices(const std::vector<EquilibriumStudyRow>& study) {
  std::vector<StaticLattice> lattices;
  for (const EquilibriumStudyRow& row : study) {
    const bool next = lattices.empty() || lattices.back().model != row.model ||
                      lattices.back().spacing != row.spacing;
    if (next) lattices.push_back({row.model, row.spacing, {}, {}, {}});
    lattices.back().depth.push_back(row.indentation);
    lattices.back().force.push_back(row.normal_force);
    lattices.back().error.push_back(row.relative_error);
  }
  std::ranges::stable_sort(lattices, [](const StaticLattice& a, const StaticLattice& b) {
    return a.model != b.model ? a.model < b.model : a.spacing > b.spacing;
  });
  return lattices;
}

Table force_table(const std::vector<StaticLattice>& lattices) {
  Table table;
  table.graded = true;
  table.header = {{"Lattice", "", Grade::none}, plain("Spacing", unit_name(shown_units().length))};
  for (const double depth : lattices.front().depth)
    table.header.push_back({"F", shown_units().length.text(depth), Grade::none});
  for (const StaticLattice& lattice : lattices) {
    std::vector<Cell> row{{lattice.model, "", Grade::none},
                          {number(shown_units().length(lattice.spacing)), "", Grade::none}};
    for (std::size_t i = 0; i < lattice.depth.size(); ++i)
      row.push_back({number(shown_units().force(lattice.force[i])), percent(lattice.error[i]),
                     grade(lattice.error[i])});
    table.rows.push_back(std::move(row));
  }
  return table;
}

Figure error_figure(const std::vector<StaticLattice>& lattices, const RunData& run) {
  Panel panel;
  panel.x_label = shown_units().length.label("indentation");
  panel.y_label = "force error [%]";
  panel.key = "bottom right";
  double least = 0.0, most = 0.0;
  const auto add = [&](const std::string& label, const std::vector<double>& depth,
                       const std::vector<double>& error, const Style& style) {
    Series curve{label, label, {}, {}, {}, style};
    for (std::size_t i = 0; i < depth.size(); ++i) {
      curve.x.push_back(shown_units().length(depth[i]));
      curve.y.push_back(100.0 * error[i]);
      least = std::fmin(least, curve.y.back());
      most = std::fmax(most, curve.y.back());
    }
    panel.series.push_back(std::move(curve));
  };
  for (std::size_t i = 0; i < lattices.size(); ++i) {
    // A model keeps its colour; points and dashes tell its spacings apart.
    Style style = numbered_style(i);
    style.colour = model_style(lattices[i].model).colour;
    add(lattices[i].label(), lattices[i].depth, lattices[i].error, style);
  }
  if (const ModelData* moving = run.model("hookean"); moving && !moving->force_error.empty()) {
    add("hookean, moving", run.depths, moving->force_error, {"#777777", "(4,3)", 2.2, 0, true});
  }
  panel.band = Band{-1.0, 1.0};
  const double padding = 0.6 * (most - least) + 1.0;
  panel.y_range = Range{least - padding, most + 0.1 * padding};
  return {"equilibrium_error", 760, 430, 1, {panel}};
}

/// The finest hookean lattice of the study; nullptr without one.
const StaticLattice* finest_hookean(const std::vector<StaticLattice>& lattices) {
  const auto finest =
      std::ranges::find_if(lattices.rbegin(), lattices.rend(),
                           [](const StaticLattice& lattice) { return lattice.model == "hookean"; });
  return finest == lattices.rend() ? nullptr : &*finest;
}

}  // namespace

Chapter equilibrium_chapter(const RunData& run) {
  const std::vector<StaticLattice> lattices = read_lattices(run.equilibrium_study);
  if (lattices.empty()) return {};
  ChapterData chapter("equilibrium");
  chapter["worst"] = chapter["spacing"] = "";
  if (const StaticLattice* finest = finest_hookean(lattices);
      finest && !std::isnan(finest->worst())) {
    chapter["spacing"] = with_unit(finest->spacing, shown_units().length, 3);
    chapter["worst"] = percent_magnitude(finest->worst());
  }
  chapter.figures = {error_figure(lattices, run)};
  chapter.tables["forces"] = force_table(lattices);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
