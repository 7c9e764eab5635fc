/// Measured data: what is read, what is averaged, and what is refused with which words.
#include "studies/measurements/curve_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "meshes/press/press_response.h"
#include "studies/config/loader.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip::studies;
namespace fs = std::filesystem;

namespace {

const std::vector<CurveQuantities> every = {measured::press, measured::travel, measured::vibration,
                                            measured::creep, measured::relaxation};

class MeasuredData : public testing::Test {
 protected:
  MeasuredFile read(const std::string& text, const std::vector<CurveQuantities>& allowed = every) {
    fs::remove(folder_ / "data.csv");  // overwriting waits for the disk
    std::ofstream(folder_ / "data.csv", std::ios::binary) << text;
    return read_measured({folder_ / "data.csv"}, allowed).at(0);
  }
  /// What is said of the file; without its name. Empty: accepted.
  std::vector<std::string> said(const std::string& text) {
    std::vector<std::string> lines;
    try {
      read(text);
    } catch (const ConfigError& error) {
      const std::string file = (folder_ / "data.csv").string();
      for (const fingertip::meshes::Violation& problem : error.violations()) {
        EXPECT_EQ(problem.place.find(file), 0U) << problem.place;
        EXPECT_FALSE(problem.rule.empty() || problem.remedy.empty());
        lines.push_back(to_string(problem).substr(file.size()));
      }
    }
    return lines;
  }
  /// One problem, of which all these parts are said.
  void expect_refused(const std::string& text, const std::vector<std::string>& parts) {
    const std::vector<std::string> lines = said(text);
    ASSERT_EQ(lines.size(), 1U) << testing::PrintToString(lines) << " to\n" << text;
    EXPECT_TRUE(says(lines[0], parts));
  }

  TemporaryFolder folder_;
};

const std::string header = "indentation [mm],force [mN],sigma [mN]\n";

}  // namespace

TEST_F(MeasuredData, ComesInSiWithItsSettings) {
  const MeasuredFile file = read(
      "# silicone, 3 Nov: E = ?\n"
      "# press.contact = \"stick\"\n"
      "## press.tilt=20 deg\n\n" +
      header +
      "0.1, 1.2, 0.05\n"
      "# a pause\n"
      "+0.3,\t5.5e0 , 0.06\n\n"
      "0.7,21,0.1");
  EXPECT_EQ(file.curve.name, "data");
  EXPECT_EQ(file.x_quantity, "indentation");
  EXPECT_EQ(file.y_quantity, "force");
  EXPECT_EQ(file.curve.x, (std::vector<double>{1e-4, 3e-4, 7e-4}));
  EXPECT_EQ(file.curve.y, (std::vector<double>{1.2e-3, 5.5e-3, 21e-3}));
  ASSERT_EQ(file.curve.sigma.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_DOUBLE_EQ(file.curve.sigma[i], (std::array{5e-5, 6e-5, 1e-4})[i]);
  EXPECT_TRUE(file.notes.empty());
  ASSERT_EQ(file.settings.size(), 2U);
  EXPECT_EQ(file.settings[0].assignment(), "press.contact=\"stick\"");
  EXPECT_EQ(file.settings[0].line, 2U);
  EXPECT_EQ(file.settings[1].assignment(), "press.tilt=20 deg");
  EXPECT_EQ(file.settings[1].line, 3U);
  // They are what --set takes.
  const LoadedConfig loaded =
      load_config({{}, {file.settings[0].assignment(), file.settings[1].assignment()}, {}});
  EXPECT_EQ(loaded.config.press.protocol.contact, fingertip::meshes::ContactMode::stick);
  EXPECT_NEAR(loaded.config.press.protocol.tilt, 0.349065850398866, 1e-12);
}

TEST_F(MeasuredData, MayBeWrittenInManyWays) {
  const std::vector<double> x = {1e-4, 3e-4}, y = {9.80665e-3, 19.6133e-3};
  for (const std::string text : {
           "indentation [mm],force [gf]\n0.1,1\n0.3,2\n",
           "\xEF\xBB\xBFindentation [mm],force [gf]\r\n0.1,1\r\n0.3,2\r\n",
           "Force [gf];Indentation [mm]\n1;0.1\n2;0.3\n",
           "Normal force [gf]\tnote\tINDENTATION [um]\n1\t\t100\n2\tdeep\t300\n",
           "\"indentation [cm]\",\"force [kgf]\"\r\"1e-2\",\"0.001\"\r\"3e-2\",\"0.002\"\r",
           "indentation [\xC2\xB5m],force [mN],time [s]\n100,9.80665,\n300,19.6133,",
           "indentation [\xB5m],force [\xB5N]\n100,9806.65\n300,19613.3",
           "indentation (mm);force in mN\n0,1;9,80665\n0,3;19,6133\n",
       }) {
    const MeasuredFile file = read(text);
    ASSERT_EQ(file.curve.x.size(), 2U) << text;
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_DOUBLE_EQ(file.curve.x[i], x[i]) << text;
      EXPECT_DOUBLE_EQ(file.curve.y[i], y[i]) << text;
    }
    EXPECT_TRUE(file.curve.sigma.empty());
  }
}

