/// Laws of rubber from material tests.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "studies/report/chapters/fit/law_chapter.h"
#include "studies/report/page/words.h"

namespace fingertip::studies::report::inline chapters::inline fit {
namespace {

using calibration::LawDataRow;
using calibration::LawEntry;
using calibration::LawTestEntry;

/// Panels of a figure, and points of a panel; a page with more is slow to read.
constexpr std::size_t max_panels = 6, max_points = 400;
constexpr const char* fit_colour = "#0072B2";
constexpr const char* second_colour = "#D55E00";

Series stress_series(const std::vector<LawDataRow>& rows, bool over_time, const std::string& key,
                     const Style& style, double LawDataRow::*stress) {
  Series series{"", key, style};
  for (const LawDataRow& row : rows)
    if (!over_time || row.time > 0.0)
      series.add(over_time ? row.time : row.deformation, shown_units().stress(row.*stress));
  return series;
}

std::string deformation_label(const LawTestEntry& test) {
  if (test.kind == "simple-shear") return "shear";
  return test.kind == "volumetric" ? "volume over that at rest" : "stretch";
}

Panel test_panel(const LawResult& result, const LawTestEntry& test) {
  const bool over_time = test.course == "relaxation";
  Panel panel{.title = test.name + (test.use == "fit" ? "" : " (not fitted)"),
              .x_label = over_time ? "time [s]" : deformation_label(test),
              .y_label = shown_units().stress.label("stress"),
              .log_x = over_time ? 10 : 0,
              .key = ""};
  const std::string &taken = result.taken().law, &first = result.file.laws.front().law;
  const auto add = [&](const std::string& law, const std::string& key, const Style& style,
                       double LawDataRow::*stress) {
    panel.series.push_back(
        stress_series(law_rows(result, law, test, max_points), over_time, key, style, stress));
  };
  add(taken, "measured", {"#888888", "", 1.0, 6, false, 0.5}, &LawDataRow::measured);
  if (first != taken) add(first, first, {second_colour, "(6,3)", 1.6}, &LawDataRow::computed);
  add(taken, taken, {fit_colour, "", 1.4}, &LawDataRow::computed);
  return panel;
}

/// A figure for so many panels each.
std::vector<Figure> test_figures(const LawResult& result) {
  std::vector<Figure> figures;
  for (const LawTestEntry& test : result.taken().tests) {
    if (figures.empty() || figures.back().panels.size() == max_panels)
      figures.push_back({fmt::format("law_tests_{}", figures.size() + 1), 860, 0, 2, {}});
    figures.back().panels.push_back(test_panel(result, test));
  }
  for (Figure& figure : figures) {
    if (figure.panels.size() == 1) figure.columns = 1;
    figure.height = 60 + 300 * int((figure.panels.size() + 1) / 2);
  }
  return figures;
}

std::string stability(const LawEntry& law) {
  const auto& unstable = law.unstable_in_tests ? law.unstable_in_tests
                         : law.unstable_in_use ? law.unstable_in_use
                                               : law.unstable_in_press;
  return unstable ? "to stretch " + number(unstable->stretch, 3) : "yes";
}

/// How a test counts: "cycles, uniaxial", "planar, at 0.1 1/s".
std::string way_of(const LawTestEntry& test) {
  if (test.course != "slow") return test.course + ", " + test.kind;
  return test.rate ? test.kind + ", at " + number(*test.rate, 3) + gap + "1/s" : test.kind;
}

Table test_table(const LawEntry& law) {
  Table table{
      heads({"Test", "Points", "Error\nrms", "Error\nlargest", "Missed\nsmoothly",
             "Over the\nlaw's stress", "Within", "Loop\nmeasured, J/m³", "Loop\nof the law"}),
      true};
  for (const LawTestEntry& test : law.tests) {
    const double error = test.loop_computed / test.loop_measured - 1.0;
    table.rows.push_back(
        {{test.name, way_of(test) + (test.use == "fit" ? "" : ", not fitted")},
         count(double(test.points)),
         magnitude_cell(test.rms_relative),
         magnitude_cell(test.largest_relative),
         percent_magnitude(test.misfit),
         number(test.factor),
         percent_magnitude(test.within),
         number(test.loop_measured),
         {number(test.loop_computed), if_known(error, percent(error)), grade(error)}});
  }
  const auto has_loop = [](const auto& test) { return std::isfinite(test.loop_measured); };
  if (std::ranges::none_of(law.tests, has_loop)) table.drop_column(8), table.drop_column(7);
  return table;
}

/// The law's coefficients with their intervals, in the units shown.
Table coefficient_table(const LawEntry& law) {
  Table table{heads({"Coefficient", "Estimate", "95 % from", "to", "Unit"})};
  for (const auto& parameter : law.parameters) {
    const ShownUnit* shown = shown_units().of(parameter.unit);
    const auto value = [&](double si) { return number(shown == nullptr ? si : (*shown)(si)); };
    table.rows.push_back({{parameter.name, parameter.at_bound ? "at its bound" : ""},
                          value(parameter.estimate),
                          value(parameter.lower),
                          value(parameter.upper),
                          shown != nullptr        ? unit_name(*shown)
                          : parameter.unit == "1" ? "–"
                                                  : parameter.unit});
  }
  return table;
}

}  // namespace

const LawEntry& LawResult::taken() const {
  const auto found = std::ranges::find(file.laws, file.recommended, &LawEntry::law);
  return found == file.laws.end() ? file.laws.front() : *found;
}

std::vector<LawDataRow> law_rows(const LawResult& result, const std::string& law,
                                 const LawTestEntry& test, std::size_t most) {
  std::vector<LawDataRow> all;
  for (const LawDataRow& row : result.rows)
    if (row.law == law && row.test == test.name && row.use == test.use) all.push_back(row);
  const std::size_t step = all.size() / most + 1;
  std::vector<LawDataRow> some;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i % step == 0 || i + 1 == all.size()) some.push_back(all[i]);
  return some;
}

