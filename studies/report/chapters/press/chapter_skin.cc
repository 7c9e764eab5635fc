/// What a skin of taxels feels.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "studies/report/chapters/press/press_chapters.h"

namespace fingertip::studies::report::inline chapters::inline press {
namespace {

using meshes::TaxelRow;
using Taxels = std::span<const TaxelRow>;

constexpr std::size_t pixels = 240;
constexpr double shown_reach = 1.4;  ///< over the radius of a disc of the taxel's area

double radius_of(const TaxelRow& taxel) {
  return std::sqrt(taxel.area / std::numbers::pi);
}
double shear_of(const TaxelRow& taxel) {
  return std::hypot(taxel.shear_u, taxel.shear_v);
}

/// Taxels seen along the rod, in the colours of a stress.
Panel skin_panel(const std::string& title, const char* what, Taxels taxels, double highest,
                 const auto& value) {
  const ShownUnit &length = shown_units().length, &stress = shown_units().stress;
  double reach = 0.0;
  for (const TaxelRow& taxel : taxels)
    reach = std::max(reach, taxel.place.head<2>().norm() + shown_reach * radius_of(taxel));
  Panel panel{.title = title,
              .x_label = length.label("x"),
              .y_label = length.label("y"),
              .equal_scales = true,
              .key = ""};
  HeatMap colours{{}, {0.0, stress(std::max(highest, 1e-9))}, stress.label(what), false};
  GridFunction& grid = colours.function;
  grid.values.assign(pixels, std::vector<double>(pixels, meshes::unknown));
  const double pixel = 2.0 * reach / (pixels - 1);
  for (std::size_t i = 0; i < pixels; ++i) grid.x.push_back(length(-reach + double(i) * pixel));
  grid.y = grid.x;
  // A place is its nearest taxel's, unless that is far.
  std::vector<std::vector<double>> nearest(pixels, std::vector<double>(pixels, 1.0));
  const auto place = [&](std::size_t i) { return -reach + double(i) * pixel; };
  const auto cells = [&](double middle, double radius) {
    const double first = std::max(0.0, std::ceil((middle - radius + reach) / pixel)),
                 end = std::floor((middle + radius + reach) / pixel) + 1.0;
    return std::pair(std::size_t(first), std::min(pixels, std::size_t(std::max(0.0, end))));
  };
  for (const TaxelRow& taxel : taxels) {
    const double radius = std::max(shown_reach * radius_of(taxel), pixel);
    const auto [left, right] = cells(taxel.place.x(), radius);
    const auto [low, high] = cells(taxel.place.y(), radius);
    for (std::size_t i = left; i < right; ++i)
      for (std::size_t j = low; j < high; ++j) {
        const double away = std::hypot(place(i) - taxel.place.x(), place(j) - taxel.place.y());
        if (away > radius || away > nearest[i][j]) continue;
        nearest[i][j] = away;
        grid.values[i][j] = stress(value(taxel));
      }
  }
  panel.x_range = panel.y_range = Range{length(-reach), length(reach)};
  panel.map = std::move(colours);
  return panel;
}

void add_arrows(Panel& panel, Taxels taxels, double highest) {
  for (const TaxelRow& taxel : taxels) {
    if (shear_of(taxel) < 0.05 * highest) continue;
    const double way = 1.8 * radius_of(taxel) / highest;
    const ShownUnit& length = shown_units().length;
    panel.arrows.push_back({length(taxel.place.x()), length(taxel.place.y()),
                            length(taxel.place.x() + way * taxel.shear_u),
                            length(taxel.place.y() + way * taxel.shear_v), "#D55E00"});
  }
}

/// Force that the skin feels over the indentation, of a press's samples.
Series felt_series(const RunContact& run) {
  Series series{run.label.empty() ? "skin" : run.label + ", skin", "", run.style.as_points(7)};
  for (const Taxels sample : meshes::samples_of(*run.taxels))
    if (std::size_t(sample.front().sample) <= run.response->pressing().size())
      series.add(shown_units().length(sample.front().indentation),
                 shown_units().force(felt_force(sample)));
  return series;
}

Figure force_figure(const std::vector<RunContact>& runs) {
  const ShownUnit &length = shown_units().length, &force = shown_units().force;
  Panel panel{.x_label = length.label("indentation"), .y_label = force.label("normal force")};
  for (const RunContact& run : runs) {
    panel.series.push_back(curve(run.label.empty() ? "whole contact" : run.label, "",
                                 run.style.as_line(), run.response->pressing(),
                                 in(length, &meshes::PressSample::indentation),
                                 in(force, &meshes::PressSample::normal_force)));
    panel.series.push_back(felt_series(run));
  }
  return {"skin_force", 760, 380, 1, {std::move(panel)}};
}

double highest_of(Taxels taxels, const auto& value) {
  double largest = 0.0;
  for (const TaxelRow& taxel : taxels) largest = std::max(largest, double(value(taxel)));
  return largest;
}

double normal_stress_of(const TaxelRow& taxel) {
  return taxel.normal_stress;
}

}  // namespace

Chapter skin_chapter(const std::vector<RunContact>& runs, const std::string& name,
                     std::size_t number) {
  for (const RunContact& run : runs)
    if (run.taxels == nullptr || run.taxels->empty()) return {};
  std::vector<Taxels> felt;
  for (const RunContact& run : runs) felt.push_back(meshes::samples_of(*run.taxels).back());
  const Taxels first = felt.front();
  const auto is_other = [&](Taxels taxels) {
    return taxels.size() != first.size() || taxels.front().sample != first.front().sample;
  };
  if (std::ranges::any_of(felt, is_other)) return {};
  double highest = 0.0, sheared = 0.0;
  for (const Taxels taxels : felt) {
    highest = std::max(highest, highest_of(taxels, normal_stress_of));
    sheared = std::max(sheared, highest_of(taxels, shear_of));
  }
  const bool is_sheared = sheared > 1e-3 * highest;
  ChapterData chapter("skin");
  chapter["count"] = std::to_string(first.size());
  chapter["depth"] = length(first.front().indentation);
  chapter["sheared"] = is_sheared;
  chapter["compared"] = runs.size() > 1;
  // A column per run, or per stress of the only one.
  Figure map{"skin_map", 0, 0, runs.size() > 1 ? int(runs.size()) : is_sheared ? 2 : 1, {}, 130};
  for (std::size_t i = 0; i < runs.size(); ++i)
    map.panels.push_back(
        skin_panel(runs[i].label, "normal stress", felt[i], highest, normal_stress_of));
  for (std::size_t i = 0; i < runs.size() && is_sheared; ++i) {
    map.panels.push_back(skin_panel(runs[i].label, "shear", felt[i], sheared, shear_of));
    add_arrows(map.panels.back(), felt[i], sheared);
  }
  const int rows = (int(map.panels.size()) + map.columns - 1) / map.columns;
  map.width = map.columns == 1 ? 560 : 480 * map.columns;
  map.height = 60 + 380 * rows;
  chapter.figures = {std::move(map), force_figure(runs)};
  return written_of(std::move(chapter), name, number);
}

}  // namespace fingertip::studies::report::inline chapters::inline press