TEST_F(MeasuredData, HoldsTheFirstPairThatIsAllowed) {
  const auto pair = [&](const std::string& text) {
    const MeasuredFile file = read(text);
    return file.x_quantity + " " + file.y_quantity + " " + std::to_string(file.curve.y[0]);
  };
  EXPECT_EQ(pair("frequency [kHz],loss_factor [1]\n0.1,0.2\n"), "frequency loss_factor 0.200000");
  EXPECT_EQ(pair("creep [1],time [ms]\n0.5,1\n"), "time creep 0.500000");
  EXPECT_EQ(pair("time [h],force [N]\n1,2\n"), "time force 2.000000");
  EXPECT_EQ(pair("time [s],force [N],indentation [m]\n1,2,3\n"), "indentation force 2.000000");
  EXPECT_EQ(read("frequency [kHz],loss_factor [1]\n0.1,0.2\n").curve.x[0], 100.0);
}

TEST_F(MeasuredData, LeavesOutWhatLiesBeforeTheStart) {
  const MeasuredFile file = read(header + "-0.2,-0.1,1\n-0.1,0.1,1\n0,0,1\n0.1,-0.05,1\n0.2,2,1\n");
  EXPECT_EQ(file.curve.x, (std::vector<double>{1e-4, 2e-4}));
  ASSERT_EQ(file.notes.size(), 2U);
  EXPECT_TRUE(says(file.notes[0], "3 rows with indentation <= 0"));
  EXPECT_TRUE(says(file.notes[1], "1 of 2 forces are negative"));
}

/// What `reference` and `press` write: to the bit, with the continuum's own error as sigma.
TEST_F(MeasuredData, MayBeAProgramsResponse) {
  fingertip::meshes::PressResponse response;
  for (const double depth : {1e-4 / 3.0, 2e-4 / 3.0, 1e-3 / 7.0}) {
    fingertip::meshes::PressSample sample;
    sample.indentation = depth;
    sample.normal_force = 3.0 * std::pow(depth, 1.5);
    sample.force_error = 0.01 * sample.normal_force;
    response.append(sample);
  }
  response.write_csv(folder_ / "response.csv");
  const MeasuredFile file = read_measured({folder_ / "response.csv"}, every).at(0);
  EXPECT_EQ(file.curve.name, "response");
  ASSERT_EQ(file.curve.sigma.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(file.curve.x[i], response.samples()[i].indentation);
    EXPECT_EQ(file.curve.y[i], response.samples()[i].normal_force);
    EXPECT_EQ(file.curve.sigma[i], response.samples()[i].force_error);
  }
  ASSERT_EQ(file.notes.size(), 1U);
  EXPECT_TRUE(says(file.notes[0], "torque_x [N m]"));

  // Of a lattice it is the distance from the continuum.
  write_text(folder_ / "boundary.csv", "x [m]\n");
  EXPECT_TRUE(read_measured({folder_ / "response.csv"}, every).at(0).curve.sigma.empty());
  fs::remove(folder_ / "boundary.csv");

  const MeasuredFile part =
      read("indentation [m],normal_force [N],force_error [N]\n1e-4,1,0.1\n2e-4,2,\n3e-4,3,0\n");
  EXPECT_TRUE(part.curve.sigma.empty());
  ASSERT_EQ(part.notes.size(), 1U);
  EXPECT_TRUE(says(part.notes[0], "in 2 of 3 rows"));
}

TEST_F(MeasuredData, IsRefusedForItsHeader) {
  expect_refused("", {"no table", "indentation [mm], force [mN]"});
  expect_refused("\n\n# nothing\n", {"no table"});
  expect_refused("0.1,1.2\n0.2,2.2\n", {":1: ", "header is missing", "'0.1, 1.2'"});
  expect_refused("depth [mm],load [mN]\n1,2\n", {":1: ", "no pair", "'indentation [m]'"});
  expect_refused("\nindentation,force [mN]\n1,2\n", {":2: indentation", "unit is missing"});
  expect_refused("indentation [],force [mN]\n1,2\n", {"indentation []", "unit is missing"});
  expect_refused("indentation [mm],force [mm]\n1,2\n", {"[mm], a length, and force is a force"});
  expect_refused("indentation [mm],force [g]\n1,2\n", {"[g], a mass", "'force [gf]'"});
  expect_refused("indentation [mm],force [xyz]\n1,2\n", {"force [xyz]", "is not a unit"});
  expect_refused("indentation [mm],force [2 N]\n1,2\n", {"force [2 N]", "is not a unit"});
  expect_refused("frequency [s],loss_factor [1]\n1,2\n", {"frequency [s]", "a time"});
  expect_refused("frequency [Hz],loss_factor\n1,2\n", {"loss_factor", "marked [1] or [%]"});
  EXPECT_EQ(read("frequency [Hz],loss_factor [%]\n1,2\n").curve.y[0], 0.02);
  expect_refused("indentation [mm],force [N],sigma [mm]\n1,2,3\n", {"sigma [mm]", "a length"});
  expect_refused("indentation [mm],force [N],normal_force [N]\n1,2,3\n", {"stands for the same"});
  expect_refused("indentation [mm],force [N],sigma [N],sigma [mN]\n1,2,3,4\n", {"the same"});
  expect_refused("# press.tilt = 1 deg\n# press.tilt = 2 deg\n" + header + "1,2,3\n",
                 {":2: press.tilt = 2 deg", "already in line 1"});
  expect_refused("# press.tilt =\n" + header + "1,2,3\n", {":1: press.tilt", "missing"});
  EXPECT_EQ(said("indentation,force\n1,2\n").size(), 2U) << "both columns are told";
}

