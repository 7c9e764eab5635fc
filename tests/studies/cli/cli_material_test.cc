/// `calibrate` of material tests in time: from files to a card, and a press with it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace {

namespace fs = std::filesystem;

std::string contents(const fs::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

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
    write_text(folder_ / "hold.csv", hold.str());
    write_text(folder_ / "cycles.csv", cycles.str());
    describe("cycles.csv");
  }
  void describe(const std::string& cycles) const {
    write_text(
        folder_ / "tests.toml",
        "[[test]]\nkind = \"relaxation\"\npath = \"hold.csv\"\n"
        "time = {column = 1, unit = \"ms\"}\nstrain = {value = 1.3, is = \"stretch\"}\n"
        "stress = {column = 2, is = \"nominal\", unit = \"kPa\"}\n"
        "[[test]]\nkind = \"cycles\"\ndeformation = \"simple-shear\"\nname = \"to and fro\"\n"
        "path = \"" +
            cycles +
            "\"\ntime = {column = \"t\"}\nstrain = {column = \"g\", is = \"shear\"}\n"
            "stress = {column = \"s\", is = \"nominal\", unit = \"kPa\"}\n");
  }
  ProgramResult fit() const {
    return run_program(folder_.path(), {"calibrate", "--set", "calibration.problem=material",
                                        "--set", "calibration.tests=tests.toml", "--set",
                                        "calibration.laws=[\"neo-hookean\"]", "--out", "laws"});
  }
  TemporaryFolder folder_;
};

TEST_F(MaterialInTime, FromFilesToACardThatPressesAsItsKeysDo) {
  const ProgramResult fitted = fit();
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  EXPECT_NE(fitted.out.find("loops of to and fro: "), std::string::npos) << fitted.out;
  EXPECT_NE(fitted.out.find("rubber.card=PATH --set lattice.model=network"), std::string::npos)
      << "the lattice that takes a law";
  const std::string card = contents(folder_ / "laws/material.toml");
  EXPECT_NE(card.find("name = \"neo-hookean+prony-1\""), std::string::npos) << card;
  EXPECT_NE(card.find("relaxation_tau1_interval"), std::string::npos);
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
  const auto press = [&](const std::string& out, std::vector<std::string> keys) {
    std::vector<std::string> all = {"press",
                                    "--set",
                                    "press.mode=quasi-static",
                                    "--set",
                                    "press.speed=5 cm/s",
                                    "--set",
                                    "press.depth=0.05 cm",
                                    "--set",
                                    "lattice.model=network",
                                    "--set",
                                    "lattice.spacing=tip_radius/5",
                                    "--set",
                                    "rubber.poissons_ratio=0.45",
                                    "--out",
                                    out};
    for (const std::string& key : keys) all.insert(all.end(), {"--set", key});
    return run_program(folder_.path(), all);
  };
  const ProgramResult by_card = press("card", {"rubber.card=laws/material.toml"});
  ASSERT_EQ(by_card.code, 0) << by_card.err;
  const ProgramResult by_hand =
      press("hand", {"rubber.shear_modulus=" + g, "rubber.law=neo-hookean",
                     "rubber.relaxation=[[" + share + ", \"" + tau + "\"]]"});
  ASSERT_EQ(by_hand.code, 0) << by_hand.err;
  const std::string response = contents(folder_ / "card/response.csv");
  EXPECT_GT(response.size(), 200u);
  EXPECT_EQ(response, contents(folder_ / "hand/response.csv"));
  const ProgramResult lasting =
      press("lasting", {"rubber.card=laws/material.toml", "rubber.relaxation=[]"});
  ASSERT_EQ(lasting.code, 0) << lasting.err;
  EXPECT_NE(response, contents(folder_ / "lasting/response.csv"));
  // In equilibrium there is no time.
  const ProgramResult refused =
      run_program(folder_.path(), {"press", "--set", "press.mode=static", "--set",
                                   "lattice.model=network", "--set", "rubber.poissons_ratio=0.45",
                                   "--set", "rubber.card=laws/material.toml", "--out", "static"});
  EXPECT_EQ(refused.code, 2);
  EXPECT_NE(refused.err.find("laws/material.toml"), std::string::npos) << refused.err;
  EXPECT_NE(refused.err.find("rubber.relaxation = []"), std::string::npos) << refused.err;
}

