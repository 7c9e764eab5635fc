/// The published model's force: a property of its grid.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "studies/report/chapters/models/model_chapters.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline models {
namespace {

/// One lattice of the study, with its errors at the depths.
using Variant = std::span<const PublishedStudyRow>;

bool same_lattice(const PublishedStudyRow& a, const PublishedStudyRow& b) {
  return a.varied == b.varied && a.spacing == b.spacing && a.offset == b.offset &&
         a.ligament_stiffness == b.ligament_stiffness;
}

std::string offset_of(const PublishedStudyRow& row) {
  return fmt::format("({:.3g}, {:.3g}, {:.3g})", row.offset.x(), row.offset.y(), row.offset.z());
}

/// What the lattice has of what is varied.
std::string label_of(const PublishedStudyRow& row) {
  if (row.varied == "spacing") return with_unit(row.spacing, shown_units().length, 3);
  return row.varied == "offset" ? offset_of(row) : fmt::format("×{:.4g}", row.ligament_stiffness);
}

std::string in_words(std::string varied) {
  std::ranges::replace(varied, '_', ' ');
  return varied;
}

std::vector<double> all_depths(const std::vector<PublishedStudyRow>& study) {
  std::vector<double> depths = column(study, &PublishedStudyRow::indentation);
  std::ranges::sort(depths);
  const auto close = [](double a, double b) { return std::abs(a - b) < 1e-9; };
  depths.erase(std::unique(depths.begin(), depths.end(), close), depths.end());
  return depths;
}

Table study_table(const std::vector<PublishedStudyRow>& study) {
  Table table{heads({"Varied", "Spacing\n" + unit_name(shown_units().length),
                     "Grid offset\nin spacings", "Ligaments\nstiffness ×"}),
              true};
  const std::vector<double> depths = all_depths(study);
  for (double depth : depths) table.header.emplace_back("F", shown_units().length.text(depth));
  for (const Variant& variant : grouped(study, same_lattice)) {
    const PublishedStudyRow& first = variant.front();
    std::vector<Cell> cells{in_words(first.varied), number(shown_units().length(first.spacing)),
                            offset_of(first), fmt::format("{:.4g}", first.ligament_stiffness)};
    for (double depth : depths) {
      Cell& cell = cells.emplace_back("–");
      for (const PublishedStudyRow& row : variant)
        if (std::abs(row.indentation - depth) <= 1e-9)
          cell = {number(shown_units().force(row.normal_force)), percent(row.relative_error),
                  grade(row.relative_error)};
    }
    table.rows.push_back(std::move(cells));
  }
  return table;
}

Figure study_figure(const std::vector<PublishedStudyRow>& study) {
  Figure figure{"published_study", 960, 430, 0, {}};
  for (const Variant& variant : grouped(study, same_lattice)) {
    const std::string title = in_words(variant.front().varied);
    if (figure.panels.empty() || figure.panels.back().title != title) {
      figure.panels.push_back(over_indentation("force error [%]", "bottom right"));
      figure.panels.back().title = title;
    }
    std::vector<Series>& series = figure.panels.back().series;
    const std::string label = label_of(variant.front());
    series.push_back(curve(label, label, numbered_style(series.size()), variant,
                           in(shown_units().length, &PublishedStudyRow::indentation),
                           in_percent(&PublishedStudyRow::relative_error)));
  }
  // The same axis for all, with room for the legend below the curves.
  Range errors{0.0, 0.0};
  for (const PublishedStudyRow& row : study) errors.include(100.0 * row.relative_error);
  const double padding = 0.55 * (errors.to - errors.from) + 1.0;
  for (Panel& panel : figure.panels)
    panel.y_range = Range{errors.from - padding, errors.to + 0.1 * padding};
  figure.columns = int(figure.panels.size());
  return figure;
}

}  // namespace

Chapter published_chapter(const RunData& run) {
  const std::vector<PublishedStudyRow>& study = run.published_study;
  if (study.empty()) return {};
  Range errors;
  for (const PublishedStudyRow& row : study) errors.include(row.relative_error);
  ChapterData chapter("published");
  chapter["least"] = percent(errors.from);
  chapter["most"] = percent(errors.to);
  chapter.figures = {study_figure(study)};
  chapter.tables["study"] = study_table(study);
  return written(std::move(chapter));
}

}  // namespace fingertip::studies::report::inline chapters::inline models