TEST_F(MeasuredData, IsRefusedForItsCells) {
  expect_refused(header, {"no rows below the header"});
  expect_refused(header + "-1,1,1\n-2,2,1\n", {"positive in no row", "change its sign"});
  expect_refused(header + "0.1,1,1\nx,2,1\n", {":3: indentation [mm] = x", "finite number"});
  expect_refused(header + "0.1,1 mN,1\n", {":2: force [mN] = 1 mN"});
  expect_refused(header + "0.1,,1\n", {":2: force [mN]: ", "cell is empty"});
  for (const std::string bad : {"nan", "NaN", "inf", "-inf", "1e999", "1e80", "1e-80", "0x10",
                                "1d5", "--1", "+-1", "1e", "."})
    expect_refused(header + "0.1," + bad + ",1\n", {":2: force [mN] = " + bad});
  expect_refused(header + "0.1,1,0\n", {":2: sigma [mN] = 0", "standard deviation is positive"});
  expect_refused(header + "0.1,1,-2\n", {":2: sigma [mN] = -2"});
  expect_refused(header + "0.1,1,1\n0.2,2,\n", {":3: sigma [mN]: ", "empty"});
  expect_refused(header + "0.1,1,1\n0.2,2\n", {":3: ", "2 cells, the header 3 titles"});
  expect_refused("indentation [mm];force [mN]\n0.1;2\n0.2;3\n0,3;4\n",
                 {":4: indentation [mm] = 0,3", "with a point"});
  expect_refused("indentation [mm],force [mN]\n0,1,2,3\n", {"4 cells", "with a point"});
  expect_refused("frequency [Hz],loss_factor [1]\n0,1\n", {"frequency is positive"});
  expect_refused(header + "0.1,-1,1\n0.2,-2,1\n", {"force [mN]", "positive in compression"});
  expect_refused(header + std::string("0.1,1,\0", 8) + "\n", {"UTF-8"});
  expect_refused("\xFF\xFEi", {"UTF-8"});
}

TEST_F(MeasuredData, TellsTenProblemsAtOnce) {
  std::string rows;
  for (int i = 0; i < 25; ++i) rows += "x,1,1\n";
  const auto lines = said(header + rows);
  ASSERT_EQ(lines.size(), 11U);
  EXPECT_EQ(lines[9].find(":11: "), 0U) << lines[9];
  EXPECT_TRUE(says(lines[10], "15 further"));
}

TEST_F(MeasuredData, IsRefusedForItsOrder) {
  expect_refused(header + "0.1,1,1\n0.3,3,1\n0.2,2,1\n0.1,1,1\n",
                 {":4: indentation = 0.2 mm", "0.3 mm in line 3", "loading and unloading"});
  expect_refused("frequency [Hz],loss_factor [1]\n3,1\n2,1\n", {"sort the rows by frequency"});
  expect_refused(header + "0.1,1,1\n# x\n0.1,1,1\n",
                 {":4: indentation = 0.1 mm", "repeats 0.1 mm in line 2", "delete"});
  expect_refused(header + "0.1,1,1\n0.1,1.5,1\n", {":3: ", "second value", "average"});
  EXPECT_EQ(said(header + "0.1,1,1\n0.1,1,1\n0.2,1,1\n0.2,2,1\n").size(), 2U);
}

TEST_F(MeasuredData, IsRefusedAsAFolderOrMissing) {
  for (const fs::path& path : {folder_.path(), folder_ / "absent.csv", fs::path("/dev/null")}) {
    EXPECT_TRUE(refuses<ConfigError>([&] { read_measured({path}, every); }, path.string()));
  }
}

namespace {

/// A noisy sensor: depth to 3 mm, F = 40 mN/mm^1.5 d^1.5.
struct Dense {
  double step_noise = 0.0;   ///< of the depth [mm]
  double force_noise = 0.0;  ///< [mN]
  int rows = 20000;
  bool with_sigma = true;
  int unloading = 0;  ///< rows back at the end
};

std::string dense(const Dense& how) {
  std::mt19937 generator(7);
  std::normal_distribution<double> normal;
  std::string text = how.with_sigma ? header : "indentation [mm],force [mN]\n";
  for (int i = 0; i < how.rows + how.unloading; ++i) {
    const double depth = 3.0 * (i < how.rows ? i + 1 : 2 * how.rows - i) / how.rows;
    const double force = 40.0 * std::pow(depth, 1.5) + how.force_noise * normal(generator);
    text += std::to_string(depth + how.step_noise * normal(generator)) + "," +
            std::to_string(force) + (how.with_sigma ? "," + std::to_string(how.force_noise) : "") +
            "\n";
  }
  return text;
}

}  // namespace

/// The means deviate from the law by their sigma, as chi-square of 200 bins tells: 200 +- 20.
TEST_F(MeasuredData, IsAveragedWhenDense) {
  const MeasuredFile file = read(dense({.step_noise = 5e-4, .force_noise = 3.0}));
  ASSERT_EQ(file.curve.x.size(), 200U);
  ASSERT_EQ(file.curve.sigma.size(), 200U);
  EXPECT_TRUE(std::ranges::is_sorted(file.curve.x));
  double chi_square = 0.0;
  for (std::size_t i = 0; i < 200; ++i) {
    EXPECT_NEAR(file.curve.sigma[i], 3e-3 / std::sqrt(100.0), 2e-5) << i;
    const double law = 0.04 * std::pow(file.curve.x[i] / 1e-3, 1.5);
    chi_square += std::pow((file.curve.y[i] - law) / file.curve.sigma[i], 2);
  }
  EXPECT_NEAR(chi_square, 200.0, 60.0);
  ASSERT_FALSE(file.notes.empty());
  EXPECT_TRUE(says(file.notes.back(), "averaged in 200 bins"));
  EXPECT_TRUE(read(dense({.force_noise = 3.0, .with_sigma = false})).curve.sigma.empty());
  EXPECT_EQ(read(dense({.force_noise = 3.0, .rows = 200})).curve.x.size(), 200U);
}

