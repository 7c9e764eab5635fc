/// The job of material tests, its files, and a card as configuration.
#include "studies/fits/runs/law_job.h"

#include <gtest/gtest.h>

#include <cmath>

#include "calibration/material_tests/law_card.h"
#include "meshes/base/errors.h"
#include "studies/config/documents.h"
#include "studies/config/law_card_keys.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

class LawJob : public testing::Test {
 protected:
  void SetUp() override {
    std::string tension = "stretch,stress\n", sheet = tension;
    for (int i = -8; i <= 20; ++i) {
      if (i == 0) continue;
      const double l = 1.0 + 0.05 * i, w = 15.0 + 0.5 * (l * l + 2.0 / l - 3.0);
      tension += std::to_string(l) + "," + std::to_string(2.0 * w * (l - 1.0 / (l * l))) + "\n";
      const double v = 15.0 + 0.5 * (l * l + 1.0 / (l * l) - 2.0);
      sheet += std::to_string(l) + "," + std::to_string(2.0 * v * (l - 1.0 / (l * l * l))) + "\n";
    }
    write_text(folder_ / "tension.csv", tension);
    write_text(folder_ / "sheet.csv", sheet);
    describe("kPa");
  }
  void describe(const std::string& unit) {
    write_text(folder_ / "tests.toml",
               "[about]\nmaterial = \"made\"\nlicence = \"none\"\n[data]\n"
               "strain = {column = \"stretch\", is = \"stretch\"}\n"
               "stress = {column = \"stress\", is = \"nominal\", unit = \"" +
                   unit +
                   "\"}\n[[test]]\nkind = \"uniaxial\"\npath = \"tension.csv\"\n"
                   "[[test]]\nkind = \"planar\"\npath = \"sheet.csv\"\nuse = \"predict\"\n");
  }
  LoadedConfig configured(std::vector<std::string> sets = {}) const {
    sets.insert(sets.begin(), {"calibration.problem=material",
                               "calibration.tests=" + (folder_ / "tests.toml").string()});
    return load_config({{}, sets, {}});
  }
  void run(const LawInput& input) const {
    JobContext context;
    context.report = [](double, const std::string&) { return true; };
    context.log = [](const std::string&) {};
    law_job(input).run(folder_.path(), context);
  }

  TemporaryFolder folder_;
};

TEST_F(LawJob, WritesTheCardOfTheTrueLawWhichAPressTakes) {
  run(law_input(configured()));
  const auto card = calibration::read_law_card(folder_ / "material.toml");
  EXPECT_EQ(card.material, "made");
  EXPECT_EQ(card.tests.size(), 2u);
  EXPECT_FALSE(card.tests[1].fitted);
  EXPECT_LT(card.tests[1].largest_relative, 1e-3);
  EXPECT_EQ(card.choice.law, meshes::RubberLaw::yeoh);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "laws.json"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "cards/ogden-2.toml"));
  const std::string use = "rubber.card=" + (folder_ / "material.toml").string();
  const LoadedConfig loaded = load_config({{}, {use, "rubber.poissons_ratio=0.48"}, {}});
  const meshes::Rubber& rubber = loaded.config.press.rubber;
  EXPECT_EQ(rubber.energy.law, meshes::RubberLaw::yeoh);
  EXPECT_NEAR(rubber.shear_modulus, 30e3, 30.0);
  EXPECT_NEAR(rubber.poissons_ratio(), 0.48, 1e-12);
  // What a run writes down can be read again.
  write_text(folder_ / "again.toml", parameters_toml(loaded, ""));
  EXPECT_EQ(load_config({folder_ / "again.toml", {}, {}}).config.press.rubber.energy,
            rubber.energy);
  EXPECT_THROW(load_config({{}, {use, "rubber.law=gent"}, {}}), ConfigError);
  EXPECT_THROW(load_config({{}, {use, "rubber.youngs_modulus=20 kPa"}, {}}), ConfigError);
}

TEST_F(LawJob, APressBeyondTheTestsIsTold) {
  run(law_input(configured({"calibration.laws=[\"yeoh-2\"]"})));
  const std::string use = "rubber.card=" + (folder_ / "cards/yeoh-2.toml").string();
  const auto told = [&](const char* depth) {
    const auto loaded = load_config({{}, {use, std::string("press.depth=") + depth}, {}});
    for (const std::string& note : loaded.notes)
      if (note.find("beyond, it is a guess") != note.npos) return true;
    return false;
  };
  EXPECT_FALSE(told("0.1 cm"));
  write_text(folder_ / "tests.toml", read_text(folder_ / "tests.toml") + "range = [0.95, 1.05]\n");
  std::string text = read_text(folder_ / "cards/yeoh-2.toml");
  const auto at = text.find("smallest_stretch = ");
  text.replace(at, text.find('\n', at) - at, "smallest_stretch = 0.99");
  write_text(folder_ / "cards/yeoh-2.toml", text);
  EXPECT_TRUE(told("0.1 cm"));
}

