/// Cases on material tests: what is run of them, by what it is measured, and data that are not at
/// hand.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <set>

#include "calibration/material_tests/law_record.h"
#include "meshes/tables/table_rows.h"
#include "studies/cases/outputs.h"
#include "tests/studies/cases/case_tables.h"

using namespace fingertip::studies;
using fingertip::calibration::LawDataRow, fingertip::calibration::LawEntry,
    fingertip::calibration::LawTestEntry;

namespace {

class MaterialCase : public testing::Test {
 protected:
  void SetUp() override {
    std::string rows = "stretch,stress\n";
    for (int i = 1; i <= 12; ++i) {
      const double l = 1.0 + 0.1 * i;
      rows += std::to_string(l) + "," + std::to_string(20.0 * (l - 1.0 / (l * l))) + "\n";
    }
    write_text(folder_ / "tension.csv", rows);
    const std::string path = "path = \"$FINGERTIP_TEST_DATA/tension.csv\"\n";
    write_text(folder_ / "tests.toml",
               "[data]\nkind = \"uniaxial\"\nstrain = {column = \"stretch\", is = \"stretch\"}\n"
               "stress = {column = \"stress\", is = \"nominal\", unit = \"kPa\"}\n"
               "[[test]]\nname = \"near\"\nrange = [1.0, 1.5]\n" +
                   path + "[[test]]\nname = \"far\"\nrange = [1.5, 3.0]\nuse = \"predict\"\n" +
                   path);
    setenv("FINGERTIP_TEST_DATA", folder_.path().c_str(), 1);
  }
  void TearDown() override { unsetenv("FINGERTIP_TEST_DATA"); }

  static std::string run(const std::string& entries) {
    return "[[case.material]]\n" + entries + "\n";
  }