/// Without noise: the mean of a bent curve lies off it by F'' w²/24, w the bin's width.
TEST_F(MeasuredData, MeansLieOnTheCurveUpToItsBend) {
  const MeasuredFile file = read(dense({.with_sigma = false}));
  const double width = 3e-3 / 200.0;
  for (std::size_t i = 1; i < 200; ++i) {
    const double x = file.curve.x[i], law = 0.04 * std::pow(x / 1e-3, 1.5);
    const double bend = law * 0.75 * std::pow(width / x, 2) / 24.0;
    EXPECT_NEAR(file.curve.y[i] - law, bend, 0.2 * bend + 1e-6 * law) << i;
  }
}

/// Two sensors in turn, one ten times as good: weights 1/sigma².
TEST_F(MeasuredData, MeansWeighBySigma) {
  std::string text = header;
  for (int i = 0; i < 1000; ++i) {
    const double depth = 1e-3 * (i + 1);
    text += std::to_string(depth) + (i % 2 == 0 ? ",10,0.1\n" : ",20,1\n");
  }
  const MeasuredFile file = read(text);
  ASSERT_EQ(file.curve.x.size(), 200U);
  for (std::size_t i = 0; i < 200; ++i) {
    // Of five rows two or three are good ones.
    const double good = (file.curve.sigma[i] < 6.5e-5 ? 3.0 : 2.0) * 100.0;
    const double poor = 5.0 - good / 100.0;
    EXPECT_NEAR(file.curve.y[i], (good * 0.01 + poor * 0.02) / (good + poor), 1e-12) << i;
    EXPECT_NEAR(file.curve.sigma[i], 1e-3 / std::sqrt(good + poor), 1e-12) << i;
  }
}

TEST_F(MeasuredData, DenseUnloadingIsRefusedAndNoiseIsNot) {
  const double width = 3.0 / 200.0;
  EXPECT_TRUE(said(dense({.step_noise = 0.15 * width, .force_noise = 1.0})).empty());
  EXPECT_TRUE(said(dense({.step_noise = 0.4 * width, .force_noise = 1.0})).empty());
  EXPECT_TRUE(said(dense({.force_noise = 1.0, .unloading = 90})).empty()) << "less than a bin";
  // In blocks of 20 rows; the turn is in line 20001, a bin is passed a hundred rows later.
  expect_refused(dense({.force_noise = 1.0, .unloading = 200}),
                 {":20102: indentation", "2.99858 mm at line 19982", "loading and unloading"});
  std::string glitch = dense({.force_noise = 1.0});
  glitch += "2.9,200,1\n";
  EXPECT_TRUE(says(testing::PrintToString(read(glitch).notes), "is left out: line 20002 (2.9 mm)"));
  std::string still = header;
  for (int i = 0; i < 300; ++i) still += "0.5,1,1\n";
  expect_refused(still, {"the same in every row"});
}

/// Files damaged at random are refused in words or give a sound curve; nothing else may happen.
TEST_F(MeasuredData, DamagedFilesAreRefusedOrSound) {
  std::mt19937 generator(11);
  const auto below = [&](std::size_t bound) { return std::size_t(generator() % bound); };
  const std::vector<std::string> seeds = {
      "# press.contact = \"stick\"\n" + header + "0.1,1.2,0.05\n0.2,3.1,0.05\n0.5,9.9,0.07\n",
      "indentation [m];normal_force [N];force_error [N];time [s]\n1e-4;1;;\n2e-4;2;0.1;3\n",
      dense({.step_noise = 1e-3, .force_noise = 1.0, .rows = 230})};
  const std::vector<std::string> splices = {"nan", "inf", ",", ";", "\t", "\n", "\r",    "\"",  "#",
                                            "-",   "e9",  "[", "]", "=",  ".",  "1e308", "\xFF"};
  int accepted = 0, refused = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::string text = seeds[below(seeds.size())];
    for (std::size_t damage = 0; damage <= below(3); ++damage) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
        case 0: text[at] = char(below(256)); break;
        case 1: text.erase(at, 1 + below(20)); break;
        case 2: text.insert(at, splices[below(splices.size())]); break;
        default: text.insert(below(text.size()), text.substr(at, below(60)));
      }
      if (text.empty()) text = "x";
    }
    try {
      const auto curve = read(text).curve;
      ++accepted;
      ASSERT_FALSE(curve.x.empty()) << text;
      ASSERT_EQ(curve.x.size(), curve.y.size());
      ASSERT_TRUE(curve.sigma.empty() || curve.sigma.size() == curve.x.size()) << text;
      for (std::size_t i = 0; i < curve.x.size(); ++i) {
        ASSERT_TRUE(std::isfinite(curve.x[i]) && std::isfinite(curve.y[i])) << text;
        ASSERT_GT(curve.x[i], i == 0 ? 0.0 : curve.x[i - 1]) << text;
        const double sigma = curve.sigma.empty() ? 1.0 : curve.sigma[i];
        ASSERT_TRUE(sigma > 0.0 && sigma < 1e60) << text;
      }
    } catch (const ConfigError& error) {
      ++refused;
      ASSERT_FALSE(error.violations().empty());
    }
  }
  EXPECT_GT(accepted, 100);
  EXPECT_GT(refused, 100);
}

