#include "studies/config/finger_defaults.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lattice/press/press_deviation.h"
#include "meshes/cells/cubic_grid.h"
#include "tests/studies/loaded.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

using Sets = std::vector<std::string>;

LoadedConfig automatic(Sets sets) {
  sets.emplace_back("lattice.spacing=auto");
  return config_of(sets);
}

std::string note_of(const LoadedConfig& loaded) {
  return spacing_note(loaded);
}

}  // namespace

TEST(AutomaticSpacing, IsTheCoarsestThatKeepsTheTolerance) {
  for (const Sets& sets : {Sets{}, Sets{"press.samples=[\"0.5 mm\", \"2 mm\"]"},
                           Sets{"obstacle.shape=sphere", "obstacle.radius=8 mm"},
                           Sets{"lattice.tolerance=0.05", "lattice.model=network"}}) {
    const LoadedConfig loaded = automatic(sets);
    const lattice::PressSetup& press = loaded.config.press;
    const bool asked = loaded.entries.at("press.samples").given;
    const double depth = asked ? press.protocol.samples.front() : 0.1 * press.protocol.depth,
                 tolerance = loaded.config.spacing_tolerance,
                 divisor = loaded.config.spacing_divisor.value();
    EXPECT_EQ(divisor, std::round(divisor));
    EXPECT_DOUBLE_EQ(press.lattice.spacing, press.geometry.tip_radius / divisor);
    EXPECT_LE(lattice::ForceEstimator(press).at(depth)->grid(), tolerance);
    lattice::PressSetup coarser = press;
    coarser.lattice.spacing = press.geometry.tip_radius / (divisor - 1.0);
    EXPECT_GT(lattice::ForceEstimator(coarser).at(depth)->grid(), tolerance);
    EXPECT_TRUE(says(note_of(loaded), {"lattice.spacing = \"auto\"", "tip_radius/", "wanted"}))
        << note_of(loaded);
  }
}

TEST(AutomaticSpacing, AsksForMoreWhereLessTouches) {
  const auto spacing = [](const Sets& sets) {
    return automatic(sets).config.press.lattice.spacing;
  };
  const double plain = spacing({});
  EXPECT_LT(spacing({"obstacle.shape=sphere", "obstacle.radius=5 mm"}), plain);
  EXPECT_LT(spacing({"lattice.tolerance=0.01"}), plain);
  EXPECT_LT(spacing({"press.samples=[\"0.1 mm\", \"3 mm\"]"}), plain);
  EXPECT_GT(spacing({"press.samples=[\"1 mm\", \"3 mm\"]"}), plain);
  // Of derived presses anew.
  const LoadedConfig derived = with_sets(automatic({}), {"press.samples=[\"1 mm\", \"3 mm\"]"});
  EXPECT_GT(derived.config.press.lattice.spacing, plain);
}

TEST(AutomaticSpacing, EndsWhereThereWouldBeTooManyMassesAndSaysSo) {
  const LoadedConfig loaded = automatic({"lattice.tolerance=0.004", "lattice.max_particles=20000"});
  const lattice::PressSetup& press = loaded.config.press;
  EXPECT_LE(meshes::expected_particle_count(press.geometry, press.lattice.spacing), 2e4);
  EXPECT_GT(meshes::expected_particle_count(press.geometry, 0.9 * press.lattice.spacing), 2e4);
  EXPECT_TRUE(says(note_of(loaded), {"lattice.max_particles = 2e+04", "0.4 % wanted"}))
      << note_of(loaded);
}

TEST(AutomaticSpacing, NeverMakesAFingerRefuse) {
  // Half of the wall is finer than what the tolerance asks for.
  const LoadedConfig thin = automatic({"geometry.rod_radius=9.4 mm", "press.depth=0.2 mm",
                                       "lattice.tolerance=0.5", "lattice.max_particles=100"});
  EXPECT_LE(thin.config.press.lattice.spacing, 0.3e-3 * (1.0 + 1e-9));
  EXPECT_TRUE(says(note_of(thin), {"more than lattice.max_particles = 100", "walls"}))
      << note_of(thin);
  const LoadedConfig published = automatic({"lattice.model=published", "geometry.tip_radius=2 cm"});
  EXPECT_EQ(published.config.spacing_divisor,
            automatic({"geometry.tip_radius=2 cm"}).config.spacing_divisor);
  EXPECT_TRUE(says(note_of(published), {"of a hookean lattice", "published springs"}))
      << note_of(published);
}

TEST(AutomaticSpacing, IsOneForAllModels) {
  const auto divisor = [](const std::string& model) {
    return automatic({"lattice.model=" + model}).config.spacing_divisor;
  };
  for (const char* model : {"published", "central", "network"})
    EXPECT_EQ(divisor(model), divisor("hookean")) << model;
}

/// Of another press, but for walls that ask for more.
TEST(AutomaticSpacing, CanBeKept) {
  const LoadedConfig base = automatic({});
  LoadedConfig shallow = automatic({"press.samples=[\"0.1 mm\"]"});
  ASSERT_GT(shallow.config.spacing_divisor, base.config.spacing_divisor);
  keep_spacing(shallow, base);
  EXPECT_EQ(shallow.config.press.lattice.spacing, base.config.press.lattice.spacing);
  LoadedConfig thin = automatic({"geometry.rod_radius=9.4 mm"});
  keep_spacing(thin, base);
  EXPECT_TRUE(thin.config.press.lattice.spacing <= thin.config.press.geometry.coarsest_spacing());
  EXPECT_EQ(thin.config.spacing_divisor, 34.0);
  LoadedConfig given = config_of({"lattice.spacing=tip_radius/9"});
  keep_spacing(given, base);
  EXPECT_EQ(given.config.spacing_divisor, 9.0);
}

/// parameters.toml gives every key.
TEST(AutomaticSpacing, IsTheSameWhereEverythingIsGivenAtItsDefault) {
  EXPECT_EQ(automatic({"press.samples=[]"}).config.spacing_divisor,
            automatic({}).config.spacing_divisor);
}
