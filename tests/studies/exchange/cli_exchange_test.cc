// The verb export, and LAMMPS after it.

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

using nlohmann::json;

TEST(ExportVerb, WritesWhatLammpsMarches) {
  const TemporaryFolder folder;
  const ProgramResult there =
      run_program(folder.path(),
                  {"export", "--format", "lammps", "--out", "run", "--set",
                   "lattice.model=published", "--set", "exchange.body=cube", "--set",
                   "exchange.cells=3", "--set", "exchange.steps=40", "--set", "exchange.every=20"});
  ASSERT_EQ(there.code, 0) << there.err;
  EXPECT_NE(there.out.find("64 masses"), std::string::npos) << there.out;
  const std::string lammps =
      "cd '" + (folder / "run").string() + "' && lmp -in lattice.in > words 2>&1";
  ASSERT_EQ(std::system(lammps.c_str()), 0) << read_text(folder / "run/words");
  const json census = json::parse(read_text(folder / "run/summary.json"));
  EXPECT_EQ(census["masses"], 64);
  const std::string dump = read_text(folder / "run/lattice.dump");
  for (const char* step : {"0", "20", "40"})
    EXPECT_NE(dump.find("ITEM: TIMESTEP\n" + std::string(step) + "\n"), dump.npos) << step;
}

TEST(ExportVerb, WhatLammpsCannotExpressIsRefusedWithPlaceAndRemedy) {
  const TemporaryFolder folder;
  const ProgramResult result =
      run_program(folder.path(), {"export", "--out", "run", "--set", "lattice.model=network"});
  EXPECT_EQ(result.code, 2);
  for (const char* told : {"--set lattice.model=network", "eight masses", "published"}) {
    EXPECT_NE(result.err.find(told), std::string::npos) << result.err;
  }
  EXPECT_TRUE(made_in(folder.path()).empty());
}