TEST_F(LawJob, EveryLawsCardBecomesKeysAndBack) {
  run(law_input(configured()));
  for (const auto& law : calibration::known_laws()) {
    const auto file = folder_ / ("cards/" + name(law) + ".toml");
    ASSERT_TRUE(std::filesystem::exists(file)) << file;
    const auto card = calibration::read_law_card(file);
    std::vector<std::string> sets;
    for (const auto& [key, literal] : keys_of(card)) sets.push_back(key + "=" + literal);
    try {
      const auto& rubber = load_config({{}, sets, {}}).config.press.rubber;
      const auto sized = card.law();
      EXPECT_NEAR(rubber.shear_modulus, sized.shear_modulus, 1e-9 * sized.shear_modulus);
      for (std::size_t i = 0; i < 6; ++i)
        EXPECT_NEAR(rubber.energy.shape[i], sized.energy.shape[i],
                    1e-12 * (1.0 + std::abs(sized.energy.shape[i])));
    } catch (const ConfigError& error) {  // unstable ones are refused with their stretch
      EXPECT_NE(std::string(error.what()).find("stable (Drucker)"), std::string::npos)
          << error.what();
    }
  }
}

/// Ramp and hold of a neo-Hookean rubber of G = 20 kPa, 30 % of which fade in 2 s.
class RelaxingLawJob : public LawJob {
 protected:
  void SetUp() override {
    const double b = 0.3 / 0.7, s = 20.0 * (1.3 - 1.0 / (1.3 * 1.3));
    std::string hold = "time,stress\n", slow = "stretch,stress\n";
    for (int i = 1; i <= 80; ++i) {
      const double t = 0.05 * std::pow(2000.0, i / 80.0);
      hold += std::to_string(t) + "," + std::to_string(s * (1.0 + b * std::exp(-t / 2.0))) + "\n";
    }
    for (int i = 1; i <= 20; ++i) {
      const double l = 1.0 + 0.03 * i;
      slow += std::to_string(l) + "," + std::to_string(20.0 * (l - 1.0 / (l * l))) + "\n";
    }
    write_text(folder_ / "hold.csv", hold);
    write_text(folder_ / "slow.csv", slow);
    write_text(folder_ / "tests.toml",
               "[data]\nstress = {column = \"stress\", is = \"nominal\", unit = \"kPa\"}\n"
               "[[test]]\nkind = \"relaxation\"\npath = \"hold.csv\"\n"
               "time = {column = \"time\"}\nstrain = {value = 1.3, is = \"stretch\"}\n"
               "[[test]]\nkind = \"uniaxial\"\npath = \"slow.csv\"\n"
               "strain = {column = \"stretch\", is = \"stretch\"}\n");
  }
};

TEST_F(RelaxingLawJob, TriesBranchesWhereATestGoesInTime) {
  const auto names = [&](const std::vector<std::string>& sets) {
    std::string all;
    for (const auto& law : law_input(configured(sets)).laws) all += name(law) + " ";
    return all;
  };
  const std::string one = "calibration.laws=[\"gent\"]";
  EXPECT_EQ(names({one}), "gent gent+prony-1 gent+prony-2 gent+prony-3 ");
  EXPECT_EQ(names({one, "calibration.branches=0"}), "gent ");
  EXPECT_EQ(names({"calibration.laws=[\"gent+prony-2\", \"yeoh-2\"]", "calibration.branches=1"}),
            "gent+prony-2 yeoh-2 yeoh-2+prony-1 ");
  const std::string key = law_job(law_input(configured({one}))).key();
  EXPECT_NE(law_job(law_input(configured({one, "calibration.branches=2"}))).key(), key);
  std::string text = read_text(folder_ / "hold.csv");
  write_text(folder_ / "hold.csv", text.replace(text.find("0.05"), 4, "0.04"));
  EXPECT_NE(law_job(law_input(configured({one}))).key(), key);
}

