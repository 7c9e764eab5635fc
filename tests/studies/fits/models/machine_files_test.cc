/// One press as ten machines would write it: each file is read without code, and the modulus that
/// is fitted is the same.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <random>

#include "calibration/statistics/curve_fit.h"
#include "meshes/base/errors.h"
#include "studies/fits/models/fit_input.h"
#include "studies/fits/models/fit_rig.h"
#include "studies/measurements/curve_file.h"
#include "tests/expectations.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using calibration::CurveSlopes;

namespace {

constexpr double youngs_modulus = 300e3, radius = 12.5e-3, touch = 0.28e-3;  // [Pa], [m]

/// Hertz: a rigid ball on an incompressible half space, F = 16/9 E sqrt(R) delta^1.5.
double hertz(double modulus, double depth) {
  return depth > 0.0 ? 16.0 / 9.0 * modulus * std::sqrt(radius) * std::pow(depth, 1.5) : 0.0;
}

class HertzModel final : public calibration::ForwardModel {
 public:
  explicit HertzModel(const std::vector<double>& depths) : depths_(depths) {}
  CurveSlopes evaluate(const Eigen::VectorXd& parameters) override {
    const auto count = Eigen::Index(depths_.size());
    CurveSlopes result{Eigen::VectorXd(count), Eigen::MatrixXd(count, 1)};
    for (Eigen::Index i = 0; i < count; ++i) {
      result.value(i) = hertz(parameters(0), depths_[std::size_t(i)]);
      result.jacobian(i, 0) = result.value(i) / parameters(0);
    }
    return result;
  }

 private:
  const std::vector<double>& depths_;
};

/// E and the touch, as `calibrate` finds them, by a formula in place of a press.
double fitted_modulus(const calibration::Curve& curve) {
  FitInput input;
  input.curves = {curve};
  input.options.free = {
      {.parameter = calibration::MaterialParameter::modulus, .start = 1e5, .scale = 1e5}};
  CalibrationSettings known;
  known.rig.compliance = known.rig.force_offset = known.rig.drift = {.given = true};
  input.curves[0].travel = travel_of(curve, known);
  free_rigs(input);
  HertzModel press(input.curves[0].travel->depths);
  calibration::RigModel model(press, input.curves[0].travel->depths, 1, input.curves[0].travel->rig,
                              curve.x, curve.time, 2);
  return calibration::fit_curves(curves_of(input), {&model}, input.options).estimates(0);
}

/// A row as the machine measured it, with the digits that every file has: mm, N, s.
struct Row {
  double time, position, force;
};

std::vector<Row> press(double modulus = youngs_modulus) {
  const auto rounded = [](double value, double digit) { return std::round(value / digit) * digit; };
  std::vector<Row> rows;
  for (int i = 0; i <= 80; ++i) {
    const double x = 0.0375 * i - 0.2;
    rows.push_back({0.5 * i, rounded(x, 1e-4), rounded(hertz(modulus, 1e-3 * x - touch), 1e-5)});
  }
  return rows;
}

std::string table(const std::function<std::string(const Row&)>& line,
                  const std::string& end = "\n") {
  std::string text;
  for (const Row& row : press()) text += line(row) + end;
  return text;
}

std::string with_commas(std::string text) {
  std::ranges::replace(text, '.', ',');
  return text;
}

/// 12345.6 as 12,345.6.
std::string grouped(double value, int decimals, char mark) {
  std::string text = fmt::format("{:.{}f}", value, decimals);
  const std::size_t first = text.starts_with('-') ? 1 : 0;
  for (std::size_t at = std::min(text.find('.'), text.size()); at > first + 3;)
    text.insert(at -= 3, 1, mark);
  return text;
}

std::string in_utf16(const std::string& ascii) {
  std::string text = "\xFF\xFE";
  for (const char c : ascii) text += std::string{c, '\0'};
  return text;
}

class MachineFiles : public testing::Test {
 protected:
  /// The curves of a file, described or speaking for itself.
  std::vector<MeasuredFile> read(const std::string& text, const std::string& description = "") {
    write_text(folder_ / "press.csv", text);
    std::filesystem::path entry = folder_ / "press.csv";
    if (!description.empty()) {
      entry = folder_ / "press.toml";
      write_text(entry, "[[press]]\npath = \"press.csv\"\n" + description);
    }
    return read_measured(curve_sources(entry).at(0), {measured::press, measured::travel});
  }
  void expect_the_press(const std::string& text, const std::string& description = "") {
    const std::vector<MeasuredFile> files = read(text, description);
    ASSERT_EQ(files.size(), 1U);
    const std::vector<Row> rows = press();
    const calibration::Curve& curve = files[0].curve;
    ASSERT_EQ(curve.x.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      EXPECT_NEAR(curve.x[i], 1e-3 * rows[i].position, 1e-13) << i;
      EXPECT_NEAR(curve.y[i], rows[i].force, 1e-12) << i;
    }
    if (!curve.time.empty()) {
      EXPECT_NEAR(curve.time.back() - curve.time.front(), 40.0, 1e-9);
    }
    EXPECT_NEAR(fitted_modulus(curve), same_, 1e-9 * same_);
  }
  void expect_refused(const std::string& text, const std::string& description,
                      const std::vector<std::string>& parts) {
    EXPECT_TRUE(refuses<std::exception>([&] { read(text, description); }, parts));
  }

