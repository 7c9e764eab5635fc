#include "studies/cases/published_study.h"

#include <gtest/gtest.h>

#include <set>

#include "straight_response.h"
#include "studies/cases/force_errors.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;

namespace {

fingertip::lattice::PressSetup base() {
  fingertip::lattice::PressSetup setup;
  setup.lattice.model = fingertip::lattice::ModelKind::published;
  setup.lattice.constants =
      fingertip::lattice::published_constants(setup.rubber, setup.lattice.spacing);
  return setup;
}

}  // namespace

TEST(PublishedStudy, VariesOneThingAtATimeAndNeverTheRubber) {
  const auto jobs = PublishedStudy(base()).jobs();
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
}

TEST(PublishedStudy, ErrorsAreRelativeToTheContinuumWhereBothReach) {
  const auto errors = force_errors(straight(110.0, 0.0015), straight(100.0, 0.003), 0.003);
  ASSERT_EQ(errors.size(), 5U);
  EXPECT_NEAR(errors[0].get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(errors[2].get<double>(), 0.1, 1e-9);
  EXPECT_TRUE(errors[3].is_null());
  EXPECT_TRUE(errors[4].is_null());
}

TEST(PublishedStudy, TableHasARowPerVariantAndDepth) {
  const TemporaryFolder folder;
  PublishedStudy(base()).write_table(folder.path(), straight(100.0, 0.003));
  const std::string text = read_text(folder / "published_study.csv");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 12 * 5);
  EXPECT_EQ(text.find("varied,spacing [m],offset_x,offset_y,offset_z,ligament_stiffness,"
                      "indentation [m],normal_force [N],relative_error\n"),
            0U);
}