  const std::string settings_ = "[calibration]\nproblem = \"material\"\ntests = \"tests.toml\"\n";
  TemporaryFolder folder_;
};

TEST_F(MaterialCase, RunsThatAskOfTheSameFitShareItsJob) {
  const Case study_case = case_with(
      folder_,
      run("name = \"a\"\nlaw = \"yeoh-2\"") + run("name = \"b\"\nlaw = \"gent\"\ntest = \"far\"") +
          run("name = \"c\"\nlaw = \"gent\"\nset = {\"calibration.laws\" = [\"gent\"]}"),
      settings_);
  const auto jobs = planned_jobs(study_case);
  ASSERT_EQ(jobs.size(), 2U);
  EXPECT_EQ(jobs[0].name, "materials/a/laws");
  EXPECT_EQ(jobs[0].job.kind, "laws");
  const Planner planner(study_case);
  EXPECT_EQ(planner.results(folder_.path(), {})[1].folder, "materials/a/laws");
}

TEST_F(MaterialCase, RefusesLawsAndTestsThatAreNotThere) {
  EXPECT_EQ(refusal(folder_, run("name = \"a\"\nlaw = \"gent\"\ntest = \"near\""), settings_), "");
  EXPECT_TRUE(says(refusal(folder_, run("name = \"a\"\nlaw = \"hooke\""), settings_),
                   "must be a law of calibration.laws"));
  EXPECT_TRUE(says(refusal(folder_, run("name = \"a\"\ntest = \"fat\""), settings_),
                   "the nearest one is far"));
  EXPECT_TRUE(
      says(refusal(folder_,
                   run("name = \"a\"\nlaw = \"gent\"\nset = {\"calibration.laws\" = [\"yeoh-2\"]}"),
                   settings_),
           "is not fitted"));
  EXPECT_TRUE(says(refusal(folder_, run("name = \"a\"\nbeside = \"b\""), settings_),
                   "no such entry of a material"));
  unsetenv("FINGERTIP_TEST_DATA");
  EXPECT_TRUE(says(refusal(folder_, run("name = \"a\""), settings_),
                   "no environment variable FINGERTIP_TEST_DATA is set"));
}

TEST_F(MaterialCase, WithoutItsDataItSaysWhereTheyAre) {
  const std::string table =
      "[case.data]\nfolder = \"FINGERTIP_TEST_DATA\"\nsource = \"the library\"\n" +
      run("name = \"a\"");
  const Case study_case = case_with(folder_, table, settings_);
  EXPECT_EQ(missing_data(study_case), "");
  unsetenv("FINGERTIP_TEST_DATA");
  EXPECT_EQ(missing_data(study_case),
            "its data are no part of the project: get the library, and name their folder in "
            "FINGERTIP_TEST_DATA");
  EXPECT_TRUE(says(refusal(folder_, table, settings_), "get the library"));
  setenv("FINGERTIP_TEST_DATA", (folder_ / "nowhere").c_str(), 1);
  EXPECT_NE(missing_data(study_case), "");
  // What a run keeps of its case tells it, too.
  write_text(folder_ / "again.toml", settings_ + study_case.text);
  EXPECT_EQ(load_case(folder_ / "again.toml", {}).data.source, "the library");
  EXPECT_TRUE(
      says(refusal(folder_, "[case.data]\nfolder = \"A\"\n" + run("name = \"a\""), settings_),
           "needs exactly folder"));
}

LawTestEntry entry(const char* name, const char* use, double error, double within, double squares,
                   double published) {
  LawTestEntry test;
  test.name = name;
  test.kind = "uniaxial";
  test.use = use;
  test.rms_relative = error;
  test.within = within;
  test.sum_of_squares = squares;
  test.published = published;
  return test;
}

/// Two laws, one test fitted and two predicted, with made-up numbers.
RunResult with_laws(const CaseRun& run) {
  const double none = std::nan("");
  RunResult result = finished_run(run, {});
  LawEntry good, bad;
  good.law = "yeoh-2";
  good.tests = {entry("near", "fit", 0.01, 0.95, 103.0, 100.0),
                entry("far", "predict", 0.10, 0.9, 1.0, none),
                entry("sheet", "predict", 0.30, 0.4, 1.0, none)};
  bad = good;
  bad.law = "gent";
  bad.tests[0] = entry("near", "fit", 0.05, 0.95, 80.0, 100.0);
  bad.tests[1].rms_relative = 0.02;
  result.laws.laws = {good, bad};
  return result;
}

class LawMeasures : public MaterialCase {
 protected:
  Measures measured(const CaseRun& run) {
    const std::vector<LawDataRow> rows = {{"yeoh-2", "near", "fit", 3.0, 9e3, 1e3},
                                          {"yeoh-2", "far", "predict", 1.5, 2e3, 2e3},
                                          {"yeoh-2", "far", "predict", 0.4, -3e3, -2e3},
                                          {"gent", "far", "predict", 0.3, -4e3, -1e3},
                                          {"yeoh-2", "sheet", "predict", 2.0, 4e3, 1e3}};
    fingertip::meshes::write_rows(rows, folder_ / "law_data.csv");
    Case study_case;
    return measures_of_run(study_case, with_laws(run), folder_.path());
  }
};

TEST_F(LawMeasures, AreThoseOfOneLawAndOneTestOrTheLargest) {
  CaseRun run{.kind = "material", .verb = "laws", .name = "a"};
  run.law = "yeoh-2";
  run.test = "far";
  const Measures one = measured(run);
  EXPECT_DOUBLE_EQ(one.at("predicted_error"), 0.10);
  EXPECT_NEAR(one.at("outside"), 0.1, 1e-12);
  EXPECT_DOUBLE_EQ(one.at("end_ratio"), 1.5) << "0.4 is farther from rest than 1.5";
  EXPECT_FALSE(one.contains("fit_error")) << "the test was not fitted";
  run.test = "";
  const Measures all_tests = measured(run);
  EXPECT_DOUBLE_EQ(all_tests.at("fit_error"), 0.01);
  EXPECT_DOUBLE_EQ(all_tests.at("predicted_error"), 0.30);
  EXPECT_NEAR(all_tests.at("squares_error"), 0.03, 1e-12);
  EXPECT_DOUBLE_EQ(all_tests.at("end_ratio"), 4.0);
  run.law = "";
  const Measures all = measured(run);
  EXPECT_DOUBLE_EQ(all.at("fit_error"), 0.05);
  EXPECT_NEAR(all.at("squares_error"), 0.2, 1e-12);
}

TEST_F(LawMeasures, OfALawWithoutAFitThereAreNone) {
  CaseRun run{.kind = "material", .verb = "laws", .name = "a"};
  RunResult result = with_laws(run);
  result.laws.laws[1].failure = "too few points";
  const Case study_case;
  EXPECT_TRUE(measures_of_run(study_case, result, folder_.path()).empty());
  run.law = "yeoh-2";
  EXPECT_TRUE(measures_of_run(study_case, result, folder_.path()).contains("fit_error"));
}

}  // namespace
