// The page of laws that were fitted to material tests, some of them in time.

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/material_tests/law_record.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "studies/files/read_fields.h"
#include "studies/report/report.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using namespace fingertip::calibration;

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

/// Stresses of a neo-Hookean rubber, 30 % of which fade in 2 s.
void fill(MaterialTest& test) {
  const LawChoice law{meshes::RubberLaw::neo_hookean, 1, 1};
  const std::size_t n = test.deformation.size();
  const Eigen::VectorXd stress = LawModel(test, std::vector<double>(n, 1.0), law, coefficients(law))
                                     .evaluate(Eigen::Vector3d(20e3, 0.3, 2.0))
                                     .value;
  test.stress.assign(stress.begin(), stress.end());
}

MaterialTest hold() {
  MaterialTest test;
  test.name = "hold <b>";
  test.course = TestCourse::relaxation;
  test.path = {{0.0, 100.0}, {1.3, 1.3}};
  for (int i = 0; i < 40; ++i) test.time.push_back(0.1 * std::pow(1000.0, i / 39.0));
  test.time.back() = 100.0;
  test.deformation.assign(test.time.size(), 1.3);
  test.published = {{"neo-hookean", 1e7}};
  fill(test);
  return test;
}

MaterialTest cycles() {
  MaterialTest test;
  test.name = "loops";
  test.course = TestCourse::cycles;
  for (int i = 0; i <= 60; ++i) {
    test.time.push_back(0.2 * i);
    test.deformation.push_back(1.2 + 0.1 * std::sin(0.2 * i));
  }
  test.path = {test.time, test.deformation};
  fill(test);
  return test;
}

MaterialTest tension() {
  MaterialTest test;
  test.name = "tension";
  for (int i = 1; i <= 12; ++i) test.deformation.push_back(1.0 + 0.05 * i);
  test.rate = 0.1;
  fill(test);
  for (double& stress : test.stress) stress *= 1.5;  // of another rubber
  return test;
}

class LawsReport : public testing::Test {
 protected:
  LawsReport() {
    const std::vector<MaterialTest> tests = {hold(), cycles()}, validation = {tension()};
    const auto ranking =
        rank_laws(tests, validation,
                  {{meshes::RubberLaw::neo_hookean, 1, 0}, {meshes::RubberLaw::neo_hookean, 1, 1}});
    fs::create_directories(run_);
    meshes::write_json_file(laws_file(ranking, tests, validation, TestWeights::test),
                            run_ / "laws.json");
    meshes::write_rows(law_data(ranking, tests, validation), run_ / "law_data.csv");
    write_text(run_ / "summary.json", "{\"problem\": \"material\", \"status\": \"finished\"}");
    write_text(run_ / "manifest.json", "{\"verb\": \"calibrate\", \"units\": \"si\"}");
  }
  std::string report() const {
    studies::report::write_report(run_);
    const std::string html = read_text(run_ / "report.html");
    const auto faults = report_testing::structure_faults(html);
    EXPECT_TRUE(faults.empty()) << faults.front();
    return html;
  }

  TemporaryFolder folder_;
  fs::path run_ = folder_.path() / "run";
};

TEST_F(LawsReport, ShowsRankingTestsLoopsAndWhatContradicts) {
  const std::string html = report(), text = report_testing::visible_text(html);
  for (const char* part :
       {"Laws of the rubber", "neo-hookean+prony-1", "Of 2 laws neo-hookean+prony-1", "taken",
        "relaxation_tau1", "relaxation, uniaxial", "cycles, uniaxial", "not fitted",
        "hold &lt;b&gt;", "tension, which was not fitted, is missed by 33"})
    EXPECT_TRUE(has(text, part) || has(html, part)) << part << "\n" << text;
  EXPECT_TRUE(says(html, "<section id=\"laws\">"));
  EXPECT_TRUE(omits(html, {"hold <b>", "<section id=\"force\">"}));
  const std::string csv = read_text(run_ / "figures" / "law_tests_1.csv");
  EXPECT_TRUE(
      says(csv, {"loops,measured,", "tension (not fitted),neo-hookean+prony-1,", "time [s]"}));
}

