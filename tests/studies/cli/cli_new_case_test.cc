// A case made of TOML alone: what is run, tabulated and judged is data.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meshes/press/press_response.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
using fingertip::meshes::PressResponse;
using nlohmann::json;

namespace {

constexpr const char* new_case = R"(
[press]
mode = "static"
samples = ["0.02 cm", "0.06 cm"]
depth = "0.06 cm"
[case]
title = "Two spacings"
run = [
  { verb = "press", series = "spacings", name = "fine", set = { "lattice.spacing" = "tip_radius/6" } },
  { verb = "press", series = "spacings", name = "coarse", beside = "spacings, fine", set = { "lattice.spacing" = "tip_radius/5" } },
  { verb = "press", name = "too coarse", when = "coarser", set = { "lattice.spacing" = "0.4 cm" } },
  { verb = "press", name = "as fine", set = { "lattice.spacing" = "tip_radius/6" } },
  { verb = "moduli", name = "fit", set = { "lattice.model" = "central" } },
  { verb = "cubes", name = "cubes" },
]
[[case.table]]
file = "spacings.csv"
series = "spacings"
columns = ["name", "spacing [m]", "indentation [m]", "relative_error"]
[[case.criteria]]
name = "spacings agree"
measure = "spacings, coarse.max_force_error"
limit = 0.5
[[case.criteria]]
name = "cubes are exact"
measure = "cubes.hookean_error"
limit = 1e-9
[[case.criteria]]
name = "they agree to round-off"
measure = "spacings, coarse.max_force_error"
limit = 1e-12
)";

}  // namespace

TEST(NewCase, RunsIsJudgedAndNeedsNoCode) {
  const TemporaryFolder folder;
  fs::create_directories(folder / "13_mine");
  write_text(folder / "13_mine/case.toml", new_case);
  const ProgramResult first = run_program(folder.path(), {"validate", "13_mine", "--out", "one"});
  EXPECT_EQ(first.code, 4) << first.err << first.out;
  for (const char* name : {"spacings/fine", "spacings/coarse", "fit", "cubes"})
    EXPECT_TRUE(fs::exists(folder / "one" / name)) << name;
  EXPECT_FALSE(fs::exists(folder / "one/too_coarse"));
  EXPECT_FALSE(fs::exists(folder / "one/as_fine")) << "comes to the press spacings/fine";
  EXPECT_TRUE(fs::exists(folder / "one/report.html"));

  // Judged by what the responses say.
  const auto force = [&](const std::string& name, double depth) {
    return PressResponse::read_csv(folder / "one/spacings" / name / "response.csv")
        .normal_force_at(depth);
  };
  double worst = 0.0;
  for (const double part : {1.0 / 6.0, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0})
    worst =
        std::max(worst, std::abs(force("coarse", part * 6e-4) / force("fine", part * 6e-4) - 1));
  const json summary = json::parse(read_text(folder / "one/summary.json"));
  ASSERT_EQ(summary["criteria"].size(), 3U);
  EXPECT_NEAR(summary["criteria"][0]["value"].get<double>(), worst, 1e-9);
  EXPECT_EQ(summary["criteria"][0]["passed"], true);
  EXPECT_EQ(summary["criteria"][1]["passed"], true);
  EXPECT_EQ(summary["criteria"][2]["passed"], false);
  EXPECT_EQ(summary["models"].size(), 1U) << "those without a series";
  const std::string table = read_text(folder / "one/spacings.csv");
  EXPECT_EQ(table.find("name,spacing [m],indentation [m],relative_error\nfine,"), 0U) << table;

  // The run's own parameters are the case again, and nothing is computed twice.
  const ProgramResult again =
      run_program(folder.path(), {"validate", "--config", "one/parameters.toml", "--out", "two"});
  EXPECT_EQ(again.code, 4) << again.err;
  EXPECT_EQ(read_text(folder / "two/log.txt").find(": started\n"), std::string::npos);
  EXPECT_EQ(read_text(folder / "two/spacings.csv"), table);
}