TEST_F(MeasuredData, TravelsMayBeginAnywhereAndTakeTheirTimesAlong) {
  const MeasuredFile file =
      read("time [s];position [mm];force [N]\n0;-0.5;0.001\n1;0.0;-0.001\n2;0.5;0.3\n");
  EXPECT_TRUE(file.curve.is_travel);
  EXPECT_EQ(file.x_quantity, "position");
  EXPECT_EQ(file.curve.x, (std::vector<double>{-0.5e-3, 0.0, 0.5e-3}));
  EXPECT_EQ(file.curve.time, (std::vector<double>{0.0, 1.0, 2.0}));
}

/// F = x up, F = 0.6 x down, from 0 to 1 mm: the loop takes 40 % of the work.
TEST_F(MeasuredData, OfALoopTheLoadingIsTakenAndTheAreaTold) {
  std::string text = "position [mm],force [N]\n";
  for (int i = 0; i <= 50; ++i)
    text += std::to_string(0.02 * i) + "," + std::to_string(0.02 * i) + "\n";
  for (int i = 49; i >= 0; --i)
    text += std::to_string(0.02 * i) + "," + std::to_string(0.012 * i) + "\n";
  const MeasuredFile file = read(text);
  EXPECT_EQ(file.curve.x.size(), 51U);
  EXPECT_NEAR(file.curve.y.back(), 1.0, 1e-9);
  ASSERT_EQ(file.notes.size(), 1U);
  // The way from the last point up to the first one down is half of each.
  EXPECT_TRUE(says(file.notes[0], "the loop takes 39 %"));
}

/// The area is the play times the force that is gained from the first row to the last: of rows that
/// begin under 1.5 N it is not the largest force that counts.
TEST_F(MeasuredData, PlayIsOfTheForceThatIsGained) {
  std::string text = "position [mm],force [N]\n";
  const auto row = [&](double x, double told) {
    text += std::to_string(told) + "," + std::to_string(1.5 + 0.5 * x) + "\n";
  };
  for (int i = 0; i <= 300; ++i) row(0.01 * i, 0.01 * i);
  for (int i = 0; i < 10; ++i) row(3.0, 3.0 - 0.01 * (i + 1));
  for (int i = 299; i >= 0; --i) row(0.01 * i, 0.01 * i - 0.1);
  EXPECT_NEAR(read(text).curve.course.play, 1e-4, 4e-6);
}

/// An axis that loses 0.1 mm where it turns: the way back lies above the loading of F = x/2 to 3
/// mm, by 0.1 mm · 1.5 N of 2.25 N mm. No rubber gives work.
TEST_F(MeasuredData, AWayBackAboveTheLoadingIsPlay) {
  std::string text = "position [mm],force [N]\n";
  const auto row = [&](double x, double told) {
    text += std::to_string(told) + "," + std::to_string(0.5 * x) + "\n";
  };
  for (int i = 0; i <= 300; ++i) row(0.01 * i, 0.01 * i);
  for (int i = 0; i < 10; ++i) row(3.0, 3.0 - 0.01 * (i + 1));
  for (int i = 299; i >= 0; --i) row(0.01 * i, 0.01 * i - 0.1);
  const MeasuredFile file = read(text);
  EXPECT_NEAR(file.curve.course.loop, -0.15 / 2.25, 1e-3);
  EXPECT_NEAR(file.curve.course.play, 1e-4, 2e-6);
  const std::string notes = testing::PrintToString(file.notes);
  EXPECT_TRUE(says(notes, {"above the loading, by 6.7 % of its work: not the rubber",
                           "mm of play or lag of the machine's travel"}));
  EXPECT_TRUE(omits(notes, "the loop takes"));
}

TEST_F(MeasuredData, AnEncoderThatStandsStillIsAveraged) {
  std::string text = "position [mm],force [N]\n";
  for (int i = 0; i < 100; ++i)
    text += std::to_string(0.01 * (i / 2)) + "," + std::to_string(0.01 * i) + "\n";
  const MeasuredFile file = read(text);
  EXPECT_LE(file.curve.x.size(), 50U);
  EXPECT_TRUE(std::ranges::is_sorted(file.curve.x, std::less_equal<>()));
  EXPECT_TRUE(says(file.notes.back(), "averaged"));
}

/// Up to 1 mm in 100 s with a hold of 100 s half way and one at the end: in each the force falls by
/// a tenth.
std::string press_with_holds() {
  std::string text = "time [s],position [mm],force [N]\n";
  int second = 0;
  const auto row = [&](double x, double force) {
    text += std::to_string(second++) + "," + std::to_string(x) + "," + std::to_string(force) + "\n";
  };
  const auto hold = [&](double x) {
    for (int i = 1; i <= 100; ++i) row(x, x * (1.0 - 0.1 * (1.0 - std::exp(-0.1 * i))));
  };
  for (int i = 0; i <= 200; ++i) row(0.0025 * i, 0.0025 * i);
  hold(0.5);
  for (int i = 201; i <= 400; ++i) row(0.0025 * i, 0.0025 * i);
  hold(1.0);
  for (int i = 400; i >= 0; --i) row(0.0025 * i, 0.00225 * i);
  return text;
}

