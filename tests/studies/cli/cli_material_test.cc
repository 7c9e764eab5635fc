/// `calibrate` of material tests in time: from files to a card, and a press with it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <sstream>

#include "tests/studies/workplace.h"

namespace {

/// A neo-Hookean rubber of G = 14 kPa, a quarter of which fades in 20 ms: held at once at 1.3, and
/// sheared to and fro at 5 Hz by small amounts after a second's rest.
class MaterialInTime : public testing::Test {
 protected:
  void SetUp() override {
    const double b = 0.25 / 0.75, stress = 14.0 * (1.3 - 1.0 / (1.3 * 1.3));
    std::ostringstream hold;
    hold << "t [ms],s [kPa]\n";
    for (int i = 0; i < 50; ++i) {
      const double t = std::pow(1000.0, i / 49.0);
      hold << t << ',' << stress * (1.0 + b * std::exp(-t / 20.0)) << '\n';
    }
    std::ostringstream cycles;
    cycles.precision(12);
    cycles << "t,g,s\n";
    double held = 0.0, before = 0.0;
    for (int i = 0; i <= 200; ++i) {
      const double g = 0.02 * std::sin(2.0 * M_PI * i / 100.0), keep = std::exp(-0.1);
      held = keep * held + (1.0 - keep) / 0.1 * (g - before);
      before = g;
      cycles << 2e-3 * i << ',' << g << ',' << 14.0 * (g + b * held) << '\n';
    }
    folder_.put("hold.csv", hold.str());
    folder_.put("cycles.csv", cycles.str());
    describe("cycles.csv");
  }
  void describe(const std::string& cycles) const {
    folder_.put("tests.toml",
                "[[test]]\nkind = \"relaxation\"\npath = \"hold.csv\"\n"
                "time = {column = 1, unit = \"ms\"}\nstrain = {value = 1.3, is = \"stretch\"}\n"
                "stress = {column = 2, is = \"nominal\", unit = \"kPa\"}\n"
                "[[test]]\nkind = \"cycles\"\ndeformation = \"simple-shear\"\n"
                "name = \"to and fro\"\npath = \"" +
                    cycles +
                    "\"\ntime = {column = \"t\"}\nstrain = {column = \"g\", is = \"shear\"}\n"
                    "stress = {column = \"s\", is = \"nominal\", unit = \"kPa\"}\n");
  }
  ProgramResult fit(int code) const {
    return folder_.run("calibrate --out laws",
                       {"calibration.problem=material", "calibration.tests=tests.toml",
                        "calibration.laws=[\"neo-hookean\"]"},
                       code);
  }
  const Workplace folder_;
};

TEST_F(MaterialInTime, FromFilesToACardThatPressesAsItsKeysDo) {
  EXPECT_TRUE(says(fit(0).out, {"measured, J/m^3", "rubber.card=PATH --set lattice.model=network"}))
      << "the lattice that takes a law";
  const std::string card = folder_.text("laws/material.toml");
  EXPECT_TRUE(says(card, {"name = \"neo-hookean+prony-1\"", "relaxation_tau1_interval"}));
  const auto number_after = [&](const std::string& key) {
    const std::string mark = "\n" + key + " = ";
    std::string text = card.substr(card.find(mark) + mark.size());
    text = text.substr(0, text.find('\n'));
    std::erase(text, '"');
    return text;
  };
  const std::string g = number_after("shear_modulus"), share = number_after("relaxation_g1"),
                    tau = number_after("relaxation_tau1");
  EXPECT_NEAR(std::stod(share), 0.25, 1e-3);
  EXPECT_NEAR(std::stod(tau), 0.02, 1e-4);
  const Words network = {"lattice.model=network", "rubber.poissons_ratio=0.45"};
  const std::string by_card = "rubber.card=laws/material.toml";
  const auto press = [&](const std::string& out, const Words& keys) {
    folder_.run("press --out " + out,
                network + keys +
                    Words{"press.mode=quasi-static", "press.speed=5 cm/s", "press.depth=0.05 cm",
                          "lattice.spacing=tip_radius/5"});
    return folder_.text(out + "/response.csv");
  };
  const std::string response = press("card", {by_card});
  EXPECT_GT(response.size(), 200u);
  EXPECT_EQ(response, press("hand", {"rubber.shear_modulus=" + g, "rubber.law=neo-hookean",
                                     "rubber.relaxation=[[" + share + ", \"" + tau + "\"]]"}));
  EXPECT_NE(response, press("lasting", {by_card, "rubber.relaxation=[]"}));
  // In equilibrium there is no time.
  folder_.expect_refused("press --out static", network + Words{"press.mode=static", by_card},
                         {"laws/material.toml", "rubber.relaxation = []"});
}

/// A foam, 0.6 MPa in tension and 0.25 MPa in compression, which no law that keeps its volume
/// meets.
TEST(MaterialVerdict, WhatIsNotMetIsNotAcceptedButByForce) {
  const Workplace folder;
  std::string pulled = "e,s\n", pressed = pulled;
  for (int i = 1; i <= 20; ++i) {
    pulled += std::to_string(0.01 * i) + "," + std::to_string(0.006 * i) + "\n";
    pressed += std::to_string(-0.01 * (21 - i)) + "," + std::to_string(-0.0025 * (21 - i)) + "\n";
  }
  folder.put("pulled.csv", pulled);
  folder.put("pressed.csv", pressed);
  folder.put("tests.toml",
             "[data]\nstrain = {column = \"e\", is = \"engineering\"}\n"
             "stress = {column = \"s\", is = \"nominal\", unit = \"MPa\"}\n"
             "[[test]]\nkind = \"uniaxial\"\nname = \"tension\"\npath = \"pulled.csv\"\n"
             "[[test]]\nkind = \"uniaxial\"\nname = \"compression\"\npath = \"pressed.csv\"\n");
  const Words material = {"calibration.problem=material", "calibration.tests=tests.toml"};
  const ProgramResult refused = folder.run("calibrate --out foam", material, 4);
  EXPECT_TRUE(refused.out.starts_with("Not accepted: ")) << refused.out;
  EXPECT_TRUE(
      says(refused.err, {"not accepted: the law does not describe the data: ",
                         "tests contradict each other: compression bears 0.", " kPa in tension",
                         "Is it compressible", "no material.toml is written"}));
  EXPECT_FALSE(folder.has("foam/material.toml"));
  folder.run("calibrate --out foam --force", material, 4);
  EXPECT_TRUE(says(folder.text("foam/material.toml"), "rejected = \"the law does not describe"));
  EXPECT_TRUE(says(
      folder
          .run("press --out press",
               {"rubber.card=foam/material.toml", "rubber.poissons_ratio=0.45", "press.mode=static",
                "press.depth=0.02 cm", "lattice.model=network", "lattice.spacing=tip_radius/5"})
          .err,
      "the fit failed its own tests: "));
}

/// Of two cases one needs data that are not here: the other is carried out, and that is told.
TEST_F(MaterialInTime, ACaseWithoutItsDataIsSkippedAmongOthers) {
  const std::string fit =
      "[calibration]\nproblem = \"material\"\nlaws = [\"neo-hookean\"]\nbranches = 1\n"
      "[case]\ntitle = \"Branches\"\n";
  const std::string run =
      "[[case.material]]\nname = \"relaxing\"\nlaw = \"neo-hookean+prony-1\"\n"
      "set = { \"calibration.tests\" = \"../../tests.toml\" }\n";
  const std::string criterion =
      "[[case.criteria]]\nname = \"met\"\nmeasure = \"relaxing.fit_error\"\nlimit = 0.001\n";
  std::filesystem::create_directories(folder_ / "cases/21_here");
  std::filesystem::create_directories(folder_ / "cases/22_elsewhere");
  folder_.put("cases/21_here/case.toml", fit + run + criterion);
  folder_.put(
      "cases/22_elsewhere/case.toml",
      fit + "[case.data]\nfolder = \"FINGERTIP_NO_SUCH_DATA\"\nsource = \"the library\"\n" + run);
  setenv("FINGERTIP_CASES", (folder_ / "cases").c_str(), 1);
  EXPECT_TRUE(says(folder_.run("validate --all --out all").err,
                   "22_elsewhere is skipped: its data are no part of the project: get the library, "
                   "and name their folder in FINGERTIP_NO_SUCH_DATA"));
  folder_.expect_refused("validate 22 --out alone", {}, {"get the library"});
  folder_.run("check cases/22_elsewhere/case.toml");  // right or wrong without its data
  unsetenv("FINGERTIP_CASES");
  EXPECT_TRUE(folder_.has("all/21_here/materials/relaxing/laws/laws.json"));
  EXPECT_FALSE(folder_.has("all/22_elsewhere"));
  const auto relaxing = folder_.json("all/21_here/summary.json")["materials"][0];
  EXPECT_EQ(relaxing["law"], "neo-hookean+prony-1");
  EXPECT_LT(relaxing["fit_error"].get<double>(), 1e-3);
}

TEST_F(MaterialInTime, TellsFileAndLineOfTimesThatStepBack) {
  folder_.put("bad.csv", "t,g,s\n0,0,0\n1,0.1,1\n0.5,0.2,2\n");
  describe("bad.csv");
  EXPECT_TRUE(says(fit(2).err, {"calibration.tests", "bad.csv:4", "0.5 s after 1 s",
                                "times must increase", "rows = [first, last]"}));
}

}  // namespace