TEST_F(LawsReport, ARejectedLawSaysSoFirst) {
  EXPECT_TRUE(omits(report(), "class=\"rejected\""));
  auto file = nlohmann::json::parse(read_text(run_ / "laws.json"));
  file["failed"] = {"the law does not describe the data: tension is missed by 27 %"};
  write_text(run_ / "laws.json", file.dump());
  const std::string html = report(), text = report_testing::visible_text(html);
  const auto box = html.find("<div class=\"rejected\"");
  ASSERT_NE(box, html.npos);
  EXPECT_LT(box, html.find("<p class=\"answer\""));
  EXPECT_TRUE(says(text, {"What follows must not be used as it is:", "tension is missed by 27 %"}));
}

TEST_F(LawsReport, TellsSumsOfSquaresThatOthersPublished) {
  const std::string text = report_testing::visible_text(report());
  EXPECT_TRUE(says(text, "over those that others published"));
  const auto file = studies::struct_of<LawsFile>(studies::read_entry(run_ / "laws.json"));
  for (const LawEntry& law : file.laws)
    for (const LawTestEntry& test : law.tests)
      EXPECT_EQ(std::isfinite(test.published),
                law.law == "neo-hookean" && test.kind == "uniaxial" && test.course == "relaxation");
}

/// Two runs of a case that ask of one fit.
TEST_F(LawsReport, ACaseShowsItsFitsSideBySide) {
  const fs::path fit = run_ / "materials/a/laws";
  fs::create_directories(fit);
  for (const char* file : {"laws.json", "law_data.csv"}) fs::rename(run_ / file, fit / file);
  fs::remove(run_ / "manifest.json");
  const auto entry = [](const char* name, const char* law, const char* test, const char* rest) {
    return std::string("{\"series\": \"rubber\", \"name\": \"") + name +
           "\", \"folder\": \"materials/a/laws\", \"law\": \"" + law + "\", \"test\": \"" + test +
           "\", \"status\": \"finished\", " + rest + "}";
  };
  write_text(
      run_ / "summary.json",
      "{\"case\": \"c\", \"title\": \"Two <laws>\", \"description\": \"\", \"status\": \"ok\", "
      "\"materials\": [" +
          entry("no branch", "neo-hookean", "", "\"predicted_error\": 7.2e16") + ", " +
          entry("a branch", "neo-hookean+prony-1", "tension",
                "\"predicted_error\": 0.33, \"end_ratio\": 1.49") +
          "], \"criteria\": []}");
  const std::string html = report(), text = report_testing::visible_text(html);
  for (const char* part :
       {"Laws on material tests", "1 set of tests was fitted", "foretold best, within 33",
        "7.2×10¹⁸", "1.49", "rubber, no branch", "every law that was tried", "Sums of squared"})
    EXPECT_TRUE(says(text, part));
  // What has no stretch for its abscissa is not drawn; what was measured is drawn once a panel.
  const std::string csv = read_text(run_ / "figures/material_tests.csv");
  EXPECT_TRUE(
      says(csv, {"rubber: neo-hookean+prony-1,\"tension, measured\"", "\"tension, predicted\""}));
  EXPECT_TRUE(omits(csv, "loops"));
  const std::string table = studies::report::verdict_text(run_);
  EXPECT_TRUE(has(table, "rubber, a branch") && has(table, "33.0 %")) << table;
  fs::remove(fit / "laws.json");
  EXPECT_TRUE(says(report_testing::visible_text(report()), "materials/a/laws/laws.json"));
}

TEST_F(LawsReport, NamesWhatIsMissingOrDamaged) {
  fs::remove(run_ / "law_data.csv");
  EXPECT_TRUE(says(report_testing::visible_text(report()), "law_data.csv"));
  write_text(run_ / "laws.json", "{\"problem\": \"material\"");
  bool told = false;
  for (const auto& damage : studies::report::write_report(run_))
    told = told || has(damage.key + damage.value + damage.rule, "laws.json");
  EXPECT_TRUE(told);
}

}  // namespace