  TemporaryFolder folder_;
  const double same_ = [] {
    calibration::Curve curve;
    curve.is_travel = true;
    for (const Row& row : press())
      curve.x.push_back(1e-3 * row.position), curve.y.push_back(row.force);
    return fitted_modulus(curve);
  }();
};

}  // namespace

/// The digits of a file cost a thousandth at most.
TEST_F(MachineFiles, TheModulusIsThatOfThePress) {
  EXPECT_NEAR(same_, youngs_modulus, 1e-3 * youngs_modulus);
}

/// In the style of Bluehill's raw data: results first, units in a row below, everything quoted.
TEST_F(MachineFiles, Instron) {
  expect_the_press(
      "\"Results Table 1\"\n\"Specimen label\",\"Maximum Compressive load\"\n\"1\",\"" +
      table([](const Row& row) {
        return fmt::format("\"{:.4f}\",\"{:.4f}\",\"{:.5f}\"", row.time, row.position, row.force);
      })
          .insert(0,
                  "9.12345\"\n\n\"Time\",\"Extension\",\"Load\"\n"
                  "\"(s)\",\"(mm)\",\"(N)\"\n"));
}

/// testXpert: Latin-1, semicolons, decimal commas, separators of thousands, compression negative.
TEST_F(MachineFiles, Zwick) {
  expect_the_press(
      "Pr\xFC"
      "fprotokoll;;\r\nPr\xFC"
      "fer;M\xFCller;\r\nPr\xFC"
      "fzeit;Standardweg;Standardkraft\r\n"
      "s;\xB5m;mN\r\n" +
          table(
              [](const Row& row) {
                std::string force = grouped(-1e3 * row.force, 2, '.');
                if (const auto at = force.rfind('.'); at != force.npos) force[at] = ',';
                return with_commas(fmt::format("{:.2f}", row.time)) + ";" +
                       with_commas(fmt::format("{:.1f}", 1e3 * row.position)) + ";" + force;
              },
              "\r\n"),
      "force = {column = \"Standardkraft\", sign = -1}\nposition = {column = \"Standardweg\"}\n"
      "time = {column = 1, unit = \"s\"}\n");
}

/// TestWorks: tabs, a banner with numbers in it, statistics below.
TEST_F(MachineFiles, Mts) {
  expect_the_press(
      "MTS793|MPT|ENU|1|2|.|/|:|1|0|0|A\n\nData Acquisition\t12\tTimed\n"
      "Crosshead (mm)\tLoad (kN)\tTime (min)\n" +
      table([](const Row& row) {
        return fmt::format("{:.4f}\t{:.8f}\t{:.14f}", row.position, 1e-3 * row.force,
                           row.time / 60.0);
      }) +
      "Mean\t1.3\t0.5\nStd Dev\t0.8\t0.2\n");
}

/// Trapezium: UTF-16, tests numbered above the header, names apart from units.
TEST_F(MachineFiles, Shimadzu) {
  expect_the_press(in_utf16("\"Key Word\"\t\"Silicone\"\r\n\"Test Date\"\t\"2026/11/03\"\r\n"
                            "\"1 - 1\"\r\nTime\tForce\tStroke\r\nsec\tN\tmm\r\n" +
                            table(
                                [](const Row& row) {
                                  return fmt::format("{:.3f}\t{:.5f}\t{:.4f}", row.time, row.force,
                                                     row.position);
                                },
                                "\r\n")),
                   "time = {column = 1, unit = \"s\"}\nforce = {column = 2, unit = \"N\"}\n"
                   "position = {column = \"Stroke\"}\n");
}

