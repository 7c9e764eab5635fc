// Ready starts: each is written, and the command that it says next runs.

#include <sstream>

#include "tests/studies/workplace.h"

namespace {

/// Names that --list tells.
std::vector<std::string> names_in(const std::string& told) {
  std::vector<std::string> names;
  std::istringstream lines(told);
  for (std::string line; std::getline(lines, line) && !line.empty();)
    names.push_back(line.substr(0, line.find(' ')));
  return names;
}

}  // namespace

TEST(Init, EachStartRunsAsItSays) {
  const Workplace folder;
  const std::vector<std::string> names = names_in(folder.run("init --list", {}).out);
  EXPECT_GE(names.size(), 12U);
  for (const std::string& name : names) {
    const std::string said = folder.run("init " + name, {}).out;
    EXPECT_TRUE(says(said, {"written: " + name + ".toml", "next: fingertip ", name + ".toml"}))
        << said;
    const auto begin = said.find("next: fingertip ") + std::string("next: fingertip ").size();
    const std::string next = said.substr(begin, said.find('\n', begin) - begin);
    EXPECT_TRUE(omits(next, "studies/examples")) << next;
    const ProgramResult ran = folder.run(next + " --progress off --out runs_" + name, {});
    EXPECT_TRUE(says(ran.out, "run")) << name;
  }
}

TEST(Init, AStartReplacesNothingUnlessAsked) {
  const Workplace folder;
  folder.run("init my_press --out mine.toml", {});
  EXPECT_TRUE(folder.has("my_press.csv"));
  EXPECT_TRUE(says(folder.text("mine.toml"), "--config mine.toml"));
  EXPECT_TRUE(
      says(folder.run("init my_press --out mine.toml", {}, 2).err, "the file exists already"));
  folder.run("init my_press --force --out mine.toml", {});
  // A name with an extension is a file of all keys.
  folder.run("init my.toml", {});
  EXPECT_TRUE(says(folder.text("my.toml"), "youngs_modulus"));
}

TEST(Init, AMisspeltStartIsToldFromAFile) {
  const Workplace folder;
  EXPECT_TRUE(says(folder.run("init my_pres", {}, 2).err,
                   {"init my_pres: there is no such start; the nearest one is my_press",
                    "hollow_finger", "init my_pres.toml"}));
  EXPECT_FALSE(folder.has("my_pres"));
}

/// Files that a start's files name come along, wherever it goes.
TEST(Init, TestsOfCouponsRunFromAnyFolder) {
  const Workplace folder;
  EXPECT_TRUE(omits(folder.run("init --list", {}).out, "my_specimens"));
  folder.run("init my_tests --out coupons/mine.toml", {});
  for (const char* name :
       {"my_specimens.toml", "my_tension.csv", "my_compression.csv", "my_shear.csv"})
    EXPECT_TRUE(folder.has(std::string("coupons/") + name)) << name;
  folder.run("calibrate --config coupons/mine.toml --out laws", {});
  EXPECT_TRUE(says(folder.text("laws/material.toml"), "name = \"yeoh-2\""));
}
