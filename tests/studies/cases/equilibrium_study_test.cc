// The series `equilibrium` of the core case: static presses with true surfaces.

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "studies/cases/outputs.h"
#include "tests/studies/cases/case_tables.h"
#include "tests/studies/cases/straight_response.h"

using namespace fingertip::studies;

namespace {

Case core_at(int cells) {
  const ConfigSource spacing{{}, {"lattice.spacing=tip_radius/" + std::to_string(cells)}, {}};
  return load_case(find_case("01"), spacing);
}

std::vector<PlannedJob> jobs_at(int cells) {
  std::vector<PlannedJob> jobs = planned_jobs(core_at(cells));
  std::erase_if(jobs, [](const PlannedJob& job) { return !job.name.starts_with("equilibrium/"); });
  return jobs;
}

std::set<std::string> names_at(int cells) {
  std::set<std::string> names;
  for (const PlannedJob& job : jobs_at(cells)) names.insert(job.name);
  return names;
}

TEST(EquilibriumStudy, CoarserLatticesOnlyAndNoneTwice) {
  EXPECT_EQ(names_at(12),
            (std::set<std::string>{"equilibrium/hookean", "equilibrium/central",
                                   "equilibrium/hookean_R6", "equilibrium/hookean_R8"}));
  EXPECT_EQ(names_at(8), (std::set<std::string>{"equilibrium/hookean", "equilibrium/central",
                                                "equilibrium/hookean_R6"}));
  EXPECT_EQ(names_at(5), (std::set<std::string>{"equilibrium/hookean", "equilibrium/central"}));
}

TEST(EquilibriumStudy, JobsAreStaticPressesOfTheSameRubber) {
  // E = 40 and G = 14 gf/cm² make lambda = G (E - 2G)/(3G - E) = 84 and kappa = 70 gf/cm², which
  // does not depend on the spacing; k1 = G a does. Central springs have no kappa.
  constexpr double pascal = 98.0665;  // per gf/cm²
  const auto jobs = jobs_at(12);
  ASSERT_EQ(jobs.size(), 4U);
  for (const PlannedJob& planned : jobs) {
    const auto& inputs = planned.job.inputs;
    EXPECT_TRUE(planned.exhibit);
    EXPECT_EQ(inputs["protocol"]["mode"], "static") << planned.name;
    EXPECT_EQ(inputs["lattice"]["kinematics"], "small") << planned.name;
    if (planned.name == "equilibrium/central") continue;
    EXPECT_NEAR(inputs["lattice"]["constants"]["kappa"].get<double>(), 70.0 * pascal, 1e-9);
    EXPECT_NEAR(inputs["lattice"]["constants"]["k1"].get<double>(),
                14.0 * pascal * inputs["lattice"]["spacing"].get<double>(), 1e-12);
  }
}

TEST(EquilibriumStudy, ErrorsAreThoseOfTheLatticeOfTheCase) {
  const TemporaryFolder folder;
  const Case core = core_at(12);
  const double depth = core.loaded.config.press.protocol.depth;
  for (const auto& [name, stiffness] :
       {std::pair("equilibrium/hookean", 110.0), std::pair("reference", 100.0)}) {
    std::filesystem::create_directories(folder / name);
    straight(stiffness, depth).write_csv(folder / name / "response.csv");
  }
  const RunResults results = Planner(core).results(folder.path(), {});
  const auto own = std::ranges::find(results, "equilibrium/hookean", &RunResult::folder);
  ASSERT_NE(own, results.end());
  ASSERT_EQ(own->forces.error.size(), 5U);
  for (const double error : own->forces.error) EXPECT_NEAR(error, 0.1, 1e-9);
  EXPECT_NEAR(take_measures(core, results).at("equilibrium.hookean_force_error"), 0.1, 1e-9);

  write_tables(core, results, folder.path());
  const std::string text = read_text(folder / "equilibrium_study.csv");
  EXPECT_EQ(text.find("model,spacing [m],indentation [m],normal_force [N],relative_error\n"), 0U);
  // Four presses at five depths, three of them not computed.
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 4 * 5);
  std::size_t empty = 0;
  for (std::size_t at = text.find(",,\n"); at != text.npos; at = text.find(",,\n", at + 1)) ++empty;
  EXPECT_EQ(empty, 3U * 5U);
}

}  // namespace