Table ranking_table(const LawResult& result) {
  Table table{heads({"Law", "Coefficients", "AICc", "Stable"}), true};
  for (const LawTestEntry& test : result.taken().tests)
    table.header.emplace_back(test.name + (test.use == "fit" ? "" : "*"));
  const double least = result.file.laws.front().aicc;
  for (const LawEntry& law : result.file.laws) {
    if (!law.failure.empty()) continue;
    std::vector<Cell> row = {{law.law, law.law != result.file.recommended ? ""
                                       : result.file.failed.empty()       ? "taken"
                                                                          : "not accepted"},
                             count(double(law.parameters.size())),
                             number(law.aicc - least),
                             stability(law)};
    for (const LawTestEntry& test : law.tests) row.push_back(magnitude_cell(test.rms_relative));
    row.push_back(prose(law.passed_over));
    table.rows.push_back(std::move(row));
  }
  const auto passed_over = [](const LawEntry& law) { return !law.passed_over.empty(); };
  if (std::ranges::any_of(result.file.laws, passed_over)) {
    table.header.emplace_back("Passed over, because it");
    table.header.back().words = true;
  } else {
    for (std::vector<Cell>& row : table.rows) row.pop_back();
  }
  return table;
}

Table squares_table(const std::vector<LawResult>& results) {
  Table table{{"Law"}, true};
  std::map<std::string, std::vector<Cell>> rows;
  const auto add = [&](const LawResult& result, const LawTestEntry& test) {
    const std::size_t column = table.header.size();
    for (const LawEntry& law : result.file.laws)
      for (const LawTestEntry& own : law.tests) {
        if (own.name != test.name || own.use != test.use || !std::isfinite(own.published)) continue;
        const double ratio = own.sum_of_squares / own.published;
        rows[law.law].resize(column, "–");
        rows[law.law].emplace_back(number(ratio), "", grade(ratio - 1.0));
        table.header.resize(column + 1, test.name);
      }
  };
  for (const LawResult& result : results)
    for (const LawTestEntry& test : result.taken().tests) add(result, test);
  for (auto& [law, row] : rows) {
    row.front() = law;
    row.resize(table.header.size(), "–");
    table.rows.push_back(std::move(row));
  }
  return table;
}

LawResult read_laws(const std::filesystem::path& folder, FolderReader& reader) {
  LawResult result;
  result.file = reader.take<calibration::LawsFile>(reader.json(folder / "laws.json"));
  result.rows = reader.rows<LawDataRow>(folder / "law_data.csv");
  return result;
}

Chapter law_chapter(const LawResult& result) {
  if (result.empty()) return {};
  const calibration::LawsFile& file = result.file;
  const LawEntry& taken = result.taken();
  ChapterData chapter("laws");
  chapter["statement"] = as_shown(file.statement);
  chapter["law"] = taken.law;
  chapter["smallest"] = number(file.smallest_stretch, 3);
  chapter["largest"] = number(file.largest_stretch, 3);
  chapter["times"] = std::isfinite(file.shortest_time);
  chapter["shortest"] = with_prefix(file.shortest_time, "s");
  chapter["longest"] = with_prefix(file.longest_time, "s");
  chapter["relaxes"] = std::isfinite(file.shortest_time);
  const bool other = file.laws.front().law != taken.law;
  if (!result.rows.empty()) chapter.figures = test_figures(result);
  const bool thinned = std::ranges::any_of(
      taken.tests, [](const LawTestEntry& test) { return test.points > max_points; });
  WordList figures;
  for (std::size_t i = 0; i < chapter.figures.size(); ++i) {
    TemplateData& figure = figures.emplace_back();
    figure["figure"] = chapter.figures[i].name;
    figure["title"] = i == 0 ? "Tests measured and computed" : "Further tests";
    figure["law"] = taken.law;
    figure["second"] = other ? file.laws.front().law : std::string();
    figure["thinned"] = thinned ? std::to_string(max_points) : std::string();
  }
  chapter["figures"] = std::move(figures);
  WordList failed, contradictions;
  for (const LawEntry& law : file.laws) {
    if (law.failure.empty()) continue;
    TemplateData& one = failed.emplace_back();
    one["law"] = law.law;
    one["failure"] = law.failure;
  }
  chapter["failed"] = std::move(failed);
  for (const std::string& sentence : taken.contradictions)
    contradictions.emplace_back()["sentence"] = as_shown(sentence);
  chapter["contradicted"] =
      contradictions.empty() ? std::string() : std::to_string(contradictions.size());
  chapter["contradictions"] = std::move(contradictions);
  chapter.tables["ranking"] = ranking_table(result);
  chapter.tables["squares"] = squares_table({result});
  chapter.tables["coefficients"] = coefficient_table(taken);
  chapter.tables["tests"] = test_table(taken);
  return written(std::move(chapter));
}

std::string law_answer(const LawResult& result) {
  return result.empty() ? std::string() : as_shown(result.file.statement);
}

std::vector<NotRun> missing_law_parts(const LawResult& result) {
  std::vector<NotRun> missing;
  if (result.empty()) missing.push_back({"Laws of the rubber", "laws.json"});
  if (result.rows.empty()) missing.push_back({"Stresses measured and computed", "law_data.csv"});
  return missing;
}

}  // namespace fingertip::studies::report::inline chapters::inline fit
