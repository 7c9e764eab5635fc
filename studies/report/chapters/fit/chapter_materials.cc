/// Fits of laws to material tests, side by side.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "studies/report/chapters/fit/materials_chapter.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

using calibration::LawDataRow;
using calibration::LawEntry;
using calibration::LawTestEntry;

/// Of a test: so many are told apart in a panel, and so many make a smooth line.
constexpr std::size_t max_dots = 40, max_line_points = 100;

std::string run_label(const MaterialRunEntry& run) {
  return (run.series.empty() ? "" : run.series + ", ") + run.name;
}

const LawEntry* law_of(const LawResult& result, const std::string& law) {
  const auto found = std::ranges::find(result.file.laws, law, &LawEntry::law);
  return found == result.file.laws.end() ? nullptr : &*found;
}

/// Adds the test's points, unless they are drawn already, and the law's line.
void add_test(const LawResult& result, const std::string& law, const LawTestEntry& test,
              std::size_t place, Panel& panel) {
  const auto series = [&](const std::string& label, const std::string& key, const Style& style,
                          std::size_t most, double LawDataRow::*stress) {
    return curve(label, key, style, law_rows(result, law, test, most), &LawDataRow::deformation,
                 in(shown_units().stress, stress));
  };
  const bool fitted = test.use == "fit";
  Style style = numbered_style(place);
  const Series dots =
      series("", test.name + ", measured", style.as_points(6), max_dots, &LawDataRow::measured);
  const bool drawn = std::ranges::any_of(
      panel.series, [&](const Series& other) { return other.x == dots.x && other.y == dots.y; });
  if (!drawn) panel.series.push_back(dots);
  style.dash = fitted ? "" : "(7,4)";
  panel.series.push_back(series(test.name + (fitted ? "" : ", predicted"), "", style.as_line(),
                                max_line_points, &LawDataRow::computed));
}

/// A law that runs away beyond its tests must not hide them.
Range range_of_dots(const Panel& panel) {
  Range range{0.0, 0.0};
  for (const Series& series : panel.series)
    if (!series.style.line)
      for (const double y : series.y) range.include(y);
  const double room = 0.12 * (range.to - range.from);
  return {range.from < 0.0 ? range.from - room : 0.0, range.to > 0.0 ? range.to + room : 0.0};
}

/// A fit and the law that runs name, with every test fitted and those that they ask of.
Panel law_panel(const MaterialsData& data, const MaterialRunEntry& first) {
  const LawResult& result = data.result_of(first);
  Panel panel;
  panel.title = (first.series.empty() ? first.name : first.series) + ": " + first.law;
  panel.x_label = "stretch";
  panel.y_label = shown_units().stress.label("stress");
  const LawEntry* law = law_of(result, first.law);
  if (law == nullptr) return panel;
  const auto is_asked = [&](const LawTestEntry& test) {
    return std::ranges::any_of(data.runs, [&](const MaterialRunEntry& run) {
      return run.folder == first.folder && run.law == first.law &&
             (run.test.empty() || run.test == test.name);
    });
  };
  std::size_t place = 0;
  for (const LawTestEntry& test : law->tests) {
    // Others have another abscissa.
    const bool stretched = test.kind != "simple-shear" && test.kind != "volumetric";
    if (!stretched || test.course != "slow" || (test.use != "fit" && !is_asked(test))) continue;
    add_test(result, first.law, test, place++, panel);
  }
  panel.y_range = range_of_dots(panel);
  if (panel.y_range->from < 0.0) panel.key = "bottom right";
  return panel;
}

Figure materials_figure(const MaterialsData& data) {
  Figure figure{"material_tests", 860, 0, 2, {}};
  for (auto run = data.runs.begin(); run != data.runs.end(); ++run) {
    const bool seen = std::any_of(data.runs.begin(), run, [&](const MaterialRunEntry& other) {
      return other.folder == run->folder && other.law == run->law;
    });
    if (run->law.empty() || seen) continue;
    Panel panel = law_panel(data, *run);
    if (!panel.series.empty()) figure.panels.push_back(std::move(panel));
  }
  if (figure.panels.size() == 1) figure.columns = 1;
  figure.height = 60 + 300 * int((figure.panels.size() + 1) / 2);
  return figure;
}

Table run_table(const MaterialsData& data) {
  Table table{heads({"Fit", "Error\nof what was fitted", "Error\nof what was predicted",
                     "Within\nof what was predicted", "Sums of squares\nover those published",
                     "Measured / law\nat the end"}),
              true};
  for (const MaterialRunEntry& run : data.runs)
    table.rows.push_back({{run_label(run), run.law + (run.test.empty() ? "" : ", " + run.test)},
                          magnitude_cell(run.fit_error),
                          magnitude_cell(run.predicted_error),
                          percent_magnitude(1.0 - run.outside),
                          magnitude_cell(run.squares_error),
                          number(run.end_ratio, 3)});
  return table;
}

}  // namespace

const LawResult& MaterialsData::result_of(const MaterialRunEntry& run) const {
  return std::ranges::find(fits, run.folder, &Fit::folder)->result;
}

MaterialsData read_materials(const RunData& run, FolderReader& reader) {
  MaterialsData data;
  data.runs = run.summary.materials;
  for (const MaterialRunEntry& entry : data.runs) {
    if (std::ranges::find(data.fits, entry.folder, &MaterialsData::Fit::folder) != data.fits.end())
      continue;
    // A series of several fits does not name one of them.
    const bool alone = std::ranges::all_of(data.runs, [&](const MaterialRunEntry& other) {
      return other.series != entry.series || other.folder == entry.folder;
    });
    data.fits.push_back({entry.folder,
                         alone && !entry.series.empty() ? entry.series : run_label(entry),
                         read_laws(run.folder / entry.folder, reader)});
  }
  return data;
}

Chapter materials_chapter(const MaterialsData& data) {
  if (data.runs.empty()) return {};
  ChapterData chapter("materials");
  if (Figure figure = materials_figure(data); !figure.panels.empty())
    chapter.figures.push_back(std::move(figure));
  chapter.tables["materials"] = run_table(data);
  std::vector<LawResult> results;
  WordList fits;
  for (const MaterialsData::Fit& fit : data.fits) {
    if (fit.result.empty()) continue;
    results.push_back(fit.result);
    TemplateData& one = fits.emplace_back();
    one["table"] = fmt::format("ranking_{}", fits.size());
    one["label"] = fit.label;
    one["statement"] = as_shown(fit.result.file.statement);
    one["folder"] = fit.folder;
    chapter.tables[fmt::format("ranking_{}", fits.size())] = ranking_table(fit.result);
  }
  chapter["fits"] = std::move(fits);
  chapter.tables["squares"] = squares_table(results);
  return written(std::move(chapter));
}

std::string materials_answer(const MaterialsData& data) {
  const MaterialRunEntry* worst = largest_in(data.runs, &MaterialRunEntry::predicted_error);
  const MaterialRunEntry* best =
      largest_in(data.runs, [](const MaterialRunEntry& run) { return -run.predicted_error; });
  const bool several = worst != best;
  TemplateData words;
  words["fits"] = std::to_string(data.fits.size());
  words["one"] = data.fits.size() == 1;
  words["best"] = best ? run_label(*best) : "";
  words["best_error"] = best ? percent_magnitude(best->predicted_error) : "";
  words["worst"] = several ? run_label(*worst) : "";
  words["worst_error"] = several ? percent_magnitude(worst->predicted_error) : "";
  return sentences("answer_materials", words);
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
