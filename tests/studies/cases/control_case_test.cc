// Cases on virtual control: what a case file's presses become, and what they are judged by.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/studies/cases/case_tables.h"

using namespace fingertip::studies;

namespace {

const std::string two_presses =
    "[[case.press]]\nseries = \"s\"\nname = \"a\"\ncontinuum = true\n"
    "set = { \"press.speed\" = \"5 cm/s\" }\n"
    "[[case.press]]\nseries = \"s\"\nname = \"b\"\nsnapshots = true\nbeside = \"s, a\"\n"
    "set = { \"press.speed\" = \"5 cm/s\", \"run.time_step\" = \"20 us\" }\n";

}  // namespace

TEST(ControlCase, PlansPressesAndTheContinuaAtTheirSpeeds) {
  const TemporaryFolder folder;
  const Case study_case = case_with(folder, two_presses);
  ASSERT_EQ(study_case.runs.size(), 2u);
  EXPECT_TRUE(study_case.runs[0].continuum);
  EXPECT_TRUE(study_case.runs[1].snapshots);
  EXPECT_EQ(study_case.runs[1].beside, "s, a");
  const std::vector<PlannedJob> jobs = planned_jobs(study_case);
  ASSERT_EQ(jobs.size(), 3u);
  EXPECT_EQ(jobs[0].job.kind, "reference");
  EXPECT_EQ(jobs[0].job.inputs["analysis"], "transient");
  EXPECT_NEAR(jobs[0].job.inputs["protocol"]["speed"].get<double>(), 0.05, 1e-12);
  for (std::size_t i : {1, 2}) EXPECT_EQ(jobs[i].job.kind, "press");
  // What is written into parameters.toml is the same case again.
  const TemporaryFolder other;
  write_text(other / "case.toml",
             "[press]\nsamples = [\"0.1 cm\", \"0.2 cm\"]\n" + study_case.text);
  EXPECT_EQ(load_case(other / "case.toml", {}).text, study_case.text);
}

TEST(ControlCase, RefusesWhatIsNoPressInTime) {
  const TemporaryFolder folder;
  const std::string head = "[[case.press]]\nname = \"a\"\n";
  EXPECT_TRUE(says(refusal(folder, head + "set = { \"press.mode\" = \"static\" }\n"),
                   "a press under a controller takes time"));
  EXPECT_TRUE(says(refusal(folder, head + "set = { \"reference.mode\" = \"static\" }\n"),
                   "reference.mode"));
  EXPECT_TRUE(says(refusal(folder, head + "beside = \"b\"\nset = {}\n"), "must be a press above"));
  EXPECT_TRUE(says(refusal(folder, head + "continuum = 1\nset = {}\n"), "must be of another type"));
  EXPECT_TRUE(says(refusal(folder, head + "contiuum = true\nset = {}\n"), "no such entry"));
  EXPECT_TRUE(says(refusal(folder, head + "set = {}\n[[case.criteria]]\nname = \"c\"\n"
                                          "measure = \"a.change\"\nlimit = 1.0\n"),
                   "unknown measure"));
}

TEST(ControlCase, ASeriesIsJudgedByItsWorstPress) {
  const TemporaryFolder folder;
  const Case study_case = case_with(folder, two_presses);
  const std::vector<std::string> names = measure_names(study_case);
  for (const char* name : {"s.speed_deviation", "s, a.force_error", "s.force_error", "s, b.change"})
    EXPECT_NE(std::ranges::find(names, name), names.end()) << name;
  EXPECT_EQ(std::ranges::find(names, "s, a.change"), names.end());
  RunResults results = {
      finished_run(study_case.runs[0], {{"speed_deviation", 0.01}, {"force_error", 0.02}}),
      finished_run(study_case.runs[1], {{"speed_deviation", 0.03}, {"change", 0.001}})};
  results[0].forces.reference_error = {0.004, 0.002};
  Measures taken = take_measures(study_case, results);
  EXPECT_EQ(taken.at("s.speed_deviation"), 0.03);
  EXPECT_EQ(taken.at("s, a.speed_deviation"), 0.01);
  EXPECT_EQ(taken.at("s.force_error"), 0.02);  // b is not meant to have one
  EXPECT_EQ(taken.at("s.change"), 0.001);
  EXPECT_EQ(taken.at("reference.force_error"), 0.004);
  EXPECT_FALSE(taken.contains("s.force_overshoot"));
  // A press that did not finish leaves its series without a measure.
  results[1].status = "not converged: why";
  results[1].measures.clear();
  taken = take_measures(study_case, results);
  EXPECT_FALSE(taken.contains("s.speed_deviation"));
  EXPECT_EQ(taken.at("presses.not_converged"), 1.0);
}
