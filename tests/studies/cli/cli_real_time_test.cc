// --real-time with the real program. What a machine is fast enough for is not asked here, only that
// whatever was chosen is told, kept and repeated.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "meshes/press/press_response.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using fingertip::meshes::PressResponse;
using nlohmann::json;

namespace {

std::vector<std::string> real_time_press(std::vector<std::string> more) {
  std::vector<std::string> words = {"press", "--real-time",
                                    "--set", "lattice.spacing=tip_radius/6",
                                    "--set", "press.depth=0.1 cm"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

json object_in(const fs::path& file) {
  return json::parse(read_text(file));
}

void put(const fs::path& file, const json& content) {
  std::ofstream(file) << content.dump(2);
}

/// Of a machine on which the coarsest lattice is too slow, as under a sanitizer or load.
bool too_slow(const ProgramResult& result) {
  return result.code == 3 && result.err.find("not even the coarsest lattice") != std::string::npos;
}

/// What a machine has chosen for real_time_press: R/4, scaled masses at 500 us.
json choice_for(const std::string& key) {
  return {{"asked", key + ", threads 0, any integrator"},
          {"spacing_asked", 0.01 / 6},
          {"spacing", 0.01 / 4},
          {"integrator", "mass-scaled"},
          {"step", 5e-4},
          {"threads", 1},
          {"expected_factor", 1.3125},
          {"tried", true},
          {"trials",
           {{{"spacing", 0.01 / 4}, {"step", 5e-4}, {"threads", 1}, {"real_time_factor", 1.3125}}}},
          {"force_error_of", ""}};
}

/// Whatever this machine would choose: a run that was ended after that choice.
void begin(const TemporaryFolder& folder) {
  // The press that is asked for, by the same name.
  ASSERT_EQ(run_program(folder.path(),
                        {"press", "--set", "lattice.spacing=tip_radius/6", "--set",
                         "press.depth=0.1 cm", "--set", "run.integrator=auto", "--out", "a"})
                .code,
            0);
  put(folder / "a/real_time.json", choice_for(object_in(folder / "a/finished.json")["key"]));
  fs::remove(folder / "a/finished.json");
}

}  // namespace

TEST(RealTime, AResumedRunKeepsTheChoice) {
  const TemporaryFolder folder;
  begin(folder);
  const json begun = object_in(folder / "a/real_time.json");
  const auto words = real_time_press({"--out", "a", "--resume", "auto"});
  const ProgramResult result = run_program(folder.path(), words);
  ASSERT_EQ(result.code, 0) << result.err;
  const json kept = object_in(folder / "a/real_time.json"),
             summary = object_in(folder / "a/summary.json");
  for (const char* chosen : {"asked", "spacing", "integrator", "step", "trials", "expected_factor"})
    EXPECT_EQ(kept[chosen], begun[chosen]) << chosen;
  EXPECT_EQ(summary["spacing"], 0.01 / 4);
  EXPECT_EQ(summary["step"]["step"], 5e-4);
  EXPECT_EQ(summary["real_time"], kept);
  EXPECT_EQ(kept["slowest_factor"], summary["slowest_real_time_factor"]);
  EXPECT_EQ(kept["whole_factor"], summary["real_time_factor"]);
  for (const char* told : {"2.5 mm (tip_radius/4)", "1.667 mm (tip_radius/6) was asked",
                           "mass-scaled", "500 us", "threads: 1", "1.31"})
    EXPECT_NE(result.err.find(told), std::string::npos) << told << ": " << result.err;
  EXPECT_NE(result.out.find("real-time factor"), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("force error"), std::string::npos) << result.out;
}

TEST(RealTime, TheReportTellsChoiceAndCost) {
  const TemporaryFolder folder;
  begin(folder);
  ASSERT_EQ(run_program(folder.path(), real_time_press({"--out", "a", "--resume", "auto"})).code,
            0);
  ASSERT_EQ(run_program(folder.path(), {"report", "a"}).code, 0);
  const std::string page = read_text(folder / "a/report.html");
  for (const char* told : {"Real time", "1.667 mm was asked for", "1.31", "lattice at rest"})
    EXPECT_NE(page.find(told), std::string::npos) << told;
}

TEST(RealTime, AnotherPressIsAnotherChoice) {
  const TemporaryFolder folder;
  begin(folder);
  const json begun = object_in(folder / "a/real_time.json");
  const ProgramResult anew = run_program(
      folder.path(),
      real_time_press({"--out", "a", "--resume", "auto", "--set", "press.contact=frictionless"}));
  if (too_slow(anew)) return;  // it was searched for
  EXPECT_EQ(anew.code, 0) << anew.err;
  EXPECT_NE(object_in(folder / "a/real_time.json")["trials"], begun["trials"]);
}

TEST(RealTime, ADamagedChoiceIsToldByItsWord) {
  const TemporaryFolder folder;
  begin(folder);
  json kept = object_in(folder / "a/real_time.json");
  kept["integrator"] = "guesswork";
  put(folder / "a/real_time.json", kept);
  const ProgramResult damaged =
      run_program(folder.path(), real_time_press({"--out", "a", "--resume", "auto"}));
  EXPECT_EQ(damaged.code, 2);
  EXPECT_NE(damaged.err.find("guesswork"), std::string::npos) << damaged.err;
}

TEST(RealTime, ItsParametersMakeTheSameResultAgain) {
  const TemporaryFolder folder;
  begin(folder);
  ASSERT_EQ(run_program(folder.path(), real_time_press({"--out", "a", "--resume", "auto"})).code,
            0);
  const ProgramResult again =
      run_program(folder.path(), {"press", "--config", "a/parameters.toml", "--out", "b"});
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(again.out.find("earlier run"), std::string::npos) << "times of here are not kept";
  for (const char* file : {"response.csv", "trace.csv", "boundary.csv"})
    EXPECT_EQ(read_text(folder / "a" / file), read_text(folder / "b" / file)) << file;
  // The machine's speed is no part of the result's identity.
  EXPECT_EQ(object_in(folder / "a/finished.json")["key"],
            object_in(folder / "b/finished.json")["key"]);
}

TEST(RealTime, ForceErrorsAreThoseOfTheRunsBelow) {
  const TemporaryFolder folder;
  begin(folder);
  ASSERT_EQ(run_program(folder.path(), real_time_press({"--out", "a", "--resume", "auto"})).code,
            0);
  const json kept = object_in(folder / "a/real_time.json");
  if (!kept.contains("force_error"))
    GTEST_SKIP() << "no continuum: " << kept["force_error_of"].get<std::string>();
  EXPECT_NE(kept["force_error_of"].get<std::string>().find("small strain"), std::string::npos);
  const auto continuum = PressResponse::read_csv(folder / "a/continuum/1/response.csv"),
             at_rest = PressResponse::read_csv(folder / "a/lattice/response.csv"),
             press = PressResponse::read_csv(folder / "a/response.csv");
  const json& errors = kept["force_error"];
  ASSERT_EQ(errors["models"].size(), 2u);
  for (const json& model : errors["models"]) {
    const PressResponse& forces = model["model"] == "this press" ? press : at_rest;
    for (std::size_t i = 0; i < errors["indentation"].size(); ++i) {
      const double depth = errors["indentation"][i];
      EXPECT_NEAR(model["error"][i].get<double>(),
                  forces.normal_force_at(std::min(depth, forces.depth())) /
                          continuum.normal_force_at(depth) -
                      1.0,
                  1e-9);
    }
  }
}

TEST(RealTime, TheSearchEndsWithALatticeOrAFigure) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program(folder.path(), real_time_press({"--out", "a"}));
  if (result.code == 3) {
    EXPECT_TRUE(too_slow(result)) << result.err;
    EXPECT_FALSE(fs::exists(folder / "a"));
    return;
  }
  ASSERT_EQ(result.code, 0) << result.err;
  const json kept = object_in(folder / "a/real_time.json");
  EXPECT_NEAR(kept["spacing_asked"].get<double>(), 0.01 / 6, 1e-15);
  EXPECT_GE(kept["spacing"].get<double>(), 0.01 / 6 * (1.0 - 1e-12));
  EXPECT_LE(kept["spacing"].get<double>(), 0.01 / 4 * (1.0 + 1e-12));
  EXPECT_GE(kept["expected_factor"].get<double>(), 1.25);
  EXPECT_FALSE(kept["trials"].empty());
}

TEST(RealTime, WhatNoMachineKeepsUpWithIsRefusedWithItsFigure) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program(
      folder.path(), real_time_press({"--set", "rubber.youngs_modulus=20 MPa", "--set",
                                      "rubber.shear_modulus=7 MPa", "--set",
                                      "run.integrator=symplectic-euler", "--out", "a"}));
  EXPECT_TRUE(too_slow(result)) << result.code << result.err;
  EXPECT_NE(result.err.find("a real-time factor of 0."), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(folder / "a"));
}

TEST(RealTime, AnEquilibriumHasNoTime) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(folder.path(), real_time_press({"--set", "press.mode=static"}));
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("press.mode"), std::string::npos) << result.err;
}

TEST(Threads, TheFastestNumberGivesTheBitsOfOne) {
  const TemporaryFolder folder;
  for (const char* threads : {"0", "1", "2"}) {
    const ProgramResult result =
        run_program(folder.path(), {"press", "--set", "lattice.spacing=tip_radius/12", "--set",
                                    "lattice.model=network", "--set", "run.integrator=mass-scaled",
                                    "--set", "run.time_step=1 ms", "--set", "press.depth=0.03 cm",
                                    "--threads", threads, "--out", threads});
    ASSERT_EQ(result.code, 0) << result.err;
    fs::remove_all(folder / "cache");
    for (const char* file : {"response.csv", "trace.csv", "boundary.csv"})
      EXPECT_EQ(read_text(folder / threads / file), read_text(folder / "0" / file)) << threads;
  }
  EXPECT_EQ(object_in(folder / "1/summary.json")["threads"], 1);
  EXPECT_EQ(object_in(folder / "2/summary.json")["threads"], 2) << "what is given is taken";
}
