// The verbs export and import, with LAMMPS in between.

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

using nlohmann::json;

TEST(ExchangeVerbs, ThereAndBack) {
  const TemporaryFolder folder;
  const ProgramResult there =
      run_program(folder.path(),
                  {"export", "--format", "lammps", "--out", "run", "--set",
                   "lattice.model=published", "--set", "exchange.body=cube", "--set",
                   "exchange.cells=3", "--set", "exchange.steps=40", "--set", "exchange.every=20"});
  ASSERT_EQ(there.code, 0) << there.err;
  EXPECT_NE(there.out.find("64 masses"), std::string::npos) << there.out;
  const ProgramResult early = run_program(folder.path(), {"import", "run"});
  EXPECT_EQ(early.code, 2) << early.out;
  const std::string lammps =
      "cd '" + (folder / "run").string() + "' && lmp -in lattice.in > words 2>&1";
  ASSERT_EQ(std::system(lammps.c_str()), 0) << read_text(folder / "run/words");
  const ProgramResult back = run_program(folder.path(), {"import", "--compare", "--frames", "run"});
  ASSERT_EQ(back.code, 0) << back.err;
  const json result = json::parse(read_text(folder / "run/import.json"));
  EXPECT_EQ(result["frames"], 3);
  EXPECT_LT(result["deviation"].get<double>(), 1e-9);
  EXPECT_GT(result["timing"]["ns_per_spring_step"].get<double>(), 0.0);
  EXPECT_TRUE(read_text(folder / "run/trajectory.csv").starts_with("time [s],centre_x [m],"));
  EXPECT_NE(read_text(folder / "run/frames/frames.pvd").find("frame_0002.vtu"), std::string::npos);
}

TEST(ExchangeVerbs, WhatLammpsCannotExpressIsRefusedWithPlaceAndRemedy) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(folder.path(), {"export", "--out", "run", "--set", "lattice.model=network"});
  EXPECT_EQ(result.code, 2);
  for (const char* told : {"--set lattice.model=network", "eight masses", "published"}) {
    EXPECT_NE(result.err.find(told), std::string::npos) << result.err;
  }
  EXPECT_EQ(run_program(folder.path(), {"import", "nowhere"}).code, 2);
  EXPECT_TRUE(made_in(folder.path()).empty());
}

namespace {

/// A quick continuum: small strain, coarse bars.
std::vector<std::string> law_export(const std::vector<std::string>& more) {
  std::vector<std::string> words = {"export",
                                    "--format",
                                    "pressure-law",
                                    "--out",
                                    "run",
                                    "--set",
                                    "reference.strain=linear",
                                    "--set",
                                    "reference.tolerance=0.02",
                                    "--set",
                                    "press.depth=2 mm"};
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

}  // namespace

TEST(ExchangeVerbs, APressureLawReproducesTheContinuumsForcesAndTellsWhereItDoesNot) {
  const TemporaryFolder folder;
  const ProgramResult made =
      run_program(folder.path(), law_export({"--set", "press.contact=frictionless"}));
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_NE(made.out.find("plane, fitted"), std::string::npos) << made.out;
  const json transfer = json::parse(read_text(folder / "run/transfer.json"));
  ASSERT_EQ(transfer["obstacles"].size(), 3U);
  EXPECT_TRUE(transfer["lost"].empty());
  const json& plane = transfer["obstacles"][0];
  EXPECT_TRUE(plane["fitted"].get<bool>());
  ASSERT_EQ(plane["depths"].size(), 5U);
  for (const json& depth : plane["depths"]) {
    EXPECT_LT(std::abs(depth["table_error"].get<double>()), 0.01);
    EXPECT_LT(std::abs(depth["power_error"].get<double>()), 0.1);
  }
  // A foundation takes a ball of half the relative radius for half as stiff, a half space for
  // 1/sqrt(2): at the least depth the truth is between.
  const json& ball = transfer["obstacles"][1];
  EXPECT_EQ(ball["obstacle"], "sphere of 10 mm");
  const double error = ball["depths"][0]["table_error"];
  EXPECT_LT(error, -0.1);
  EXPECT_GT(error, 1.0 / std::sqrt(2.0) - 1.0 - 0.02);
  const json law = json::parse(read_text(folder / "run/pressure_law.json"));
  EXPECT_GT(law["exponent"].get<double>(), 0.5);  // Hertz' on a half space
  EXPECT_NEAR(law["hydroelastic_modulus"].get<double>() / law["line"].get<double>(), 0.01, 1e-9);
  EXPECT_TRUE(read_text(folder / "run/pressure_table.csv").starts_with("penetration [m],pressure"));
  EXPECT_NE(read_text(folder / "run/README.md").find("Force error to expect"), std::string::npos);
}

TEST(ExchangeVerbs, WhatAPressureLawCannotSayIsRefusedUnlessAskedFor) {
  const TemporaryFolder folder;
  const ProgramResult sticks = run_program(folder.path(), law_export({}));
  EXPECT_EQ(sticks.code, 2);
  EXPECT_NE(sticks.err.find("press.contact"), std::string::npos) << sticks.err;
  EXPECT_NE(sticks.err.find("--lossy"), std::string::npos) << sticks.err;
  const ProgramResult tilted =
      run_program(folder.path(), law_export({"--lossy", "--set", "press.tilt=0.1 rad"}));
  EXPECT_EQ(tilted.code, 2);
  EXPECT_NE(tilted.err.find("press.tilt"), std::string::npos) << tilted.err;
  EXPECT_TRUE(made_in(folder.path()).empty());
  ASSERT_EQ(run_program(folder.path(), law_export({"--lossy"})).code, 0);
  const json transfer = json::parse(read_text(folder / "run/transfer.json"));
  ASSERT_EQ(transfer["lost"].size(), 1U);
  EXPECT_NE(transfer["lost"][0].get<std::string>().find("press.contact"), std::string::npos);
}
