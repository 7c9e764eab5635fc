#include "studies/config/elasticity.h"

#include <gtest/gtest.h>

#include "studies/config/documents.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
using fingertip::meshes::Rubber;

namespace {

LoadedConfig with(std::vector<std::string> sets) {
  return load_config({{}, std::move(sets), {}});
}

Rubber rubber(std::vector<std::string> sets) {
  return with(std::move(sets)).config.press.rubber;
}

std::string refusal(std::vector<std::string> sets) {
  try {
    with(std::move(sets));
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST(Elasticity, AnyTwoOfThreeGiveTheSameRubber) {
  const Rubber by_moduli =
      rubber({"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=115 kPa"});
  const std::string nu = "rubber.poissons_ratio=" + std::to_string(by_moduli.poissons_ratio());
  for (const char* modulus : {"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=115 kPa"}) {
    const Rubber other = rubber({modulus, nu});
    EXPECT_NEAR(other.youngs_modulus, 343e3, 1.0) << modulus;
    EXPECT_NEAR(other.shear_modulus, 115e3, 1.0) << modulus;
    EXPECT_TRUE(with({modulus, nu}).notes.empty());
  }
}

TEST(Elasticity, OneModulusTakesTheUsualPoissonsRatioAndSaysSo) {
  for (const char* modulus : {"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=115 kPa"}) {
    const LoadedConfig loaded = with({modulus});
    EXPECT_NEAR(loaded.config.press.rubber.poissons_ratio(), 0.49, 1e-12);
    ASSERT_EQ(loaded.notes.size(), 1U);
    EXPECT_NE(loaded.notes[0].find("0.49"), std::string::npos) << loaded.notes[0];
    EXPECT_NE(loaded.notes[0].find("kPa"), std::string::npos) << loaded.notes[0];
  }
  const LoadedConfig ratio = with({"rubber.poissons_ratio=0.3"});
  EXPECT_NEAR(ratio.config.press.rubber.poissons_ratio(), 0.3, 1e-12);
  EXPECT_NEAR(ratio.config.press.rubber.youngs_modulus, 3922.66, 1e-9);
  EXPECT_EQ(ratio.notes.size(), 1U);
  EXPECT_TRUE(with({}).notes.empty());
}

// Gent's paper and tables made with his formula: 30, 50, 70 Shore A are 1.14, 2.46, 5.55 MPa.
TEST(Elasticity, HardnessStandsForYoungsModulus) {
  EXPECT_NEAR(youngs_modulus_of_hardness(30.0), 1.142e6, 2e3);
  EXPECT_NEAR(youngs_modulus_of_hardness(50.0), 2.46e6, 1e4);
  EXPECT_NEAR(youngs_modulus_of_hardness(70.0), 5.52e6, 4e4);
  const LoadedConfig loaded = with({"rubber.shore_hardness=30", "rubber.poissons_ratio=0.48"});
  EXPECT_EQ(loaded.config.press.rubber.youngs_modulus, youngs_modulus_of_hardness(30.0));
  EXPECT_NEAR(loaded.config.press.rubber.poissons_ratio(), 0.48, 1e-12);
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_NE(loaded.notes[0].find("Gent"), std::string::npos);
}

TEST(Elasticity, ThreeConstantsAreRefused) {
  const std::string three = refusal({"rubber.youngs_modulus=343 kPa",
                                     "rubber.shear_modulus=115 kPa", "rubber.poissons_ratio=0.49"});
  for (const char* part : {"rubber.poissons_ratio = 0.49", "343 kPa", "115 kPa", "leave one"})
    EXPECT_NE(three.find(part), std::string::npos) << part << " in " << three;
  EXPECT_NE(refusal({"rubber.youngs_modulus=343 kPa", "rubber.shore_hardness=30"}).find("343 kPa"),
            std::string::npos);
  EXPECT_EQ(refusal({"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=115 kPa",
                     "rubber.poissons_ratio=auto"}),
            "");
}

// A run's parameters.toml holds every key, and is the same rubber again.
TEST(Elasticity, ResolvedParametersAreTheSameRubber) {
  const std::vector<std::vector<std::string>> given = {
      {},
      {"rubber.youngs_modulus=343 kPa"},
      {"rubber.shear_modulus=115 kPa"},
      {"rubber.poissons_ratio=0.3"},
      {"rubber.shore_hardness=30"},
      {"rubber.shore_hardness=30", "rubber.shear_modulus=390 kPa"},
      {"rubber.shear_modulus=115 kPa", "rubber.poissons_ratio=0.3"}};
  for (const auto& sets : given) {
    const TemporaryFolder folder;
    const LoadedConfig first = with(sets);
    write_text(folder / "parameters.toml", parameters_toml(first, "test"));
    const LoadedConfig second = load_config({folder / "parameters.toml", {}, {}});
    EXPECT_EQ(first.config.press.rubber.youngs_modulus, second.config.press.rubber.youngs_modulus);
    EXPECT_EQ(first.config.press.rubber.shear_modulus, second.config.press.rubber.shear_modulus);
    // A further setting finds what was given, and nothing that was derived.
    const Rubber deeper = first.with({"press.depth=1 mm"}).config.press.rubber;
    EXPECT_EQ(first.config.press.rubber.shear_modulus, deeper.shear_modulus);
  }
}

TEST(Elasticity, BlanksAroundTheEqualsSignDoNotMatter) {
  EXPECT_EQ(rubber({"rubber.density = 1 g/cm^3"}).density, 1000.0);
  EXPECT_EQ(rubber({" rubber.density =\"1 g/cm^3\" "}).density, 1000.0);
}
