// The series `published_study` of the core case: what the published model's force depends on.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "studies/cases/outputs.h"
#include "tests/studies/cases/case_tables.h"
#include "tests/studies/cases/straight_response.h"

using namespace fingertip::studies;

TEST(PublishedStudy, VariesOneThingAtATimeAndNeverTheRubber) {
  std::vector<PlannedJob> jobs = planned_jobs(load_case(find_case("01"), {}));
  std::erase_if(jobs,
                [](const PlannedJob& planned) { return !planned.name.starts_with("published_"); });
  EXPECT_EQ(jobs.size(), 3U + 4U + 2U);
  std::set<std::string> names;
  for (const PlannedJob& planned : jobs) {
    EXPECT_TRUE(planned.exhibit);
    EXPECT_TRUE(names.insert(planned.name).second) << planned.name;
    const auto& inputs = planned.job.inputs;
    EXPECT_EQ(inputs["rubber"]["youngs_modulus"], 3922.66);
    // k1 = E a: the modulus stays whatever the spacing.
    EXPECT_NEAR(inputs["lattice"]["constants"]["k1"].get<double>() /
                    inputs["lattice"]["spacing"].get<double>(),
                3922.66, 1e-9);
  }
  for (const char* name : {"spacing_R8", "offset_0.25_0_0.5", "ligament_stiffness_x0.1"})
    EXPECT_TRUE(names.contains(std::string("published_study/") + name)) << name;
}

TEST(PublishedStudy, FactorsAreOnTheStiffnessOfTheConfiguration) {
  const ConfigSource stiff{{}, {"lattice.ligament_stiffness=3"}, {}};
  const std::vector<PlannedJob> jobs = planned_jobs(load_case(find_case("01"), stiff));
  const auto tenfold =
      std::ranges::find(jobs, "published_study/ligament_stiffness_x10", &PlannedJob::name);
  ASSERT_NE(tenfold, jobs.end());
  EXPECT_EQ(tenfold->job.inputs["lattice"]["ligament_stiffness"], 30.0);
}

TEST(PublishedStudy, ErrorsAreRelativeToTheContinuumWhereBothReach) {
  const auto errors =
      compare_forces(straight(110.0, 0.0015), straight(100.0, 0.003), verdict_depths(0.003)).error;
  ASSERT_EQ(errors.size(), 5U);
  EXPECT_NEAR(errors[0], 0.1, 1e-9);
  EXPECT_NEAR(errors[2], 0.1, 1e-9);
  EXPECT_TRUE(std::isnan(errors[3]));
  EXPECT_TRUE(std::isnan(errors[4]));
}

TEST(PublishedStudy, TableHasARowPerVariantAndDepth) {
  const TemporaryFolder folder;
  std::filesystem::create_directories(folder / "reference");
  straight(100.0, 0.003).write_csv(folder / "reference/response.csv");
  const Case core = load_case(find_case("01"), {});
  write_tables(core, Planner(core).results(folder.path(), {}), folder.path());
  const std::string text = read_text(folder / "published_study.csv");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 12 * 5);
  EXPECT_EQ(text.find("varied,spacing [m],offset_x,offset_y,offset_z,ligament_stiffness,"
                      "indentation [m],normal_force [N],relative_error\n"),
            0U);
}
