/// The published model's force: a property of its grid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

/// One lattice of the study: what was varied, its setting, and the errors at the depths.
struct Variant {
  std::string varied;
  double spacing, x, y, z, ligament;
  std::vector<double> depth, force, error;

  bool same_lattice(const Variant& other) const {
    return varied == other.varied && spacing == other.spacing && x == other.x && y == other.y &&
           z == other.z && ligament == other.ligament;
  }
  std::string offset() const { return fmt::format("({:.3g}, {:.3g}, {:.3g})", x, y, z); }
  std::string label() const {
    if (varied == "spacing") return with_unit(spacing, shown_units().length, 3);
    if (varied == "offset") return offset();
    return fmt::format("×{:.4g}", ligament);
  }
};

std::vector<Variant> read_variants(const std::vector<PublishedStudyRow>& study) {
  std::vector<Variant> variants;
  for (const PublishedStudyRow& row : study) {
    const Variant variant{row.varied,
                          row.spacing,
                          row.offset.x(),
                          row.offset.y(),
                          row.offset.z(),
                          row.ligament_stiffness,
                          {},
                          {},
                          {}};
    if (variants.empty() || !variants.back().same_lattice(variant)) variants.push_back(variant);
    variants.back().depth.push_back(row.indentation);
    variants.back().force.push_back(row.normal_force);
    variants.back().error.push_back(row.relative_error);
  }
  return variants;
}

std::vector<double> all_depths(const std::vector<Variant>& variants) {
  std::vector<double> depths;
  for (const Variant& variant : variants)
    depths.insert(depths.end(), variant.depth.begin(), variant.depth.end());
  std::sort(depths.begin(), depths.end());
  const auto close = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  depths.erase(std::unique(depths.begin(), depths.end(), close), depths.end());
  return depths;
}

Table study_table(const std::vector<Variant>& variants) {
  Table table;
  table.graded = true;
  table.header = {{"Varied", "", Grade::none},
                  plain("Spacing", unit_name(shown_units().length)),
                  {"Grid offset", "in spacings", Grade::none},
                  {"Ligaments", "stiffness ×", Grade::none}};
  const std::vector<double> depths = all_depths(variants);
  for (double depth : depths)
    table.header.push_back({"F", shown_units().length.text(depth), Grade::none});
  for (const Variant& variant : variants) {
    std::string varied = variant.varied;
    std::replace(varied.begin(), varied.end(), '_', ' ');
    std::vector<Cell> row{{varied, "", Grade::none},
                          {number(shown_units().length(variant.spacing)), "", Grade::none},
                          {variant.offset(), "", Grade::none},
                          {fmt::format("{:.4g}", variant.ligament), "", Grade::none}};
    for (double depth : depths) {
      Cell cell{"–", "", Grade::none};
      for (std::size_t i = 0; i < variant.depth.size(); ++i) {
        if (std::abs(variant.depth[i] - depth) > 1e-9) continue;
        cell = {number(shown_units().force(variant.force[i])), percent(variant.error[i]),
                grade(variant.error[i])};
      }
      row.push_back(cell);
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

Figure study_figure(const std::vector<Variant>& variants) {
  Figure figure{"published_study", 960, 430, 0, {}};
  double least = 0.0, most = 0.0;
  for (const Variant& variant : variants) {
    if (figure.panels.empty() || figure.panels.back().title != variant.varied) {
      Panel panel;
      panel.title = variant.varied;
      panel.x_label = shown_units().length.label("indentation");
      panel.y_label = "force error [%]";
      panel.key = "bottom right";
      figure.panels.push_back(panel);
    }
    std::vector<Series>& series = figure.panels.back().series;
    Series curve{variant.label(), variant.label(), {}, {}, {}, numbered_style(series.size())};
    for (std::size_t i = 0; i < variant.depth.size(); ++i) {
      curve.x.push_back(shown_units().length(variant.depth[i]));
      curve.y.push_back(100.0 * variant.error[i]);
      least = std::fmin(least, curve.y.back());
      most = std::fmax(most, curve.y.back());
    }
    series.push_back(std::move(curve));
  }
  // The same axis for all, with room for the legend below the curves.
  const double padding = 0.55 * (most - least) + 1.0;
  for (Panel& panel : figure.panels) {
    panel.y_range = Range{least - padding, most + 0.1 * padding};
    std::replace(panel.title.begin(), panel.title.end(), '_', ' ');
  }
  figure.columns = int(figure.panels.size());
  return figure;
}

}  // namespace

Chapter published_chapter(const RunData& run) {
  const std::vector<Variant> variants = read_variants(run.published_study);
  if (variants.empty()) return {};
  double least = meshes::unknown, most = meshes::unknown;
  for (const Variant& variant : variants)
    for (const double error : variant.error)
      least = std::fmin(least, error), most = std::fmax(most, error);
  ChapterData chapter("published");
  chapter["least"] = percent(least);
  chapter["most"] = percent(most);
  chapter.figures = {study_figure(variants)};
  chapter.tables["study"] = study_table(variants);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