/// A foam, 0.6 MPa in tension and 0.25 MPa in compression, which no law that keeps its volume
/// meets.
TEST(MaterialVerdict, WhatIsNotMetIsNotAcceptedButByForce) {
  const TemporaryFolder folder;
  std::string pulled = "e,s\n", pressed = pulled;
  for (int i = 1; i <= 20; ++i) {
    pulled += std::to_string(0.01 * i) + "," + std::to_string(0.006 * i) + "\n";
    pressed += std::to_string(-0.01 * (21 - i)) + "," + std::to_string(-0.0025 * (21 - i)) + "\n";
  }
  write_text(folder / "pulled.csv", pulled);
  write_text(folder / "pressed.csv", pressed);
  write_text(folder / "tests.toml",
             "[data]\nstrain = {column = \"e\", is = \"engineering\"}\n"
             "stress = {column = \"s\", is = \"nominal\", unit = \"MPa\"}\n"
             "[[test]]\nkind = \"uniaxial\"\nname = \"tension\"\npath = \"pulled.csv\"\n"
             "[[test]]\nkind = \"uniaxial\"\nname = \"compression\"\npath = \"pressed.csv\"\n");
  const auto fit = [&](std::vector<std::string> more) {
    std::vector<std::string> all = {"calibrate", "--set", "calibration.problem=material", "--set",
                                    "calibration.tests=tests.toml"};
    all.insert(all.end(), more.begin(), more.end());
    return run_program(folder.path(), all);
  };
  const ProgramResult refused = fit({"--out", "foam"});
  EXPECT_EQ(refused.code, 4) << refused.err;
  EXPECT_EQ(refused.out.rfind("Not accepted: ", 0), 0u) << refused.out;
  for (const char* part : {"not accepted: the law does not describe the data: ",
                           "compression and tension contradict each other", " kPa in tension",
                           "Is it compressible", "no material.toml is written"})
    EXPECT_NE(refused.err.find(part), std::string::npos) << part << " in " << refused.err;
  EXPECT_FALSE(fs::exists(folder / "foam/material.toml"));
  const ProgramResult forced = fit({"--out", "foam", "--force"});
  EXPECT_EQ(forced.code, 4);
  EXPECT_NE(contents(folder / "foam/material.toml").find("rejected = \"the law does not describe"),
            std::string::npos);
  const ProgramResult checked =
      run_program(folder.path(), {"press", "--set", "rubber.card=foam/material.toml", "--set",
                                  "rubber.poissons_ratio=0.45", "--set", "press.mode=static",
                                  "--set", "press.depth=0.02 cm", "--set", "lattice.model=network",
                                  "--set", "lattice.spacing=tip_radius/5", "--out", "press"});
  EXPECT_EQ(checked.code, 0) << checked.err;
  EXPECT_NE(checked.err.find("the fit failed its own tests: "), std::string::npos) << checked.err;
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
  fs::create_directories(folder_ / "cases/21_here");
  fs::create_directories(folder_ / "cases/22_elsewhere");
  write_text(folder_ / "cases/21_here/case.toml", fit + run + criterion);
  write_text(
      folder_ / "cases/22_elsewhere/case.toml",
      fit + "[case.data]\nfolder = \"FINGERTIP_NO_SUCH_DATA\"\nsource = \"the library\"\n" + run);
  setenv("FINGERTIP_CASES", (folder_ / "cases").c_str(), 1);
  const ProgramResult all = run_program(folder_.path(), {"validate", "--all", "--out", "all"});
  const ProgramResult alone = run_program(folder_.path(), {"validate", "22", "--out", "alone"});
  const ProgramResult checked =
      run_program(folder_.path(), {"check", (folder_ / "cases/22_elsewhere/case.toml").string()});
  unsetenv("FINGERTIP_CASES");
  EXPECT_EQ(all.code, 0) << all.err << all.out;
  const std::string told =
      "22_elsewhere is skipped: its data are no part of the project: get the library, and name "
      "their folder in FINGERTIP_NO_SUCH_DATA";
  EXPECT_NE(all.err.find(told), std::string::npos) << all.err;
  EXPECT_TRUE(fs::exists(folder_ / "all/21_here/materials/relaxing/laws/laws.json"));
  EXPECT_FALSE(fs::exists(folder_ / "all/22_elsewhere"));
  const auto summary = nlohmann::json::parse(contents(folder_ / "all/21_here/summary.json"));
  EXPECT_EQ(summary["materials"][0]["law"], "neo-hookean+prony-1");
  EXPECT_LT(summary["materials"][0]["fit_error"].get<double>(), 1e-3);
  EXPECT_EQ(alone.code, 2);
  EXPECT_NE(alone.err.find("get the library"), std::string::npos) << alone.err;
  EXPECT_EQ(checked.code, 0) << checked.err << "a case is right or wrong without its data";
}

TEST_F(MaterialInTime, TellsFileAndLineOfTimesThatStepBack) {
  write_text(folder_ / "bad.csv", "t,g,s\n0,0,0\n1,0.1,1\n0.5,0.2,2\n");
  describe("bad.csv");
  const ProgramResult refused = fit();
  EXPECT_EQ(refused.code, 2);
  for (const char* part : {"calibration.tests", "bad.csv:4", "0.5 after 1", "times must increase",
                           "rows = [first, last]"})
    EXPECT_NE(refused.err.find(part), std::string::npos) << part << " in " << refused.err;
}

}  // namespace
