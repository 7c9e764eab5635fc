/// Material tests in time from files: what they become, and what is refused with which words.
#include "studies/measurements/timed_test.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/studies/measurements/material_files.h"

using namespace fingertip;
using namespace fingertip::studies;
using calibration::MaterialTest;
using calibration::TestCourse;
using calibration::TestKind;

namespace {

class TimedFiles : public MaterialFiles {};

const std::string relaxation_head =
    "[[test]]\nname = \"creep\"\nkind = \"relaxation\"\npath = \"data.csv\"\n"
    "time = {column = \"t\", unit = \"ms\"}\n"
    "stress = {column = \"s\", is = \"nominal\", unit = \"kPa\"}\n";
const std::string by_value = relaxation_head +
                             "strain = {value = 50, is = \"engineering\", "
                             "unit = \"%\"}\n";
const std::string by_column = relaxation_head + "strain = {column = \"l\", is = \"stretch\"}\n";
const std::string value_rows = "t,s\n100,7\n500,9\n1000,8\n2000,7.5\n";
const std::string column_rows = "t,l,s\n0,1,0\n100,1.2,5\n200,1.5,9\n1000,1.5,8\n2000,1.501,7\n";

TEST_F(TimedFiles, AStrainThatIsHeldAtOnceOrAfterARamp) {
  const MaterialTest sudden = read(by_value, value_rows).fitted.at(0);
  EXPECT_EQ(sudden.course, TestCourse::relaxation);
  EXPECT_EQ(sudden.kind, TestKind::uniaxial);
  ASSERT_EQ(sudden.time.size(), 4u);
  EXPECT_NEAR(sudden.time[1], 0.5, 1e-15);
  EXPECT_EQ(sudden.deformation[0], 1.5);
  EXPECT_NEAR(sudden.stress[3], 7500.0, 1e-9);
  EXPECT_EQ(sudden.path.held_from(1.0), 0.0);
  const MaterialTest ramped = read(by_value + "rate = \"1 1/s\"\n", value_rows).fitted.at(0);
  EXPECT_NEAR(ramped.path.held_from(1.0), 0.5, 1e-15);
  EXPECT_NEAR(ramped.deformation[0], 1.1, 1e-15);
  const MaterialTest held = read(by_value +
                                     "speed = \"10 mm/s\"\nlength = \"10 mm\"\n[data]\ntime = "
                                     "{column = 1, unit = \"s\"}\n",
                                 value_rows)
                                .fitted.at(0);
  EXPECT_NEAR(*held.rate, 1.0, 1e-12);
  std::string from_hold = by_value + "rate = \"1 1/s\"\n";
  from_hold.replace(from_hold.find("unit = \"ms\""), 11, "unit = \"ms\", from = \"hold\"");
  const MaterialTest later = read(from_hold, value_rows).fitted.at(0);
  EXPECT_NEAR(later.time[0], 0.6, 1e-15);
  EXPECT_EQ(later.deformation[0], 1.5);
}

TEST_F(TimedFiles, AStrainFromItsColumn) {
  const MaterialTest test = read(by_column, column_rows).fitted.at(0);
  EXPECT_EQ(test.path.time.size(), 5u);
  EXPECT_NEAR(test.path.held_from(1.0), 0.2, 1e-15);
  EXPECT_EQ(test.deformation[1], 1.2);
  const auto times = observed_times(test);
  EXPECT_NEAR(times[0], 0.8, 1e-12);  // the first stress after the ramp
  EXPECT_NEAR(times[1], 2.0, 1e-12);
}

/// A file of a ramp that begins with its second row begins at rest all the same; one that begins at
/// the hold, or far up the ramp, begins with a step.
TEST_F(TimedFiles, ARampWithoutItsFirstRowBeginsAtRest) {
  const auto path = [&](const std::string& first) {
    return read(by_column, "t,l,s\n" + first + "300,1.5,9\n1000,1.5,8\n2000,1.5,7\n")
        .fitted.at(0)
        .path;
  };
  const auto whole = path("0,1,0\n100,1.2,5\n200,1.4,7\n"), begun = path("100,1.2,5\n200,1.4,7\n");
  EXPECT_EQ(begun.time, whole.time);
  EXPECT_EQ(begun.deformation, whole.deformation);
  EXPECT_EQ(path("").deformation.front(), 1.5);
  EXPECT_EQ(path("200,1.4,7\n").deformation.front(), 1.4);
}

TEST_F(TimedFiles, CyclesOfShearKeepTheirSigns) {
  write_text(folder_ / "slow.csv", "u;F\n1;2\n3;5\n");
  const auto file = read(
      "[data]\nseparator = \"semicolon\"\ndecimal = \"comma\"\nlength = \"10 mm\"\n"
      "area = \"100 mm^2\"\nstress = {column = \"F\", is = \"force\", unit = \"N\"}\n"
      "strain = {column = \"u\", is = \"displacement\", unit = \"mm\"}\n"
      "[[test]]\nkind = \"cycles\"\ndeformation = \"simple-shear\"\n"
      "path = \"data.csv\"\nname = \"back and forth\"\ntime = {column = \"t\"}\n"
      "[[test]]\nkind = \"simple-shear\"\npath = \"slow.csv\"\nspeed = \"1 mm/s\"\n"
      "[[test]]\nname = \"slower\"\nkind = \"simple-shear\"\npath = \"slow.csv\"\n"
      "use = \"predict\"\n",
      "t;u;F\n0;0;0\n0,5;1;0,2\n1;-2;-0,3\n");
  const MaterialTest& test = file.fitted.at(0);
  EXPECT_EQ(test.course, TestCourse::cycles);
  EXPECT_EQ(test.kind, TestKind::simple_shear);
  EXPECT_EQ(test.time, (std::vector{0.0, 0.5, 1.0}));
  EXPECT_NEAR(test.deformation[2], -0.2, 1e-15);
  EXPECT_NEAR(test.stress[2], -3000.0, 1e-9);
  ASSERT_EQ(file.notes.size(), 2u);
  EXPECT_TRUE(says(file.notes[0], "slow: a relaxation counts at its rate, 0.1 1/s"));
  EXPECT_TRUE(says(file.notes[1], "slower: without speed or rate it counts as after long times"));
}

/// A strip that has crept is slack on the way back: 0 N is what the machine reads, no stress of the
/// rubber at that stretch, where a law that relaxes has -15 kPa.
TEST_F(TimedFiles, RowsOfASlackSpecimenAreLeftOut) {
  std::string description = by_column;
  description.replace(description.find("relaxation"), 10, "cycles");
  const std::string pulled = "t,l,s\n0,1,0\n1,1.2,6\n2,1.4,9\n3,1.3,4\n4,1.2,0.05\n";
  const auto file = read(description, pulled + "5,1.1,0\n6,1.0,0\n7,1.1,-0.02\n8,1.3,5\n");
  const MaterialTest& test = file.fitted.at(0);
  EXPECT_EQ(test.deformation, (std::vector{1.0, 1.2, 1.4, 1.3, 1.3}));
  EXPECT_EQ(test.stress.back(), 5e3);
  EXPECT_EQ(test.path.time.size(), 9u) << "the machine went on";
  ASSERT_EQ(file.notes.size(), 1u);
  EXPECT_EQ(file.notes[0],
            "data.csv: 4 rows without force between a pull and the next were left out: the "
            "specimen is slack there");
  // A curve that crosses zero is no plateau, and what is pressed as well is never slack.
  EXPECT_EQ(read(description, pulled + "5,1.2,6\n").fitted.at(0).time.size(), 6u);
  EXPECT_EQ(
      read(description, pulled + "5,1.1,0\n6,0.9,0\n7,1.1,0\n8,1.3,5\n").fitted.at(0).time.size(),
      9u);
}

TEST_F(TimedFiles, LongFilesAreThinnedAndSaySo) {
  std::string hold = "t,s\n", cycles = "t,l,s\n";
  for (int i = 1; i <= 30000; ++i) {
    hold += std::to_string(i) + "," + std::to_string(1.0 + 1.0 / i) + "\n";
    cycles += std::to_string(i) + "," + std::to_string(1.2 + 0.1 * std::sin(0.01 * i)) + ",1\n";
  }
  const auto relaxation = read(by_value, hold);
  const auto& times = relaxation.fitted[0].time;
  EXPECT_LE(times.size(), 200u);
  EXPECT_GT(times.size(), 100u);
  EXPECT_EQ(times.front(), 0.001);
  EXPECT_EQ(times.back(), 30.0);
  EXPECT_LT(times[60] / times[0], 1e3);
  EXPECT_TRUE(says(relaxation.notes.at(1), "of 30000 rows"));
  std::string description = by_column;
  description.replace(description.find("relaxation"), 10, "cycles");
  const auto cycled = read(description, cycles);
  EXPECT_EQ(cycled.fitted[0].time.size(), 1000u);
  EXPECT_LE(cycled.fitted[0].path.time.size(), 10001u);
  EXPECT_EQ(cycled.fitted[0].path.time.front(), 0.001);
  EXPECT_EQ(cycled.fitted[0].path.time.back(), 30.0);
  EXPECT_EQ(cycled.notes.size(), 2u);
}

TEST_F(TimedFiles, RefusalsNameFileLineKeyAndRemedy) {
  const std::string file = (folder_ / "tests.toml").string(),
                    data = (folder_ / "data.csv").string();
  expect_refused(by_column, "t,l,s\n0,1,0\n100,1.5,5\n100,1.5,5\n900,1.5,4\n",
                 {data + ":4", "0.1 s after 0.1 s", "times must increase", "rows = [first, last]"});
  expect_refused(relaxation_head, value_rows,
                 {file, "test[1].strain", "a test needs it", "strain = {value = 0.5"});
  expect_refused(by_value + "rate = \"0.4 1/s\"\n", value_rows,
                 {"held for 0.75 s after a ramp of 1.25 s", "at least as long as its ramp",
                  "kind = \"cycles\""});
  expect_refused(by_column, "t,l,s\n0,1,0\n100,1.2,5\n200,1.5,9\n", {"the strain is held for 0 s"});
  expect_refused(by_column, "t,s\n0,1\n1,1\n", {"data.csv", "the column 'l' is missing"});
  expect_refused(by_value, "t,s\n-5,1\n1,1\n", {"not negative", "from = \"hold\""});
  expect_refused(by_value, "t,s\n5,1\n,1\n6,\n", {"fewer than two rows"});
  std::string text = by_value;
  expect_refused(text.replace(text.find("unit = \"ms\""), 11, "unit = \"mm\""), value_rows,
                 {"test[1].time.unit", "is a length"});
  text = by_value;
  expect_refused(text.replace(text.find("time ="), 6, "clock ="), value_rows,
                 {"clock", "no such key", "time"});
  text = by_column;
  expect_refused(text.replace(text.find("unit = \"ms\""), 11, "from = \"hold\""), column_rows,
                 {"time.from", "tells when it is held"});
  expect_refused(by_value + "deformation = \"volumetric\"\n", value_rows,
                 {"test[1].deformation = volumetric", "uniaxial, equibiaxial, planar"});
  expect_refused(by_value + "range = [0, 1]\n", value_rows, {"test[1].range", "without times"});
  expect_refused(by_value + "rate = \"1 1/s\"\nspeed = \"1 mm/s\"\nlength = \"1 mm\"\n", value_rows,
                 {"speed tells the rate"});
  text = by_column;
  expect_refused(text.replace(text.find("column = \"l\""), 12, "column = \"l\", value = 1.5"),
                 column_rows, {"a column or a value"});
  text = by_value;
  expect_refused(text.replace(text.find("value = 50"), 10, "value = 0"), value_rows,
                 {"never deformed"});
  text = by_value;
  expect_refused(text.replace(text.find("value = 50"), 10, "value = -150"), value_rows,
                 {"a stretch is positive"});
  text = by_value;
  expect_refused(text.replace(text.find("\"data.csv\""), 10, "[\"data.csv\", \"data.csv\"]"),
                 value_rows, {"not averaged", "a [[test]] of its own"});
  text = by_column;
  expect_refused(text.replace(text.find("relaxation"), 10, "uniaxial"), column_rows,
                 {"test[1].time", "of the kinds relaxation and cycles"});
  text = by_column;
  expect_refused(text.replace(text.find("relaxation"), 10, "relaxing"), column_rows,
                 {"test[1].kind = relaxing", "volumetric, relaxation, cycles"});
}

}  // namespace
