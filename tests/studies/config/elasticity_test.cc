#include "studies/config/elasticity.h"

#include <gtest/gtest.h>

#include "studies/config/documents.h"
#include "tests/studies/loaded.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
using fingertip::meshes::Rubber;

namespace {

Rubber rubber(const std::vector<std::string>& sets) {
  return config_of(sets).config.press.rubber;
}

std::string refusal_of(const std::vector<std::string>& sets) {
  return config_refusal([&] { config_of(sets); });
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
    EXPECT_TRUE(config_of({modulus, nu}).notes.empty());
  }
}

TEST(Elasticity, OneModulusTakesTheUsualPoissonsRatioAndSaysSo) {
  for (const char* modulus : {"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=115 kPa"}) {
    const LoadedConfig loaded = config_of({modulus});
    EXPECT_NEAR(loaded.config.press.rubber.poissons_ratio(), 0.49, 1e-12);
    ASSERT_EQ(loaded.notes.size(), 1U);
    EXPECT_TRUE(says(loaded.notes[0], {"0.49", "kPa"}));
  }
  const LoadedConfig ratio = config_of({"rubber.poissons_ratio=0.3"});
  EXPECT_NEAR(ratio.config.press.rubber.poissons_ratio(), 0.3, 1e-12);
  EXPECT_NEAR(ratio.config.press.rubber.youngs_modulus, 3922.66, 1e-9);
  EXPECT_EQ(ratio.notes.size(), 1U);
  EXPECT_TRUE(config_of({}).notes.empty());
}

TEST(Elasticity, ANegativePoissonsRatioIsTold) {
  const LoadedConfig loaded =
      config_of({"rubber.youngs_modulus=0.69 MPa", "rubber.shear_modulus=1 MPa"});
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_TRUE(says(loaded.notes[0],
                   {"Poisson's ratio is -0.655", "E = 690 kPa", "G = 1000 kPa", "231.5 kPa"}));
  EXPECT_EQ(config_of({"rubber.youngs_modulus=1 MPa", "rubber.poissons_ratio=-0.2"}).notes.size(),
            1U);
}

TEST(Elasticity, AModulusThatNoRubberHasIsToldNotRefused) {
  const auto notes = config_of({"rubber.youngs_modulus=60 Pa", "rubber.poissons_ratio=0.45"}).notes;
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(says(notes[0], {"E = 60 Pa is no rubber's", "60 kPa is meant"}));
  // Where it follows from another key.
  EXPECT_TRUE(says(config_of({"rubber.shear_modulus=20 GPa"}).notes.back(), "59.6 MPa is meant"));
  EXPECT_TRUE(
      config_of({"rubber.youngs_modulus=1 kPa", "rubber.poissons_ratio=0.45"}).notes.empty());
}

TEST(Elasticity, RemediesAreValuesThatServe) {
  const auto holds = [](const char* set, const char* part) {
    const std::string text = refusal_of({set});
    EXPECT_TRUE(says(text, part));
  };
  holds("rubber.shore_hardness=60 A", "write shore_hardness = 60");
  holds("rubber.shore_hardness=60 A", "of Shore 00 or D give E");
  holds("rubber.shore_hardness=soft", "write e.g. shore_hardness = 50");
  holds("rubber.poissons_ratio=\"0.45\"", "write poissons_ratio = 0.45");
  holds("rubber.bulk_modulus=true", "write e.g. bulk_modulus = \"1 Pa\"");
}

// Gent's paper and tables made with his formula: 30, 50, 70 Shore A are 1.14, 2.46, 5.55 MPa.
TEST(Elasticity, HardnessStandsForYoungsModulus) {
  EXPECT_NEAR(youngs_modulus_of_hardness(30.0), 1.142e6, 2e3);
  EXPECT_NEAR(youngs_modulus_of_hardness(50.0), 2.46e6, 1e4);
  EXPECT_NEAR(youngs_modulus_of_hardness(70.0), 5.52e6, 4e4);
  const LoadedConfig loaded = config_of({"rubber.shore_hardness=30", "rubber.poissons_ratio=0.48"});
  EXPECT_EQ(loaded.config.press.rubber.youngs_modulus, youngs_modulus_of_hardness(30.0));
  EXPECT_NEAR(loaded.config.press.rubber.poissons_ratio(), 0.48, 1e-12);
  ASSERT_EQ(loaded.notes.size(), 1U);
  EXPECT_TRUE(says(loaded.notes[0], "Gent"));
}