/// A texture analyser: force first, in grams of force, blanks in the header.
TEST_F(MachineFiles, TextureAnalyser) {
  expect_the_press("Force (gf)  Distance (mm)  Time (s)\n" + table([](const Row& row) {
                     return fmt::format("{:16.13f}  {:8.4f}  {:7.3f}", row.force / 9.80665e-3,
                                        row.position, row.time);
                   }));
}

/// VectorPro: a note on every side, empty cells at the end of rows, a column of words.
TEST_F(MachineFiles, Mecmesin) {
  expect_the_press("sep=;\nMecmesin export;;;\nState;Load [N];Displacement [mm];\n" +
                   table([](const Row& row) {
                     return fmt::format("Loading;{:.5f};{:.4f};;", row.force, row.position);
                   }) +
                   "\n");
}

/// A LabVIEW measurement: a header of keys between markers, times of the day.
TEST_F(MachineFiles, LabView) {
  expect_the_press(
      "LabVIEW Measurement\t\nWriter_Version\t2\nSeparator\tTab\n***End_of_Header***\t\n\n"
      "Channels\t2\t\t\n***End_of_Header***\t\t\t\nX_Value\tTravel\tForce\tComment\n" +
          table([](const Row& row) {
            return fmt::format("{:02d}:{:02d}:{:06.3f}\t{:.6E}\t{:.7E}\t", 9,
                               59 + int(row.time) / 60, row.time, row.position, row.force);
          }),
      "time = {column = \"X_Value\"}\nposition = {column = \"Travel\", unit = \"mm\"}\n"
      "force = {column = \"Force\", unit = \"N\"}\n");
}

/// An Arduino: no header, a greeting, commas; the load cell pulls where the finger is pressed.
TEST_F(MachineFiles, Arduino) {
  expect_the_press("HX711 ready\ntare done, 0\n" + table([](const Row& row) {
                     return fmt::format("{:.0f}, {:.1f}, {:.2f}", 1e3 * row.time,
                                        1e3 * row.position, -1e3 * row.force);
                   }),
                   "position = {column = 2, unit = \"um\"}\n"
                   "force = {column = 3, unit = \"mN\", sign = -1}\n"
                   "time = {column = 1, unit = \"ms\"}\n");
}

/// A robot presses downwards: z falls and fz is what the table does to the wrist.
TEST_F(MachineFiles, Robot) {
  expect_the_press("# robot log, base frame\nstamp x y z fx fy fz\n" + table([](const Row& row) {
                     return fmt::format("{:.3f} 0.4 -0.1 {:.7f} 0.01 0.02 {:.5f}",
                                        1762161234.0 + row.time, -1e-3 * row.position, row.force);
                   }),
                   "position = {column = \"z\", unit = \"m\", sign = -1}\n"
                   "force = {column = \"fz\", unit = \"N\"}\n"
                   "time = {column = \"stamp\", unit = \"s\"}\n");
}

/// A spreadsheet: byte order mark, titles that are not ours, quoted numbers with thousands.
TEST_F(MachineFiles, Spreadsheet) {
  expect_the_press(
      "\xEF\xBB\xBF"
      "No.,Depth below start (\xC2\xB5m),\"Push, mN\",Remark\n" +
          table([](const Row& row) {
            return fmt::format("{:.0f},\"{}\",\"{}\",\"a, b\"", 2.0 * row.time,
                               grouped(1e3 * row.position, 1, ','),
                               grouped(1e3 * row.force, 2, ','));
          }),
      "position = {column = 2, unit = \"um\"}\nforce = {column = 3, unit = \"mN\"}\n");
}

/// Ten thousand rows with noise in force and travel: means in bins have the modulus of the press.
TEST_F(MachineFiles, ThinningBiasesNothing) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  constexpr int files = 24;
  double sum = 0.0, squares = 0.0;
  for (int file = 0; file < files; ++file) {
    std::string text = "position [mm],force [N]\n";
    for (int i = 0; i < 10000; ++i) {
      const double x = 3.0 * i / 1e4;
      text += fmt::format("{:.6f},{:.6f}\n", x + 5e-4 * normal(random),
                          hertz(youngs_modulus, 1e-3 * x - touch) + 0.05 * normal(random));
    }
    const auto curve = read(text)[0].curve;
    EXPECT_LE(curve.x.size(), 200U);
    const double error = fitted_modulus(curve) / youngs_modulus - 1.0;
    sum += error / files, squares += error * error / files;
  }
  EXPECT_LT(std::sqrt(squares), 5e-3);
  EXPECT_LT(std::abs(sum), 3.0 * std::sqrt(squares / files));
}

