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

/// Light masses that are shaken hard double every rounding: what is told then is no comparison.
TEST(ExchangeVerbs, MotionsThatPartAreNotAccepted) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_program(folder.path(),
                        with_settings({"export", "--format", "lammps", "--out", "run"},
                                      {"lattice.model=central", "lattice.kinematics=finite",
                                       "exchange.hold=free", "exchange.agitation=0.01",
                                       "exchange.steps=400", "lattice.spacing=tip_radius/6"}))
                .code,
            0);
  const std::string lammps =
      "cd '" + (folder / "run").string() + "' && lmp -in lattice.in > words 2>&1";
  ASSERT_EQ(std::system(lammps.c_str()), 0) << read_text(folder / "run/words");
  const ProgramResult back = run_program(folder.path(), {"import", "--compare", "--quiet", "run"});
  EXPECT_EQ(back.code, 4);
  EXPECT_NE(back.err.find("exchange.agitation"), std::string::npos) << back.err;
  const json result = json::parse(read_text(folder / "run/import.json"));
  EXPECT_GT(result["deviation"].get<double>(), 1e-3);
  EXPECT_EQ(run_program(folder.path(), {"import", "run"}).code, 0);  // nothing compared
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