TEST_F(MeasuredData, HoldsAreToldAndCut) {
  const MeasuredFile file = read(press_with_holds());
  const auto& course = file.curve.course;
  EXPECT_EQ(course.rows, 1002U);
  EXPECT_NEAR(course.relaxation, 0.1, 2e-3);
  EXPECT_NEAR(course.hold_time, 99.0, 5.0);
  // The work is 0.5 N mm, 0.45 N mm come back.
  EXPECT_NEAR(course.loop, 0.1, 0.01);
  EXPECT_GE(course.back_x.size(), 100U);
  for (std::size_t i = 0; i < file.curve.x.size(); ++i)
    EXPECT_NEAR(file.curve.y[i], 1e3 * file.curve.x[i], 2e-3) << i << ": nothing relaxed is fitted";
  const std::string notes = testing::PrintToString(file.notes);
  EXPECT_TRUE(says(notes, {"a hold, ", "the force falls by"}));
}

/// A ramp of 2 s at 10 Hz and a hold of 10 s, in which 60 % fade in 0.5 s: most of it within the
/// hold's first tenth.
TEST_F(MeasuredData, TheFallInAHoldIsFromTheEndOfTheLoading) {
  const auto told = [&](int per_second) {
    std::string text = "time [s],position [mm],force [N]\n";
    for (int i = 0; i <= 12 * per_second; ++i) {
      const double t = double(i) / per_second, held = t - 2.0;
      const double force = held < 0.0 ? 0.5 * t : 0.4 + 0.6 * std::exp(-held / 0.5);
      text += std::to_string(t) + "," + std::to_string(std::min(t, 2.0)) + "," +
              std::to_string(force) + "\n";
    }
    return read(text).curve.course;
  };
  for (const int per_second : {10, 1000}) {
    const auto course = told(per_second);
    EXPECT_NEAR(course.relaxation, 0.6, 3e-3) << per_second;
    EXPECT_NEAR(course.hold_time, 10.0, 0.02);
    ASSERT_GE(course.held_time.size(), 30U);
    EXPECT_LE(course.held_time.size(), 120U);
    EXPECT_NEAR(course.held_time.front(), 0.0, 1e-6);
    for (std::size_t i = 0; i < course.held_time.size(); ++i)
      EXPECT_NEAR(course.held_y[i], 0.4 + 0.6 * std::exp(-course.held_time[i] / 0.5), 0.02);
  }
}

/// The same for a rubber that relaxes: the holds stay, thinned as their forces slow down.
TEST_F(MeasuredData, HoldsAreKeptInTime) {
  std::ofstream(folder_ / "timed.csv", std::ios::binary) << press_with_holds();
  const MeasuredFile file = read_measured({folder_ / "timed.csv"}, every, true).at(0);
  const auto& curve = file.curve;
  EXPECT_TRUE(curve.in_time);
  EXPECT_TRUE(std::ranges::is_sorted(curve.time, std::less_equal<>()));
  EXPECT_EQ(file.lines.size(), curve.x.size());
  EXPECT_LE(curve.x.size(), 282U);
  EXPECT_NEAR(curve.time.back(), 601.0, 12.0) << "the way back is left out";
  // 100 values and more of the way, 30 and more of each hold.
  std::size_t held = 0;
  for (std::size_t i = 0; i < curve.x.size(); ++i) {
    EXPECT_GT(curve.y[i], 0.89e3 * curve.x[i] - 1e-9);
    if (std::abs(curve.x[i] - 0.5e-3) > 2e-5 && curve.x[i] < 0.99e-3)
      EXPECT_NEAR(curve.y[i], 1e3 * curve.x[i], 2e-3) << i;
    else if (curve.y[i] < 995.0 * curve.x[i])
      ++held;
  }
  EXPECT_GT(held, 50U);
  const std::string notes = testing::PrintToString(file.notes);
  EXPECT_TRUE(says(notes, "is fitted; in it the force falls by"));
  std::ofstream(folder_ / "back.csv") << "time [s],position [mm],force [N]\n"
                                         "1,0.1,0.1\n3,0.2,0.2\n2,0.3,0.3\n4,0.4,0.4\n";
  EXPECT_THROW(read_measured({folder_ / "back.csv"}, every, true), ConfigError);
}

/// A logger's clock counts seconds since 1970: a drift over it would be told from the force's zero
/// by nothing.
TEST_F(MeasuredData, TimesCountFromTheFirstRow) {
  const auto at = [&](double begin) {
    std::string text = "time [s],position [mm],force [N]\n";
    for (int i = 0; i <= 150; ++i)
      text += std::to_string(begin + 0.1 * i) + "," + std::to_string(0.02 * i) + "," +
              std::to_string(0.01 * i) + "\n";
    return read(text).curve.time;
  };
  const std::vector<double> own = at(0.0), clock = at(1761841220.0);
  ASSERT_EQ(own.size(), clock.size());
  for (std::size_t i = 0; i < own.size(); ++i) EXPECT_NEAR(clock[i], own[i], 2e-6) << i;
  EXPECT_EQ(clock.front(), 0.0);
}

/// Rows that become ever sparser stand nowhere still.
TEST_F(MeasuredData, DenseRowsAreNoHold) {
  std::string text = "position [mm],force [N]\n";
  for (int i = 0; i < 190; ++i) {
    const double x = std::pow(10.0, -3.0 + 4.0 * i / 190.0);
    text += std::to_string(x) + "," + std::to_string(x) + "\n";
  }
  EXPECT_EQ(read(text).curve.x.size(), 190U);
}