TEST_F(MachineFiles, SeveralTestsInOneFileAreCurves) {
  const auto block = [](const std::string& name, double modulus) {
    std::string text = name + "\nWeg [mm];Kraft [N]\n";
    for (const Row& row : press(modulus))
      text += with_commas(fmt::format("{:.4f};{:.5f}\n", row.position, row.force));
    return text;
  };
  const std::string text = block("Probe 1", 300e3) + "\n" + block("Probe 2", 330e3);
  const auto files = read(text);
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[1].curve.name, "press, test 2");
  EXPECT_NEAR(fitted_modulus(files[1].curve) / fitted_modulus(files[0].curve), 1.1, 1e-3);
  // Name, header, 81 rows, an empty line, name, header.
  EXPECT_EQ(files[1].lines.front(), 87U);
  const auto second = read(text, "block = 2\nrows = [1, 70]\n");
  ASSERT_EQ(second.size(), 1U);
  EXPECT_EQ(second[0].curve.x.size(), 70U);
  expect_refused(text, "block = 3\n", {"block = 3", "has 2 tables"});
}

/// A load cell's data sheet tells one deviation for all rows.
TEST_F(MachineFiles, OneSigmaMayHoldForEveryRow) {
  const std::string rows = "position [mm];force [N]\n0.1;0.0\n0.2;0.2\n0.3;0.5\n";
  const auto files = read(rows, "sigma = \"10 mN\"\n");
  EXPECT_EQ(files.at(0).curve.sigma, (std::vector<double>{0.01, 0.01, 0.01}));
  expect_refused(rows, "sigma = \"-10 mN\"\n", {"sigma", "must be positive"});
  expect_refused(rows, "sigma = \"10 mm\"\n", {"sigma", "dimension"});
}

TEST_F(MachineFiles, LinesThatAreNotReadAreTold) {
  const auto files = read(
      "a remark\nposition [mm];force [N]\n0.1;0.0\n0.2;0.2\nEvent: light off\n"
      "0.3;0.5\nMean;0.23\n");
  ASSERT_EQ(files[0].curve.x.size(), 3U);
  const std::string notes = testing::PrintToString(files[0].notes);
  EXPECT_TRUE(says(notes, {"1 line above the table is not read",
                           "line 5, 'Event: light off'; line 7, 'Mean;0.23'"}));
}

TEST_F(MachineFiles, RefusalsNameLineAndColumn) {
  const std::string two =
      "position = {column = 1, unit = \"mm\"}\n"
      "force = {column = \"F\", unit = \"N\"}\n";
  const std::string file = (folder_ / "press.csv").string(),
                    toml = (folder_ / "press.toml").string();
  expect_refused("x;F\n1;2\n1,5;abc\n", two, {file + ":3: F = abc", "finite number"});
  expect_refused("x;G\n1;2\n", two, {file + ":1", "'F' is missing", "'x, G'"});
  expect_refused("x;F;F\n1;2;3\n", two, {"'F' is there twice", "give its number"});
  expect_refused("x;F\n1;2\n",
                 "force = {column = 3, unit = \"N\"}\n"
                 "position = {column = 1, unit = \"mm\"}\n",
                 {"column 3 is missing"});
  expect_refused("x;F\n1;2\n", "force = {column = 2, unit = \"mm\"}\nposition = {column = 1}\n",
                 {toml + ":3: press[1].force.unit"});
  expect_refused("x;F\n1;2\n", "force = {column = 2}\n", {"needs a force, and a position"});
  expect_refused("x;F\n1;2\n", two + "separator = \"pipe\"\n", {toml + ":5: press[1].separator"});
  expect_refused("x;F\n1;2\n", two + "unit = \"mm\"\n", {"press[1].unit", "no such key"});
  expect_refused("x;F\n1;2\n", two + "rows = [1, 5]\n", {"rows", "has 1 rows"});
  expect_refused("x;F\n1;2\n", two + "indentation = {column = 1}\n", {"beside position"});
  expect_refused("x;F\n1;2\n2;3;4\n", two, {file + ":3", "3 cells"});
}