TEST_F(RelaxingLawJob, ACardIsTheKeysGivenByHand) {
  run(law_input(configured({"calibration.laws=[\"neo-hookean\"]"})));
  const auto card = calibration::read_law_card(folder_ / "material.toml");
  ASSERT_EQ(name(card.choice), "neo-hookean+prony-1");
  EXPECT_NEAR(card.relaxation().branches[0].share, 0.3, 1e-3);
  EXPECT_NEAR(card.relaxation().branches[0].time, 2.0, 1e-2);
  const std::string use = "rubber.card=" + (folder_ / "material.toml").string();
  const LoadedConfig by_card =
      load_config({{}, {use, "rubber.poissons_ratio=0.45", "lattice.model=network"}, {}});
  std::vector<std::string> sets = {"rubber.poissons_ratio=0.45", "lattice.model=network"};
  for (const auto& [key, literal] : keys_of(card)) sets.push_back(key + "=" + literal);
  const LoadedConfig by_hand = load_config({{}, sets, {}});
  const meshes::Rubber &a = by_card.config.press.rubber, &b = by_hand.config.press.rubber;
  EXPECT_EQ(a.relaxation, b.relaxation);
  EXPECT_EQ(a.relaxation.branches.at(0).share, card.relaxation().branches[0].share);
  // Quantities are read to fifteen digits.
  EXPECT_NEAR(a.relaxation.branches[0].time / card.relaxation().branches[0].time, 1.0, 5e-15);
  EXPECT_EQ(a.shear_modulus, b.shear_modulus);
  EXPECT_EQ(a.youngs_modulus, b.youngs_modulus);
  EXPECT_EQ(a.energy, b.energy);
  // Another relaxation contradicts the card, none is its rubber after long times.
  EXPECT_THROW(load_config({{}, {use, "rubber.relaxation=[[0.1, \"1 s\"]]"}, {}}), ConfigError);
  const LoadedConfig lasting = load_config({{}, {use, "rubber.relaxation=[]"}, {}});
  EXPECT_TRUE(lasting.config.press.rubber.relaxation.empty());
  EXPECT_EQ(lasting.config.press.rubber.shear_modulus, a.shear_modulus);
}

TEST_F(RelaxingLawJob, APressOfOtherTimesIsTold) {
  run(law_input(configured({"calibration.laws=[\"neo-hookean\"]"})));
  const std::string use = "rubber.card=" + (folder_ / "material.toml").string();
  const auto told = [&](const char* speed) {
    for (const std::string& note : load_config({{}, {use, speed}, {}}).notes)
      if (note.find("pressing takes") != note.npos) return true;
    return false;
  };
  EXPECT_FALSE(told("press.speed=1 cm/s"));
  EXPECT_TRUE(told("press.speed=100 cm/s"));
}

/// A test that a volumetric one joins knows what a change of volume costs.
TEST_F(LawJob, AVolumetricTestSetsWhatVolumeCosts) {
  write_text(folder_ / "bulk.csv", "J,p\n0.97,60\n0.98,40\n0.99,20\n");
  write_text(folder_ / "tests.toml",
             read_text(folder_ / "tests.toml") +
                 "[[test]]\nkind = \"volumetric\"\npath = \"bulk.csv\"\n"
                 "strain = {column = \"J\", is = \"volume-ratio\"}\n"
                 "stress = {column = \"p\", is = \"pressure\", unit = \"kPa\"}\n");
  run(law_input(configured({"calibration.laws=[\"neo-hookean\"]"})));
  const std::string use = "rubber.card=" + (folder_ / "material.toml").string();
  const auto& rubber = load_config({{}, {use}, {}}).config.press.rubber;
  EXPECT_EQ(rubber.energy.volumetric, meshes::VolumetricLaw::quadratic);
  EXPECT_NEAR(rubber.bulk_modulus(), 2e6, 2e4);
  EXPECT_THROW(load_config({{}, {use, "rubber.volumetric=logarithmic"}, {}}), ConfigError);
}

TEST_F(LawJob, KnowsWhatItsResultDependsOn) {
  const std::string key = law_job(law_input(configured())).key();
  EXPECT_EQ(law_job(law_input(configured())).key(), key);
  for (const char* set : {"calibration.laws=[\"gent\"]", "calibration.weights=point",
                          "calibration.stretch_range=[0.6, 2.0]", "calibration.seed=7"})
    EXPECT_NE(law_job(law_input(configured({set}))).key(), key) << set;
  describe("MPa");
  EXPECT_NE(law_job(law_input(configured())).key(), key);
  describe("kPa");
  EXPECT_EQ(law_job(law_input(configured())).key(), key);
  write_text(folder_ / "theirs.json", "{\"sum\": 3.0}");
  write_text(folder_ / "tests.toml",
             read_text(folder_ / "tests.toml") +
                 "[test.published]\npath = \"theirs.json\"\nunit = \"Pa^2\"\ngent = \"sum\"\n");
  EXPECT_NE(law_job(law_input(configured())).key(), key) << "laws.json tells it";
}

TEST_F(LawJob, RefusesWithTheKeysPlace) {
  const auto refused = [&](const std::vector<std::string>& sets, const char* part) {
    try {
      law_input(configured(sets));
      ADD_FAILURE() << part;
    } catch (const ConfigError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  refused({"calibration.laws=[\"hooke\"]"}, "must be among neo-hookean");
  refused({"calibration.stretch_range=[1.2, 2.0]"}, "must hold 1");
  refused({"calibration.tests=none"}, "described by a file");
  describe("cm");
  refused({}, "tests.toml:6");
  EXPECT_THROW(load_config({{}, {"rubber.card=" + (folder_ / "tests.toml").string()}, {}}),
               ConfigError);
}

}  // namespace