/// F = 100 mN/mm^1.5 d^1.5 from the position 1 mm on, row by row.
std::string touching(int rows, const std::function<std::string(int, double, double)>& row,
                     const std::string& titles = "position [mm],force [mN]\n") {
  std::string text = titles;
  for (int i = 0; i < rows; ++i) {
    const double x = 3.0 * i / (rows - 1);
    text += row(i, x, 100.0 * std::pow(std::max(0.0, x - 1.0), 1.5));
  }
  return text;
}
std::string plain_row(int, double x, double force) {
  return std::to_string(x) + "," + std::to_string(force) + "\n";
}

class DescribedPress : public MeasuredData {
 protected:
  MeasuredFile described(const std::string& columns, const std::string& text) {
    std::ofstream(folder_ / "data.csv", std::ios::binary) << text;
    std::ofstream(folder_ / "press.toml") << "[[press]]\npath = \"data.csv\"\n" << columns;
    return read_measured(curve_sources(folder_ / "press.toml").at(0),
                         {measured::press, measured::travel})
        .at(0);
  }
  void expect_refused(const std::string& columns, const std::string& text,
                      const std::vector<std::string>& parts) {
    try {
      described(columns, text);
      ADD_FAILURE() << columns << " accepted";
    } catch (const ConfigError& error) {
      EXPECT_TRUE(says(to_string(error.violations().at(0)), parts));
    }
  }
};

TEST_F(DescribedPress, TheFilesUnitCountsAndNoOtherBesideIt) {
  const std::string text = touching(30, plain_row, "Way [mm],Load [mN]\n");
  const std::string way = "position = {column = \"Way\"}\n", load = "force = {column = \"Load\"}\n";
  const auto is_right = [&](const std::string& columns) {
    const MeasuredFile file = described(columns, text);
    EXPECT_NEAR(file.curve.x.back(), 3e-3, 1e-12) << columns;
    EXPECT_NEAR(file.curve.y.back(), 0.1 * std::pow(2.0, 1.5), 1e-6) << columns;
  };
  is_right(way + load);
  is_right("position = {column = 1}\nforce = {column = 2}\n");
  is_right("position = {column = 1, unit = \"millimeter\"}\nforce = {column = 2, unit = \"mN\"}\n");
  expect_refused(way + "force = {column = \"Load\", unit = \"kN\"}\n", text,
                 {"Load [mN]", "the file says [mN] and its description unit = \"kN\"", "\"1 kN\""});
  expect_refused(way + "force = {column = 2, unit = \"N\"}\n", text, {"[mN]", "\"N\""});
  expect_refused("position = {column = \"Way\", unit = \"um\"}\n" + load, text, {"[mm]", "\"um\""});
  expect_refused("position = {column = \"Load\"}\nforce = {column = \"Way\"}\n", text,
                 {"[mN], a force, and position is a length"});
  expect_refused(way + "force = {column = \"Load\", unit = \"kPa\"}\n", text,
                 {"force.unit = kPa", "is a stress, and force is a force"});
  expect_refused(way + load + "sigma = {column = \"Way\"}\n", text, {"[mm], a length"});
  EXPECT_NEAR(described(way + "force = {column = \"Load\", unit = \"1 N\"}\n", text).curve.y.back(),
              100.0 * std::pow(2.0, 1.5), 1e-3)
      << "a number in front overrules the file";
}

TEST_F(DescribedPress, CountsHaveAScaleAndAZero) {
  const auto counts = [](int, double x, double force) {
    return std::to_string(100.0 * x - 1540.0) + "," + std::to_string(force / 12.5 - 560.0) + "\n";
  };
  const std::string text = touching(30, counts, "p [steps],f [counts]\n");
  for (const std::string zero : {"\"first row\"", "-560", "\"-7 N\""}) {
    const MeasuredFile file = described(
        "position = {column = 1, unit = \"10 um\", zero = -1540}\n"
        "force = {column = 2, scale = 0.0125, unit = \"N\", zero = " +
            zero + "}\n",
        text);
    EXPECT_NEAR(file.curve.x.back(), 3e-3, 1e-12);
    EXPECT_NEAR(file.curve.y.back(), 0.1 * std::pow(2.0, 1.5), 1e-6);
    EXPECT_FALSE(file.curve.zero_is_sought);
  }
  expect_refused("position = {column = 1}\nforce = {column = 2, unit = \"N\"}\n", text,
                 {"[steps]", "scale = 0.0125"});
  // Forces that begin below zero and rise: their zero is asked for, no sign.
  expect_refused(
      "position = {column = 1, unit = \"10 um\"}\n"
      "force = {column = 2, scale = 0.0125, unit = \"N\"}\nrows = [20, 26]\n",
      text, {"from below zero", "zero = \"first row\""});
}

TEST_F(DescribedPress, AnIndentationMayLackItsZero) {
  const MeasuredFile file = described(
      "indentation = {column = 1, zero = \"fit\"}\nforce = {column = 2, zero = \"fit\"}\n",
      touching(30, plain_row));
  EXPECT_TRUE(file.curve.is_travel);
  EXPECT_TRUE(file.curve.zero_is_sought);
}