TEST_F(MachineFiles, PositionsThatFallAreRefusedWithWhatTurnsThemRound) {
  const std::string down = "Weg [mm];Kraft [N]\n" + table([](const Row& row) {
                             return fmt::format("{:.4f};{:.5f}", 100.0 - row.position, row.force);
                           });
  expect_refused(down, "",
                 {"Weg [mm]: falls while the force grows",
                  "path = 'press.csv'\nposition = {column = 'Weg [mm]', sign = -1}\n"
                  "force = {column = 'Kraft [N]'}"});
  const std::string columns = "force = {column = 'Kraft [N]'}\nposition = {column = 'Weg [mm]'";
  expect_refused(down, columns + "}\n", {"position = {column = 'Weg [mm]', sign = -1}"});
  const auto turned = read(down, columns + ", sign = -1}\n");
  EXPECT_NEAR(fitted_modulus(turned.at(0).curve), same_, 1e-6 * same_);
}

TEST_F(MachineFiles, TimesOfTheDayAreSeconds) {
  EXPECT_EQ(time_in("1:02:03.5"), 3723.5);
  EXPECT_EQ(time_in("2026-11-03T00:01:00Z"), 60.0);
  EXPECT_EQ(time_in("02:03,25"), 123.25);
  EXPECT_EQ(time_in("7.5"), 7.5);
  EXPECT_FALSE(time_in("1:x"));
  EXPECT_FALSE(time_in("1:2:3:4"));
  EXPECT_FALSE(time_in(""));
}

/// A cell that was forgotten below the table, a mean without a word: told and not read. A file cut
/// within a row is one that lost data, and a gap among the rows is wrong.
TEST_F(MachineFiles, WhatCannotBeARowBelowTheTableIsTold) {
  const std::string text =
      "Zeit [s];Weg [mm];Kraft [N]\n" + table([](const Row& row) {
        return with_commas(fmt::format("{:.2f};{:.4f};{:.5f}", row.time, row.position, row.force));
      });
  for (const char* below :
       {";0,5514\n", ";0,5514;\n", ";;\n", ";;0,5514\n", "\n12,5;0,55\n", "\n;;0,5\n;0,7\n"}) {
    expect_the_press(text + below);
    const std::string notes = testing::PrintToString(read(text + below)[0].notes);
    EXPECT_TRUE(says(notes, "line 8")) << below;
    EXPECT_TRUE(says(notes, "not read")) << below;
  }
  expect_refused(text + "40,5;2,84", "",
                 {"press.csv:83", "has 2 cells, the header 3", "truncated"});
  expect_refused(text + "40,5;2,84;", "", {"press.csv:83", "the cell is empty"});
  expect_refused(text + ";0,5514\n41;2,9;9,9\n", "", {"press.csv:83", "has 2 cells"});
}

/// A name over every column, titles in the second line, units in the third.
TEST_F(MachineFiles, KnowsTheTitlesOfSeveralLanguages) {
  const std::string rows = table([](const Row& row) {
    return fmt::format("{:.2f};{:.4f};{:.5f}", row.time, row.position, row.force);
  });
  for (const char* titles :
       {"Prüfzeit;Traversenweg;Prüfkraft", "Temps d'essai;Allongement;Force standard",
        "Temps;Déplacement;Charge", "Tiempo;Desplazamiento;Fuerza", "Tiempo;Posición;Carga",
        "Tempo;Spostamento;Forza", "TEMPO;Corsa;Carico", "Time;Compression;Compressive force",
        "时间;位移;试验力"})
    expect_the_press("Probe 1;Probe 1;Probe 1\n" + std::string(titles) + "\ns;mm;N\n" + rows);
  expect_the_press(
      "Temps d\xE2\x80\x99"
      "essai (s);Allongement (mm);Force standard (N)\n" +
      rows);
  // GB 2312, with the brackets of its printers: "time", "displacement", "test force".
  expect_the_press(
      "\xCA\xB1\xBC\xE4\xA3\xA8s\xA3\xA9;\xCE\xBB\xD2\xC6\xA3\xA8mm\xA3\xA9;"
      "\xCA\xD4\xD1\xE9\xC1\xA6\xA3\xA8N\xA3\xA9\n" +
      rows);
}

TEST_F(MachineFiles, RefusalsShowTheTitlesAndBothColumns) {
  expect_refused("Probe 1;Probe 1\nEmpuje;Camino\nN;mm\n0,1;0,2\n0,3;0,4\n", "",
                 {"press.csv:2", "'Empuje, Camino'", "begin in line 4", "column = 3"});
  expect_refused("Weg [mm];Kraft [N];Load [N]\n0,1;0,2;0,3\n0,2;0,4;0,5\n", "",
                 {"Load [N]", "'Kraft [N]', column 2", "force = {column = 2} or {column = 3}"});
}
