/// Material tests from files of every layout, and what is refused with which words.
#include "studies/measurements/material_test_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

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
  ASSERT_EQ(test.deformation.size(), 11u);  // 2.9 mm steps back
  EXPECT_NEAR(test.deformation[0], 1.0 - 14.5 / 30.0, 1e-15);
  EXPECT_EQ(test.deformation.back(), 1.0);
  const double area = M_PI * 0.025 * 0.025;
  EXPECT_NEAR(test.stress[0], -650.0 / area, 1e-6);
  EXPECT_NEAR(*test.rate, 0.01 / 60.0 / 0.03, 1e-12);
  EXPECT_FALSE(file.stuck[0]);
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_TRUE(says(file.notes[0], "1 rows where the strain steps back"));
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
                 {"test[1].stress.unit", "1 mm"});
  expect_refused(with("stress = {column = 1, is = \"nominal\"}"), two_rows, {"needs its unit"});
  expect_refused(with("plates = \"stick\""), two_rows, {"plates hold a cylinder"});
  expect_refused(with("rows = [1, 9]"), two_rows, {"has 2 rows of data"});
  expect_refused(with("range = [3.0, 4.0]"), two_rows, {"fewer than two points"});
  expect_refused(with("speed = \"1 mm/s\""), two_rows, {"speed over length"});
  expect_refused(with("decimal = \"comma\"\nseparator = \"comma\""), two_rows, {"cannot separate"});
  expect_refused(with("strain = {column = 2, is = \"engineering\", sign = -1}"), two_rows,
                 {"must be positive, at most 20"});
  expect_refused("[data]\n", "", {"names no test"});
  expect_refused(with("use = \"predict\""), two_rows, {"at least one test is fitted"});
  expect_refused(two_columns, "1 2\n1 2 3\n", {"data.csv:2", "has 3 cells, the first row 2"});
  expect_refused(two_columns, "0 1\n1 2\n2 1.5\n3 1.2\n4 1.1\n", {"the curve turns back"});
  expect_refused("[[test]\n", "", {"tests.toml:1", "not valid TOML"});
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
