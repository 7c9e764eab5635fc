// The page of a study, from presses whose errors are known.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "studies/report/report.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using nlohmann::json;
using report_testing::write_file;

/// Error of a second-order lattice with `cells` per radius.
double error_of(int cells) {
  return 1.44 / (cells * cells);
}

std::string row(const std::string& series, int cells, double depth, double error) {
  const double reference = report_testing::continuum_force(depth);
  return fmt::format(
      "{0},R/{1},{1},hookean,small,frictionless,0.25,{2},continuum/1,{3},{4},{5},0.002,{6},1e-12,"
      "0.5,finished\n",
      series, cells, 0.01 / cells, depth, reference * (1.0 + error), reference,
      std::isnan(error) ? "" : fmt::format("{}", error));
}

/// Two series, one of them of second order, and a budget.
fs::path write_study(const TemporaryFolder& folder, const std::string& title = "A study") {
  const fs::path run = folder.path() / "run";
  std::string rows =
      "series,name,x,model,kinematics,contact,poissons_ratio,spacing [m],continuum,indentation "
      "[m],normal_force [N],reference_force [N],reference_error,relative_error,volume_defect,"
      "wall_time [s],status\n";
  for (const int cells : {6, 12, 24})
    for (const double depth : {0.001, 0.002})
      rows += row("second order", cells, depth, error_of(cells));
  for (const double depth : {0.001, 0.002}) rows += row("other", 8, depth, -0.4);
  write_file(run / "variants.csv", rows);
  const json variants = json::parse(R"({
    "x_label": "R/a", "count": 4, "not_converged": 0,
    "series": [{"name": "second order", "worst_error": 0.04, "finest_error": 0.0025,
                "spread": 0.0375, "order": 2.0},
               {"name": "other", "worst_error": 0.4, "finest_error": 0.4, "spread": 0.0,
                "order": null}],
    "continua": [{"folder": "continuum/1", "strain": "linear", "contact": "frictionless",
                  "youngs_modulus": 3922.66, "shear_modulus": 1372.931, "poissons_ratio": 0.4286}],
    "budgets": [{"name": "R/12", "depths": [0.001, 0.002], "total": [0.01, 0.01],
                 "parts": [{"series": "bond", "share": [-0.0123, -0.02]}],
                 "rest": [0.0223, 0.03]}]})");
  const json criteria = json::parse(
      R"([{"name": "small", "measure": "m", "value": 0.4, "limit": 0.1, "passed": false}])");
  const json summary = {{"case", "09_study"},   {"title", title},
                        {"description", ""},    {"status", "criteria failed"},
                        {"criteria", criteria}, {"variants", variants}};
  write_file(run / "summary.json", summary.dump());
  return run;
}

}  // namespace

TEST(StudyReport, ShowsThePressesAndNothingOfTheCoreCase) {
  const TemporaryFolder folder;
  const fs::path run = write_study(folder);
  studies::report::write_report(run);
  const std::string html = read_text(run / "report.html");
  EXPECT_TRUE(report_testing::structure_faults(html).empty());
  EXPECT_TRUE(report_testing::outside_references(html).empty());
  EXPECT_TRUE(says(html, "<section id=\"variants\">"));
  for (const char* other : {"force", "control", "elasticity", "continuum", "not-run"})
    EXPECT_TRUE(omits(html, "<section id=\"" + std::string(other) + "\">")) << other;
  for (const char* name : {"variants_convergence", "variants_error", "variants_force"}) {
    EXPECT_TRUE(fs::exists(run / "figures" / (std::string(name) + ".svg"))) << name;
    EXPECT_TRUE(omits(read_text(run / "figures" / (std::string(name) + ".svg")), "using 1:2"));
  }
  const std::string text = report_testing::visible_text(html);
  // 1.44/6² and 1.44/24² in words, the worst press, budget, continuum, criterion.
  for (const char* part : {"falls from 4.0", "at R/6 to 0.25",
                           "at R/24, order 2.0; from R/12 to R/24 alone, order 2.0", "other, R/8",
                           "−1.2 %", "3.923", "0.20 %", "✕ not met"})
    EXPECT_TRUE(says(text, part));
  EXPECT_TRUE(omits(text, " nan"));
}

TEST(StudyReport, TextIsPlainAndEscaped) {
  const TemporaryFolder folder;
  const fs::path run = write_study(folder, "<script>alert('x')</script> {{page_title}}");
  studies::report::write_report(run);
  EXPECT_TRUE(
      omits(report_testing::without_own_scripts(read_text(run / "report.html")), "<script"));
  const std::string text = studies::report::verdict_text(run);
  for (const char c : text) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~')) << int(c);
  EXPECT_TRUE(says(text, {"4.0 %", "-40.0 %", "NOT MET small"}));
}

TEST(StudyReport, PressThatStoppedLeavesGaps) {
  const TemporaryFolder folder;
  const fs::path run = write_study(folder);
  std::string rows = read_text(run / "variants.csv");
  rows +=
      "stopped,R/9,9,hookean,small,frictionless,0.25,0.001,continuum/1,0.001,,0.003,0.002,,,,"
      "\"not converged: at 0.1 cm, why\"\n";
  write_file(run / "variants.csv", rows);
  studies::report::write_report(run);
  const std::string text = report_testing::visible_text(read_text(run / "report.html"));
  EXPECT_TRUE(says(text, "not converged: at 0.1 cm, why"));
  EXPECT_TRUE(omits(text, " nan"));
}

namespace {

/// Empties a column of the study's table.
void empty_column(const fs::path& run, std::size_t column) {
  std::istringstream lines(read_text(run / "variants.csv"));
  std::string line, table;
  std::getline(lines, table);
  table += '\n';
  while (std::getline(lines, line)) {
    std::size_t from = 0;
    for (std::size_t i = 0; i < column; ++i) from = line.find(',', from) + 1;
    table += line.erase(from, line.find(',', from) - from) + '\n';
  }
  write_file(run / "variants.csv", table);
}

}  // namespace

TEST(StudyReport, WithoutAnAbscissaEverySeriesHasItsFigure) {
  const TemporaryFolder folder;
  const fs::path run = write_study(folder);
  empty_column(run, 2);
  studies::report::write_report(run);
  const std::string text = report_testing::visible_text(read_text(run / "report.html"));
  const std::size_t first = text.find("Force error against indentation: second order."),
                    second = text.find("Force error against indentation: other.");
  EXPECT_LT(first, second);
  EXPECT_LT(second, std::string::npos);
  EXPECT_LT(text.find("variants_depth_1.csv"), second);
  EXPECT_LT(second, text.find("variants_depth_2.csv"));
  EXPECT_FALSE(fs::exists(run / "figures/variants_error.svg"));
}

TEST(StudyReport, AnOrderWithoutErrorsIsNotTold) {
  const TemporaryFolder folder;
  const fs::path run = write_study(folder);
  empty_column(run, 13);
  studies::report::write_report(run);
  const std::string text = report_testing::visible_text(read_text(run / "report.html"));
  EXPECT_TRUE(says(text, "No press got far enough to be compared."));
  EXPECT_TRUE(omits(text, "Convergence."));
}
