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
constexpr std::size_t most_dots = 40, most_line_points = 100;

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
  const auto series = [&](std::size_t most, double LawDataRow::*stress) {
    Series made;
    for (const LawDataRow& row : law_rows(result, law, test, most)) {
      made.x.push_back(row.deformation);
      made.y.push_back(shown_units().stress(row.*stress));
    }
    return made;
  };
  const bool fitted = test.use == "fit";
  Series dots = series(most_dots, &LawDataRow::measured);
  dots.key = test.name + ", measured";
  dots.style = numbered_style(place);
  dots.style.line = false;
  dots.style.point = 6;
  const bool drawn = std::ranges::any_of(
      panel.series, [&](const Series& other) { return other.x == dots.x && other.y == dots.y; });
  if (!drawn) panel.series.push_back(std::move(dots));
  Series line = series(most_line_points, &LawDataRow::computed);
  line.label = test.name + (fitted ? "" : ", predicted");
  line.style = numbered_style(place);
  line.style.point = 0;
  line.style.dash = fitted ? "" : "(7,4)";
  panel.series.push_back(std::move(line));
}

/// A law that runs away beyond its tests must not hide them.
Range range_of_dots(const Panel& panel) {
  double least = 0.0, most = 0.0;
  for (const Series& series : panel.series) {
    if (series.style.line) continue;
    for (const double y : series.y) {
      least = std::min(least, y);
      most = std::max(most, y);
    }
  }
  const double room = 0.12 * (most - least);
  return {least < 0.0 ? least - room : 0.0, most > 0.0 ? most + room : 0.0};
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
  Table table;
  table.graded = true;
  table.header = {plain("Fit"),
                  plain("Error", "of what was fitted"),
                  plain("Error", "of what was predicted"),
                  plain("Within", "of what was predicted"),
                  plain("Sums of squares", "over those published"),
                  plain("Measured / law", "at the end")};
  const auto error = [](double value) { return Cell{percent_magnitude(value), "", grade(value)}; };
  for (const MaterialRunEntry& run : data.runs)
    table.rows.push_back(
        {plain(run_label(run), run.law + (run.test.empty() ? "" : ", " + run.test)),
         error(run.fit_error), error(run.predicted_error),
         plain(percent_magnitude(1.0 - run.outside)), error(run.squares_error),
         plain(number(run.end_ratio, 3))});
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
    Words& one = fits.emplace_back();
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
  const MaterialRunEntry *best = nullptr, *worst = nullptr;
  for (const MaterialRunEntry& run : data.runs) {
    if (!std::isfinite(run.predicted_error)) continue;
    if (best == nullptr || run.predicted_error < best->predicted_error) best = &run;
    if (worst == nullptr || run.predicted_error > worst->predicted_error) worst = &run;
  }
  Words words;
  words["fits"] = std::to_string(data.fits.size());
  words["one"] = data.fits.size() == 1;
  words["best"] = best == nullptr ? "" : run_label(*best);
  words["best_error"] = best == nullptr ? "" : percent_magnitude(best->predicted_error);
  words["worst"] = worst == best ? "" : run_label(*worst);
  words["worst_error"] = worst == best ? "" : percent_magnitude(worst->predicted_error);
  return sentences("answer_materials", words);
}

std::string materials_text(const MaterialsData& data) {
  std::string text = fmt::format("{:<52}{:>9}{:>11}{:>9}{:>9}{:>11}\n", "law", "fitted",
                                 "predicted", "outside", "squares", "end ratio");
  const auto share = [](double value) {
    return std::isfinite(value) ? fmt::format("{:.3g} %", 100.0 * value) : std::string("-");
  };
  for (const MaterialRunEntry& run : data.runs)
    text += fmt::format(
        "{:<52}{:>9}{:>11}{:>9}{:>9}{:>11}\n", run_label(run).substr(0, 51), share(run.fit_error),
        share(run.predicted_error), share(run.outside), share(run.squares_error),
        std::isfinite(run.end_ratio) ? fmt::format("{:.3g}", run.end_ratio) : std::string("-"));
  return text +
         "errors over the stress's root mean square; outside: share of points outside the 95 % "
         "interval;\nsquares: error of sums of squares against those published; end ratio: "
         "measured over predicted\n";
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
