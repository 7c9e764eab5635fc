/// Material tests from files of every layout, and what is refused with which words.
#include "studies/measurements/material_test_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <sstream>
#include <utility>
#include <vector>

#include "calibration/material_tests/strain_grid.h"
#include "tests/studies/measurements/material_files.h"

using namespace fingertip;
using namespace fingertip::studies;
using calibration::MaterialTest;
using calibration::StressMeasure;
using calibration::TestKind;

namespace {

const std::string two_columns =
    "[data]\nseparator = \"whitespace\"\nheader = false\n"
    "stress = {column = 1, is = \"nominal\", unit = \"MPa\"}\n"
    "strain = {column = 2, is = \"stretch\"}\n"
    "[[test]]\nname = \"sheet\"\nkind = \"equibiaxial\"\npath = \"data.csv\"\n";
const std::string two_rows = "    0.0925    1.0270\r\n   0.1570 \t 1.0650\r\n";

TEST_F(MaterialFiles, TwoColumnsWithoutAHeader) {
  const auto file = read(two_columns, two_rows);
  ASSERT_EQ(file.fitted.size(), 1u);
  const MaterialTest& test = file.fitted[0];
  EXPECT_EQ(test.name, "sheet");
  EXPECT_EQ(test.kind, TestKind::equibiaxial);
  EXPECT_EQ(test.deformation, (std::vector{1.027, 1.065}));
  EXPECT_NEAR(test.stress[1], 157e3, 1e-6);
  EXPECT_TRUE(says(test.source, "data.csv (SHA-256 "));
  EXPECT_FALSE(test.rate);
}

TEST_F(MaterialFiles, AMachinesCompressionWithLinesAboveTheHeader) {
  const std::string data =
      "sample\nDiameter: 50mm;\nTime (s),Compression (mm),Load (N)\n"
      "0,0.0,-0.01\n1,3.0,100\n2,2.9,90\n3,6.0,300\n4,9,500\n5,10,510\n6,11,520\n7,12,530\n"
      "8,12.5,540\n9,13,550\n10,14,600\n11,14.5,650\n";
  const std::string head =
      "[about]\nmaterial = \"a silicone\"\nlicence = \"CC BY 4.0\"\n[data]\nkind = \"uniaxial\"\n"
      "skip = 2\ndiameter = \"50 mm\"\nheight = \"30 mm\"\nspeed = \"10 mm/min\"\n"
      "strain = {column = \"Compression (mm)\", is = \"displacement\", unit = \"mm\", sign = -1}\n"
      "stress = {column = \"Load (N)\", is = \"force\", unit = \"N\", sign = -1}\n"
      "[[test]]\npath = \"data.csv\"\n";
  const auto file = read(head, data);
  const MaterialTest& test = file.fitted.at(0);
  EXPECT_EQ(file.material, "a silicone");
  EXPECT_EQ(test.licence, "CC BY 4.0");
  EXPECT_EQ(test.name, "data");
  ASSERT_EQ(test.deformation.size(), 11u);  // 2.9 mm is the noise of an encoder
  EXPECT_NEAR(test.deformation[0], 1.0 - 14.5 / 30.0, 1e-15);
  EXPECT_EQ(test.deformation.back(), 1.0);
  const double area = M_PI * 0.025 * 0.025;
  EXPECT_NEAR(test.stress[0], -650.0 / area, 1e-6);
  EXPECT_NEAR(*test.rate, 0.01 / 60.0 / 0.03, 1e-12);
  EXPECT_FALSE(file.stuck[0]);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_TRUE(says(file.notes[0], "12 rows are averaged in 11 bins of equal strain"));
  const auto branch = read(head + "rows = [4, 6]\nplates = \"stick\"\n", data);
  EXPECT_EQ(branch.fitted[0].deformation.size(), 3u);
  ASSERT_TRUE(branch.stuck[0]);
  EXPECT_NEAR(branch.stuck[0]->diameter, 0.05, 1e-15);
}

TEST_F(MaterialFiles, SemicolonsDecimalCommasPercentAndTrueStress) {
  const auto file = read(
      "[[test]]\nkind = \"uniaxial\"\npath = \"data.csv\"\nseparator = \"semicolon\"\n"
      "decimal = \"comma\"\nstrain = {column = \"Strain, %\", is = \"engineering\", unit = \"%\"}\n"
      "stress = {column = 2, is = \"true\", unit = \"kPa\"}\nrange = [0, 30]\n"
      "[[test]]\nname = \"again\"\nuse = \"predict\"\nkind = \"uniaxial\"\npath = \"data.csv\"\n"
      "separator = \"semicolon\"\ndecimal = \"comma\"\n"
      "strain = {column = 1, is = \"logarithmic\", unit = \"%\"}\n"
      "stress = {column = 2, is = \"nominal\", unit = \"kPa\"}\n",
      "Strain, %;Stress\n10,5;1,5\n20;3\n50;7");
  EXPECT_EQ(file.fitted[0].measure, StressMeasure::cauchy);
  ASSERT_EQ(file.fitted[0].deformation.size(), 2u);
  EXPECT_NEAR(file.fitted[0].deformation[0], 1.105, 1e-15);
  EXPECT_NEAR(file.fitted[0].stress[0], 1500.0, 1e-9);
  ASSERT_EQ(file.validation.size(), 1u);
  EXPECT_NEAR(file.validation[0].deformation[2], std::exp(0.5), 1e-15);
}

TEST_F(MaterialFiles, RepeatsAreAveragedOnTheStrainTheyShare) {
  write_text(folder_ / "b.csv", "e,s\n0,0\n0.5,7\n");
  const auto file = read(
      "[[test]]\nkind = \"uniaxial\"\npath = [\"data.csv\", \"b.csv\"]\npoints = 5\n"
      "strain = {column = \"e\", is = \"engineering\"}\n"
      "stress = {column = \"s\", is = \"nominal\", unit = \"Pa\"}\n",
      "e,s\n0,0\n0.2,2\n0.4,4\n");
  const MaterialTest& test = file.fitted.at(0);
  ASSERT_EQ(test.deformation.size(), 5u);
  EXPECT_NEAR(test.deformation.back(), 1.4, 1e-15);
  EXPECT_NEAR(test.stress[2], 0.5 * (2.0 + 2.8), 1e-12);
}

TEST_F(MaterialFiles, ShearVolumeAndSigma) {
  const auto file = read(
      "[data]\nseparator = \"tab\"\n"
      "[[test]]\nname = \"lap\"\nkind = \"simple-shear\"\npath = \"data.csv\"\nlength = \"10 mm\"\n"
      "strain = {column = \"u\", is = \"displacement\", unit = \"mm\"}\n"
      "stress = {column = \"t\", is = \"nominal\", unit = \"kPa\"}\n"
      "sigma = {column = \"d\", unit = \"kPa\"}\n"
      "[[test]]\nname = \"bulk\"\nkind = \"volumetric\"\npath = \"data.csv\"\n"
      "strain = {column = \"u\", is = \"volume-change\", unit = \"%\", sign = -1}\n"
      "stress = {column = \"t\", is = \"pressure\", unit = \"kPa\"}\n",
      "u\tt\td\n0\t0\t1\n1\t2\t1\n3\t7\t2\n");
  const MaterialTest &lap = file.fitted.at(0), &bulk = file.fitted.at(1);
  EXPECT_EQ(lap.deformation, (std::vector{0.1, 0.3}));  // rest tells nothing of shear
  EXPECT_EQ(lap.sigma, (std::vector{1e3, 2e3}));
  EXPECT_NEAR(bulk.deformation[0], 0.97, 1e-15);
  EXPECT_NEAR(bulk.stress[0], -7e3, 1e-9);
}

TEST_F(MaterialFiles, RefusalsNameFileLineKeyAndRemedy) {
  const auto with = [&](const std::string& more) { return two_columns + more + "\n"; };
  const std::string file = (folder_ / "tests.toml").string();
  expect_refused(with("separatr = \"comma\""), two_rows,
                 {file + ":10: test[1].separatr = comma: no such key"});
  expect_refused(with("separator = \"comma\""), two_rows, {"data.csv", "column 2 is missing"});
  expect_refused(with("kind = 3"), two_rows, {"tests.toml:10", "not valid TOML"});
  expect_refused(with("strain = {column = 7, is = \"stretch\"}"), two_rows,
                 {"data.csv", "column 7 is missing"});
  expect_refused(with("strain = {column = \"x\", is = \"stretch\"}"), two_rows,
                 {"data.csv:1", "the column 'x' is missing"});
  expect_refused(with("strain = {column = 1, is = \"strech\"}"), two_rows,
                 {"test[1].strain.is = strech", "stretch, engineering, logarithmic"});
  expect_refused(with("strain = {column = 1, is = \"displacement\", unit = \"mm\"}"), two_rows,
                 {"needs the length"});
  expect_refused(with("stress = {column = 1, is = \"force\", unit = \"N\"}"), two_rows,
                 {"needs the area"});
  expect_refused(with("stress = {column = 1, is = \"nominal\", unit = \"mm\"}"), two_rows,
                 {"test[1].stress.unit = mm", "is a length, and stress is a stress here"});
  expect_refused(with("stress = {column = 1, is = \"nominal\"}"), two_rows,
                 {"neither the file nor its description tells the unit of the stress"});
  expect_refused(with("plates = \"stick\""), two_rows, {"plates hold a cylinder"});
  expect_refused(with("rows = [1, 9]"), two_rows, {"has 2 rows of data"});
  expect_refused(with("range = [3.0, 4.0]"), two_rows, {"fewer than two rows"});
  expect_refused(with("speed = \"1 mm/s\""), two_rows, {"speed over length"});
  expect_refused(with("decimal = \"comma\"\nseparator = \"comma\""), two_rows, {"cannot separate"});
  expect_refused(with("strain = {column = 2, is = \"engineering\", sign = -1}"), two_rows,
                 {"stress", "turn one of them about"});
  expect_refused("[data]\n", "", {"names no test"});
  expect_refused(with("use = \"predict\""), two_rows, {"at least one test is fitted"});
  expect_refused(two_columns, "1 2\n1 2 3\n", {"data.csv:2", "has 3 cells, the first row 2"});
  expect_refused("[[test]\n", "", {"tests.toml:1", "not valid TOML"});
}

const std::string pulled =
    "[[test]]\nkind = \"uniaxial\"\npath = \"data.csv\"\narea = \"18 mm^2\"\nlength = \"33 mm\"\n";
/// Nominal stress of neo-Hooke, G = 60 kPa [Pa].
double stress_at(double strain) {
  const double stretch = 1.0 + strain;
  return 60e3 * (stretch - std::pow(stretch, -2.0));
}
/// Rows at the strains of row(i), i from 0.
template <typename Row>
std::string table(const std::string& header, int rows, const Row& row) {
  std::ostringstream text;
  text.precision(12);
  text << header;
  for (int i = 0; i < rows; ++i) {
    const auto [x, y] = row(i);
    text << x << ',' << y << '\n';
  }
  return text.str();
}
using Pair = std::pair<double, double>;
std::string loading_rows(const std::string& header = "e,s\n", int rows = 46) {
  return table(header, rows, [](int i) { return Pair(0.01 * i, stress_at(0.01 * i) / 1e3); });
}
const std::string strain_and_stress =
    "[[test]]\nkind = \"uniaxial\"\npath = \"data.csv\"\n"
    "strain = {column = \"e\", is = \"engineering\"}\n"
    "stress = {column = \"s\", is = \"nominal\", unit = \"kPa\"}\n";

/// What the test of these rows holds is neo-Hooke's stress, within `error` [Pa].
void expect_neo_hooke(const MaterialTestFile& file, double error) {
  const MaterialTest& test = file.fitted.at(0);
  ASSERT_GT(test.stress.size(), 10u);
  for (std::size_t i = 0; i < test.stress.size(); ++i)
    EXPECT_NEAR(test.stress[i], stress_at(test.deformation[i] - 1.0), error) << i;
}

TEST_F(MaterialFiles, TheFilesUnitCounts) {
  const std::string data = table("Force,AVE 2,Way\n(kN),(%),(mm)\n", 20, [](int i) {
    return std::pair(stress_at(0.02 * i) * 18e-6 / 1e3,
                     std::to_string(2 * i) + "," + std::to_string(0.66 * i));
  });
  const auto with = [&](const std::string& strain, const std::string& stress) {
    return pulled + "strain = {column = " + strain + "}\nstress = {column = " + stress + "}\n";
  };
  const std::string per_cent = "\"AVE 2\", is = \"engineering\"",
                    force = "\"Force\", is = \"force\"";
  for (const std::string& described :
       {with(per_cent, force), with("2, is = \"engineering\"", "1, is = \"force\""),
        with("3, is = \"displacement\"", "1, is = \"force\", unit = \"kN\""),
        with(per_cent + ", unit = \"%\"", force + ", unit = \"1000 N\"")})
    expect_neo_hooke(read(described, data), 0.5);
  // Of all that differs both are told.
  expect_refused(with(per_cent, force + ", unit = \"N\""), data,
                 {"Force", "the file says [kN] and its description unit = \"N\"", "1 N"});
  expect_refused(with(per_cent + ", unit = \"1\"", force), data, {"AVE 2", "[%]", "\"1\""});
  expect_refused(with("\"Way\", is = \"engineering\"", force), data,
                 {"Way", "[mm], a length", "is = \"displacement\""});
  expect_refused(strain_and_stress, loading_rows("e,s [counts]\n"), {"[counts]", "\"kPa\""});
  std::string by_name = strain_and_stress;
  by_name.replace(by_name.find("\"e\""), 3, "\"Weg\"");
  expect_refused(by_name, loading_rows("Weg,s\n"), {"Weg", "the title names a length"});
  by_name.replace(by_name.find("\"engineering\""), 13, "\"engineering\", unit = \"1\"");
  expect_neo_hooke(read(by_name, loading_rows("Weg,s\n")), 1e-6);
  expect_refused(with("\"AVE 2\", is = \"displacement\"", force), data,
                 {"AVE 2", "[%], a bare number"});
  expect_refused(with(per_cent, "\"Force\", is = \"nominal\""), data,
                 {"[kN], a force", "is = \"force\""});
  expect_refused(with(per_cent, "\"Force\", is = \"nominal\", unit = \"N\""), data,
                 {"stress.unit = N", "is a force", "is = \"force\""});
  expect_refused(strain_and_stress, loading_rows("e,s [MPa]\n"), {"[MPa]", "\"kPa\""});
}

TEST_F(MaterialFiles, CountsHaveAScaleAndAZero) {
  const std::string data = table("p [steps],f [counts]\n", 30, [](int i) {
    const double strain = 0.02 * i;
    return Pair(-1540.0 + 3300.0 * strain, stress_at(strain) * 18e-6 / 0.0125 - 560.0);
  });
  for (const std::string zeros :
       {"zero = \"first row\"|zero = \"first row\"", "zero = -1540|zero = -560",
        "zero = \"-15.4 mm\"|zero = \"-7 N\""}) {
    const auto bar = zeros.find('|');
    const auto file =
        read(pulled + "strain = {column = \"p\", is = \"displacement\", unit = \"10 um\", " +
                 zeros.substr(0, bar) +
                 "}\nstress = {column = \"f\", is = \"force\", scale = 0.0125, "
                 "unit = \"N\", " +
                 zeros.substr(bar + 1) + "}\n",
             data);
    expect_neo_hooke(file, 1e-3);
    EXPECT_TRUE(file.fitted[0].stress_zero_known);
  }
  const auto described = [](const std::string& more) {
    return pulled + "strain = {column = 1, is = \"displacement\", unit = \"mm\", " + more +
           "}\nstress = {column = 2, is = \"force\", unit = \"N\"}\n";
  };
  expect_refused(described("zero = \"last row\""), "1,2\n2,3\n", {"strain.zero", "first row"});
  expect_refused(described("zero = \"2 N\""), "1,2\n2,3\n", {"strain.zero", "dimension"});
  expect_refused(described("scale = 0"), "1,2\n2,3\n", {"strain.scale", "positive"});
}

TEST_F(MaterialFiles, RowsAtRestTellTheZero) {
  const std::string data = table("e,s\n", 54, [](int i) {
    const double strain = 0.01 * std::max(0, i - 8);
    return Pair(strain, 6.0 + stress_at(strain) / 1e3);
  });
  const auto file = read(strain_and_stress, data);
  expect_neo_hooke(file, 1e-6);
  EXPECT_TRUE(says(file.notes.at(0), "9 rows at rest tell the stress 6000 Pa"));
  // However large: it is no sign.
  expect_neo_hooke(read(strain_and_stress, table("e,s\n", 54,
                                                 [](int i) {
                                                   const double e = 0.01 * std::max(0, i - 8);
                                                   return Pair(e, stress_at(e) / 1e3 - 80.0);
                                                 })),
                   1e-6);
  // A described zero counts alone.
  std::string own = strain_and_stress;
  own.replace(own.find("unit = \"kPa\""), 12, "unit = \"kPa\", zero = 1");
  EXPECT_NEAR(read(own, data).fitted.at(0).stress.front(), 5000.0, 1e-6);
  std::string sought = strain_and_stress;
  sought.replace(sought.find("unit = \"kPa\""), 12, "unit = \"kPa\", zero = \"fit\"");
  EXPECT_TRUE(read(sought, loading_rows()).fitted.at(0).stress_zero_sought);
}

TEST_F(MaterialFiles, WhatCannotBeIsToldWithItsCause) {
  // A crosshead that begins elsewhere is no sign.
  const std::string far = table(
      "p,f\n", 20, [](int i) { return Pair(48.21 + 0.3 * i, stress_at(0.3 * i / 33.0) * 18e-6); });
  expect_refused(pulled +
                     "strain = {column = \"p\", is = \"displacement\", unit = \"mm\"}\n"
                     "stress = {column = \"f\", is = \"force\", unit = \"N\"}\n",
                 far, {"begins 48.21 mm from rest", "zero = \"first row\""});
  std::string turned = strain_and_stress;
  turned.replace(turned.find("unit = \"kPa\""), 12, "unit = \"kPa\", sign = -1");
  expect_refused(turned, loading_rows(), {"falls where the strain grows", "sign = -1"});
  const std::string pressed =
      table("e,s\n", 20, [](int i) { return Pair(-0.01 * i, stress_at(-0.01 * i) / 1e3); });
  std::string shear = strain_and_stress;
  shear.replace(shear.find("\"uniaxial\""), 10, "\"simple-shear\"");
  shear.replace(shear.find("\"engineering\""), 13, "\"shear\"");
  expect_refused(shear, pressed, {"a shear is positive", "kind = \"uniaxial\""});
  const auto plates = read(strain_and_stress + "height = \"30 mm\"\n", loading_rows());
  EXPECT_TRUE(says(plates.notes.at(0), "is read as a tension"));
  EXPECT_TRUE(read(strain_and_stress + "height = \"30 mm\"\n", pressed).notes.empty());
}

TEST_F(MaterialFiles, RowsAtRestOverruleAZeroThatIsSought) {
  const std::string data = table("e,s\n", 54, [](int i) {
    const double strain = 0.01 * std::max(0, i - 8);
    return Pair(strain, 6.0 + stress_at(strain) / 1e3);
  });
  std::string sought = strain_and_stress;
  sought.replace(sought.find("unit = \"kPa\""), 12, "unit = \"kPa\", zero = \"fit\"");
  const auto file = read(sought, data);
  EXPECT_FALSE(file.fitted.at(0).stress_zero_sought);
  expect_neo_hooke(file, 1e-6);
}

TEST_F(MaterialFiles, OfCyclesTheLoadingIsTakenInWhateverOrder) {
  std::vector<double> strains;
  for (const int turn : {30, 45}) {
    for (int i = 0; i <= turn; ++i) strains.push_back(0.01 * i);
    for (int i = turn; i > 0; --i) strains.push_back(-0.01 * i);  // on the way back
  }
  const auto row = [&](int i) {
    const double strain = std::abs(strains[std::size_t(i)]);
    return Pair(strain, (strains[std::size_t(i)] < 0.0 ? 0.8 : 1.0) * stress_at(strain) / 1e3);
  };
  const auto cycles = read(strain_and_stress, table("e,s\n", int(strains.size()), row));
  expect_neo_hooke(cycles, 1.0);
  EXPECT_NEAR(cycles.fitted[0].deformation.back(), 1.45, 1e-12);
  const auto turned = read(strain_and_stress, table("e,s\n", 46, [](int i) {
                             return Pair(0.01 * (45 - i), stress_at(0.01 * (45 - i)) / 1e3);
                           }));
  expect_neo_hooke(turned, 1e-6);
  EXPECT_EQ(turned.fitted[0].deformation,
            read(strain_and_stress, loading_rows()).fitted[0].deformation);
}

TEST_F(MaterialFiles, DenseRowsWithNoiseOfTheStrainAreAveraged) {
  std::mt19937 generator(5);
  std::normal_distribution<double> normal;
  const auto file = read(strain_and_stress, table("e,s\n", 3000, [&](int i) {
                           const double strain = 1e-4 * i;
                           return Pair(strain + 6e-5 * normal(generator), stress_at(strain) / 1e3);
                         }));
  EXPECT_LE(file.fitted.at(0).stress.size(), 200u);
  expect_neo_hooke(file, 30.0);
}

TEST_F(MaterialFiles, OddRowsAndALoadCellAtItsLimitAreLeftOut) {
  const auto with = [&](int place, double strain, double stress) {
    return table("e,s\n", 46, [&](int i) {
      const double e = 0.01 * i;
      return i == place ? Pair(strain, stress) : Pair(e, stress_at(e) / 1e3);
    });
  };
  for (const std::string& data : {with(0, 0.2, 0.0), with(20, 0.2, 90.0), with(30, 0.02, 45.0)}) {
    const auto file = read(strain_and_stress, data);
    expect_neo_hooke(file, 1e-6);
    EXPECT_EQ(file.fitted[0].stress.size(), 45u);
    EXPECT_TRUE(says(file.notes.at(0), "a row far from all others is left out: line"));
  }
  const auto clipped = read(strain_and_stress, table("e,s\n", 46, [](int i) {
                              return Pair(0.01 * i, std::min(45.0, stress_at(0.01 * i) / 1e3));
                            }));
  expect_neo_hooke(clipped, 1e-6);
  EXPECT_LT(clipped.fitted[0].stress.back(), 45e3);
  EXPECT_TRUE(says(clipped.notes.at(0), "a load cell at its limit"));
}

TEST_F(MaterialFiles, SpecimensThatScatterAreOneTest) {
  write_text(folder_ / "b.csv", table("e,s\n", 46, [](int i) {
               return Pair(0.01 * i, 0.8 * stress_at(0.01 * i) / 1e3);
             }));
  std::string two = strain_and_stress;
  two.replace(two.find("\"data.csv\""), 10, "[\"data.csv\", \"b.csv\"]");
  const auto file = read(two, loading_rows());
  const MaterialTest& test = file.fitted.at(0);
  ASSERT_EQ(test.specimens.size(), 2u);
  EXPECT_NEAR(test.specimens[0], 1.0 / 0.9, 1e-9);
  EXPECT_NEAR(test.specimens[1], 0.8 / 0.9, 1e-9);
  EXPECT_TRUE(says(file.notes.at(0), "a scatter of 16 %"));
  EXPECT_NEAR(calibration::error_of_mean(test.specimens),
              12.706 / 1.95996 * (0.2 / 0.9 / std::sqrt(2.0)) / std::sqrt(2.0), 1e-4);
}

TEST_F(MaterialFiles, StretchesThatNoRubberBearsAreDoubted) {
  const auto file =
      read(strain_and_stress,
           table("e,s\n", 20, [](int i) { return Pair(0.8 * i, stress_at(0.02 * i) / 1e3); }));
  ASSERT_EQ(file.fitted.at(0).doubts.size(), 1u);
  EXPECT_TRUE(says(file.fitted[0].doubts[0], "per cent"));
  EXPECT_TRUE(read(strain_and_stress, loading_rows()).fitted.at(0).doubts.empty());
  // A sheet pulled both ways to 4.5 is a twentieth as thick.
  EXPECT_TRUE(read(two_columns, "0.09 1.03\n0.9 2.5\n2.4 4.45\n").fitted.at(0).doubts.empty());
}

TEST_F(MaterialFiles, PathsMayBeginWithAnEnvironmentVariable) {
  std::string elsewhere = two_columns;
  const std::string path = "path = \"data.csv\"";
  elsewhere.replace(elsewhere.find(path), path.size(), "path = \"$FINGERTIP_TEST_DATA/data.csv\"");
  unsetenv("FINGERTIP_TEST_DATA");
  expect_refused(elsewhere, two_rows,
                 {"tests.toml:9: test[1].path", "$FINGERTIP_TEST_DATA/data.csv",
                  "no environment variable FINGERTIP_TEST_DATA is set", "folder of the data"});
  setenv("FINGERTIP_TEST_DATA", folder_.path().c_str(), 1);
  EXPECT_EQ(read(elsewhere, two_rows).fitted.at(0).stress,
            read(two_columns, two_rows).fitted[0].stress);
  unsetenv("FINGERTIP_TEST_DATA");
}

TEST_F(MaterialFiles, SumsOfSquaresThatOthersPublished) {
  write_text(folder_ / "theirs.json", R"({"true": {"Yeoh 2": {"SSE": 2.5}, "bad": {"SSE": -1}}})");
  const auto with = [](const std::string& entries) {
    return two_columns + "[test.published]\npath = \"theirs.json\"\n" + entries;
  };
  const auto file = read(with("unit = \"kPa^2\"\nyeoh-2 = \"true/Yeoh 2/SSE\"\n"), two_rows);
  const auto& published = file.fitted.at(0).published;
  ASSERT_EQ(published.size(), 1u);
  EXPECT_NEAR(published.at("yeoh-2"), 2.5e6, 1e-6);
  expect_refused(with("yeoh-2 = \"true/Yeoh 2/SSE\"\n"), two_rows,
                 {"published.unit", "their unit"});
  expect_refused(with("unit = \"kPa\"\nyeoh-2 = \"true/Yeoh 2/SSE\"\n"), two_rows, {"kPa"});
  expect_refused(with("unit = \"Pa^2\"\nyeo-2 = \"true\"\n"), two_rows, {"must be a law"});
  expect_refused(with("unit = \"Pa^2\"\nyeoh-2 = \"true/Yeoh/SSE\"\n"), two_rows,
                 {"theirs.json", "Yeoh"});
  expect_refused(with("unit = \"Pa^2\"\nyeoh-2 = \"true/bad/SSE\"\n"), two_rows, {"not positive"});
}

}  // namespace