TEST(Elasticity, ThreeConstantsAreRefused) {
  const std::string three =
      refusal_of({"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=115 kPa",
                  "rubber.poissons_ratio=0.49"});
  EXPECT_TRUE(says(three, {"rubber.poissons_ratio = 0.49", "343 kPa", "115 kPa", "leave one"}));
  EXPECT_TRUE(
      says(refusal_of({"rubber.youngs_modulus=343 kPa", "rubber.shore_hardness=30"}), "343 kPa"));
  EXPECT_EQ(refusal_of({"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=115 kPa",
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
      {"rubber.shear_modulus=115 kPa", "rubber.poissons_ratio=0.3"},
      {"rubber.shear_modulus=115 kPa", "rubber.bulk_modulus=3 MPa"},
      {"rubber.law=yeoh", "rubber.yeoh=[\"2 kPa\", \"0.2 kPa\"]", "rubber.bulk_modulus=3 MPa"},
      {"rubber.law=ogden", "rubber.ogden=[[\"6 kPa\", 1.3], [\"2 kPa\", -2]]"}};
  for (const auto& sets : given) {
    const TemporaryFolder folder;
    const LoadedConfig first = config_of(sets);
    write_text(folder / "parameters.toml", parameters_toml(first, "test"));
    const LoadedConfig second = load_config({folder / "parameters.toml", {}, {}});
    EXPECT_EQ(first.config.press.rubber.youngs_modulus, second.config.press.rubber.youngs_modulus);
    EXPECT_EQ(first.config.press.rubber.shear_modulus, second.config.press.rubber.shear_modulus);
    EXPECT_EQ(first.config.press.rubber.energy, second.config.press.rubber.energy);
    // A further setting finds what was given, and nothing that was derived.
    const Rubber deeper = with_sets(first, {"press.depth=1 mm"}).config.press.rubber;
    EXPECT_EQ(first.config.press.rubber.shear_modulus, deeper.shear_modulus);
  }
}

TEST(Elasticity, ABulkModulusStandsForPoissonsRatio) {
  const Rubber truth = rubber({"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=120 kPa"});
  const std::string K = "rubber.bulk_modulus=" + std::to_string(truth.bulk_modulus()) + " Pa";
  const std::string nu = "rubber.poissons_ratio=" + std::to_string(truth.poissons_ratio());
  for (const std::string& other : {std::string("rubber.youngs_modulus=343 kPa"),
                                   std::string("rubber.shear_modulus=120 kPa"), nu}) {
    const Rubber found = rubber({other, K});
    EXPECT_NEAR(found.youngs_modulus / 343e3, 1.0, 1e-4) << other;
    EXPECT_NEAR(found.shear_modulus / 120e3, 1.0, 1e-4) << other;
  }
  EXPECT_NE(refusal_of({"rubber.youngs_modulus=343 kPa", "rubber.bulk_modulus=30 kPa"}), "");
  EXPECT_NE(refusal_of({"rubber.youngs_modulus=343 kPa", "rubber.shear_modulus=120 kPa", K}), "");
}

TEST(Elasticity, CoefficientsTellTheShearModulusAndTheLaw) {
  using fingertip::meshes::RubberLaw;
  const auto yeoh = rubber({"rubber.law=yeoh", "rubber.yeoh=[\"2 kPa\", \"0.2 kPa\"]"});
  EXPECT_EQ(yeoh.energy.law, RubberLaw::yeoh);
  EXPECT_NEAR(yeoh.shear_modulus, 4e3, 1e-9);
  EXPECT_NEAR(yeoh.poissons_ratio(), 0.49, 1e-12);
  EXPECT_NEAR(yeoh.energy.shape[0], 0.05, 1e-12);
  const auto mooney =
      rubber({"rubber.law=mooney-rivlin", "rubber.mooney_rivlin=[\"3 kPa\", \"1 kPa\"]",
              "rubber.poissons_ratio=0.45"});
  EXPECT_NEAR(mooney.shear_modulus, 8e3, 1e-9);
  EXPECT_NEAR(mooney.poissons_ratio(), 0.45, 1e-12);
  EXPECT_NEAR(mooney.energy.shape[0], 0.25, 1e-12);
  const auto ogden = rubber({"rubber.law=ogden", "rubber.ogden=[[\"6 kPa\", 1.3], [\"2 kPa\", -2]]",
                             "rubber.bulk_modulus=2 MPa"});
  EXPECT_NEAR(ogden.shear_modulus, 8e3, 1e-9);
  EXPECT_NEAR(ogden.bulk_modulus(), 2e6, 1.0);
  EXPECT_NEAR(ogden.energy.shape[0], 0.75, 1e-12);
  EXPECT_NEAR(ogden.energy.shape[3], -2.0, 1e-12);
  const auto gent =
      rubber({"rubber.law=gent", "rubber.gent_jm=9.0", "rubber.youngs_modulus=12 kPa"});
  EXPECT_NEAR(gent.energy.shape[0], 9.0, 1e-12);
}

TEST(Elasticity, LawsWithoutTheirCoefficientsAreRefused) {
  EXPECT_TRUE(says(refusal_of({"rubber.law=yeoh"}), "needs its coefficients"));
  EXPECT_TRUE(says(refusal_of({"rubber.law=gent"}), "rubber.gent_jm"));
  EXPECT_TRUE(says(refusal_of({"rubber.law=mooney-rivlin", "rubber.mooney_rivlin=[\"3 kPa\"]"}),
                   "two coefficients"));
  EXPECT_TRUE(says(refusal_of({"rubber.law=ogden", "rubber.ogden=[[\"6 kPa\"]]"}), "pairs"));
  EXPECT_TRUE(
      says(refusal_of({"rubber.law=yeoh", "rubber.yeoh=[\"2 kPa\"]", "rubber.shear_modulus=4 kPa"}),
           "the coefficients tell the stiffness"));
  EXPECT_TRUE(says(refusal_of({"rubber.law=yeoh", "rubber.yeoh=[\"2 kPa\", \"-0.3 kPa\"]"}),
                   "fails at 0.747"));
  EXPECT_TRUE(says(refusal_of({"rubber.law=gent", "rubber.gent_jm=9.0", "reference.law=B"}),
                   "rubber.volumetric"));
}

TEST(Elasticity, BlanksAroundTheEqualsSignDoNotMatter) {
  EXPECT_EQ(rubber({"rubber.density = 1 g/cm^3"}).density, 1000.0);
  EXPECT_EQ(rubber({" rubber.density =\"1 g/cm^3\" "}).density, 1000.0);
}