TEST_F(MeasuredData, ASignIsToldWithTheLineThatTurnsIt) {
  const auto pulled = [](int i, double x, double force) { return plain_row(i, x, -force); };
  expect_refused(touching(30, pulled), {"force [mN]", "positive in compression",
                                        "force = {column = 'force [mN]', sign = -1}"});
  const auto away = [](int i, double x, double force) { return plain_row(i, -x, force); };
  expect_refused(touching(30, away), {"position [mm]", "falls while the force grows",
                                      "position = {column = 'position [mm]', sign = -1}"});
}

TEST_F(MeasuredData, TitlesOfMachinesOfManyTongues) {
  for (const std::string titles :
       {"Displacement (Strain 1) [mm],Load (Maximum) [mN]",
        "Position(Linear:Digital Position) (mm),"
        "Load(Linear:Load) (mN)",
        "XDisplacement_mm,XForce_mN", "Distance in mm,Force in mN", "変位(mm),試験力(mN)",
        "Deslocamento (mm),Força (mN)", "Przemieszczenie [mm],Siła [mN]",
        "Yer değiştirme (mm),Kuvvet (mN)", "Förskjutning [mm],Belastning [mN]",
        "Crosshead displacement / mm,Axial force / mN"}) {
    const MeasuredFile file = read(touching(20, plain_row, titles + "\n"));
    EXPECT_EQ(file.x_quantity, "position") << titles;
    EXPECT_NEAR(file.curve.x.back(), 3e-3, 1e-12) << titles;
    EXPECT_NEAR(file.curve.y.back(), 0.1 * std::pow(2.0, 1.5), 1e-6) << titles;
  }
}

/// Channels and symbols between titles and units, and titles in Shift JIS (変位, 試験力).
TEST_F(MeasuredData, FurtherLinesBelowTheTitlesAndShiftJis) {
  const MeasuredFile file =
      read(touching(20, plain_row, "Position,Force\nchannel 1,channel 2\nx,y\nmm,mN\n"));
  EXPECT_NEAR(file.curve.x.back(), 3e-3, 1e-12);
  EXPECT_TRUE(says(testing::PrintToString(file.notes), "line 2, 'channel 1,channel 2'"));
  const MeasuredFile japanese =
      read(touching(20, plain_row, "\x95\xCF\x88\xCA(mm),\x8E\x8E\x8C\xB1\x97\xCD(mN)\n"));
  EXPECT_EQ(japanese.x_title, "変位(mm)");
  EXPECT_EQ(japanese.curve.y, file.curve.y);
}

TEST_F(MeasuredData, OddRowsAreToldAndLeftOut) {
  const MeasuredFile plain = read(touching(60, plain_row));
  for (const int place : {0, 20, 45})
    for (const bool of_force : {false, true}) {
      if (place == 0 && of_force) continue;
      const MeasuredFile file = read(touching(60, [&](int i, double x, double force) {
        return i != place ? plain_row(i, x, force)
               : of_force ? plain_row(i, x, force + 150.0)
                          : plain_row(i, place == 0 ? x + 1.3 : x - 0.7, force);
      }));
      EXPECT_EQ(file.curve.x.size(), 59U) << place << of_force;
      EXPECT_TRUE(says(testing::PrintToString(file.notes),
                       "a row far from all others is left out: line " + std::to_string(place + 2)));
    }
  EXPECT_TRUE(plain.notes.empty()) << testing::PrintToString(plain.notes);
  // More than a few are no odd rows.
  const MeasuredFile many = read(touching(60, [](int i, double x, double force) {
    return plain_row(i, x, i % 9 == 4 ? force + 150.0 : force);
  }));
  EXPECT_EQ(many.curve.x.size(), 60U);
  EXPECT_TRUE(says(testing::PrintToString(many.notes), "too many to be left out"));
}

TEST_F(MeasuredData, ALoadCellAtItsLimitIsCutOff) {
  const MeasuredFile file = read(touching(
      80, [](int i, double x, double force) { return plain_row(i, x, std::min(force, 200.0)); }));
  EXPECT_LT(file.curve.y.back(), 0.2);
  EXPECT_GT(file.curve.x.back(), 2.5e-3);
  EXPECT_TRUE(says(testing::PrintToString(file.notes), "a load cell at its limit"));
}

TEST_F(MeasuredData, RowsInReverseOrderAreTheSameFile) {
  std::vector<std::string> rows;
  const std::string text = touching(40, [&](int i, double x, double force) {
    rows.push_back(plain_row(i, x, force));
    return rows.back();
  });
  std::string turned = "position [mm],force [mN]\n";
  for (auto row = rows.rbegin(); row != rows.rend(); ++row) turned += *row;
  EXPECT_EQ(read(turned).curve.x, read(text).curve.x);
  EXPECT_EQ(read(turned).curve.y, read(text).curve.y);
}

TEST_F(MeasuredData, RowsBeforeTouchTellAZeroThatIsNotThere) {
  for (const double zero : {0.0, 8.0, -8.0}) {
    const MeasuredFile file = read(touching(200, [&](int i, double x, double force) {
      return plain_row(i, x, force + zero + 0.5 * std::sin(7.0 * i));
    }));
    EXPECT_EQ(file.curve.zero_is_sought, zero != 0.0) << zero;
  }
}

TEST_F(MeasuredData, NoiseIsThatOfSingleRows) {
  for (const int rows : {150, 20000}) {
    const double noise = read(dense({.force_noise = 3.0, .rows = rows})).curve.course.noise;
    EXPECT_NEAR(noise, 3e-3, rows > 1000 ? 0.1e-3 : 0.9e-3) << rows;
  }
}
