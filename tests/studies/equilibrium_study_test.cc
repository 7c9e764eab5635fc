#include "studies/cases/equilibrium_study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "straight_response.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace lattice = fingertip::lattice;

namespace {

lattice::PressSetup setup_of(lattice::ModelKind model, int cells) {
  lattice::PressSetup setup;
  setup.lattice.model = model;
  setup.lattice.spacing = setup.geometry.tip_radius / cells;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.samples = fingertip::meshes::default_samples(setup.protocol.depth);
  return setup;
}

EquilibriumStudy study_at(int cells) {
  return {setup_of(lattice::ModelKind::hookean, cells),
          setup_of(lattice::ModelKind::central, cells)};
}

std::set<std::string> names_at(int cells) {
  std::set<std::string> names;
  for (const PlannedJob& job : study_at(cells).jobs()) names.insert(job.name);
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
  // does not depend on the spacing; k1 = G a does.
  constexpr double pascal = 98.0665;  // per gf/cm²
  const auto jobs = study_at(12).jobs();
  ASSERT_EQ(jobs.size(), 4U);
  for (const PlannedJob& planned : jobs) {
    const auto& inputs = planned.job.inputs;
    EXPECT_EQ(inputs["protocol"]["mode"], "static") << planned.name;
    EXPECT_EQ(inputs["lattice"]["kinematics"], "small") << planned.name;
    EXPECT_NEAR(inputs["lattice"]["constants"]["kappa"].get<double>(), 70.0 * pascal, 1e-9);
    EXPECT_NEAR(inputs["lattice"]["constants"]["k1"].get<double>(),
                14.0 * pascal * inputs["lattice"]["spacing"].get<double>(), 1e-12);
  }
}

TEST(EquilibriumStudy, ErrorsAreThoseOfTheLatticeOfTheCase) {
  const TemporaryFolder folder;
  const EquilibriumStudy study = study_at(12);
  const double depth = lattice::PressSetup().protocol.depth;
  std::filesystem::create_directories(folder / "equilibrium/hookean");
  straight(110.0, depth).write_csv(folder / "equilibrium/hookean/response.csv");
  const auto errors = study.hookean_errors(folder.path(), straight(100.0, depth));
  ASSERT_EQ(errors.size(), 5U);
  for (const auto& error : errors) EXPECT_NEAR(error.get<double>(), 0.1, 1e-9);

  study.write_table(folder.path(), straight(100.0, depth));
  const std::string text = read_text(folder / "equilibrium_study.csv");
  EXPECT_EQ(text.find("model,spacing [m],indentation [m],normal_force [N],relative_error\n"), 0U);
  // Four presses at five depths, three of them not computed.
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 4 * 5);
  std::size_t empty = 0;
  for (std::size_t at = text.find(",,\n"); at != text.npos; at = text.find(",,\n", at + 1)) ++empty;
  EXPECT_EQ(empty, 3U * 5U);
}

}  // namespace
