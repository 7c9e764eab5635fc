// A case made of TOML alone: what is run, tabulated and judged is data.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/studies/workplace.h"

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
  const Workplace folder;
  std::filesystem::create_directories(folder / "13_mine");
  folder.put("13_mine/case.toml", new_case);
  folder.run("validate 13_mine --out one", {}, 4);
  folder.expect_files("one", {"spacings/fine", "spacings/coarse", "fit", "cubes", "report.html"});
  EXPECT_FALSE(folder.has("one/too_coarse"));
  EXPECT_FALSE(folder.has("one/as_fine")) << "comes to the press spacings/fine";

  // Judged by what the responses say.
  const auto force = [&](const std::string& name, double depth) {
    return folder.response("one/spacings/" + name).normal_force_at(depth);
  };
  double worst = 0.0;
  for (const double part : {1.0 / 6.0, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0})
    worst =
        std::max(worst, std::abs(force("coarse", part * 6e-4) / force("fine", part * 6e-4) - 1));
  const nlohmann::json summary = folder.json("one/summary.json"), criteria = summary["criteria"];
  ASSERT_EQ(criteria.size(), 3U);
  EXPECT_NEAR(criteria[0]["value"].get<double>(), worst, 1e-9);
  EXPECT_EQ(criteria[0]["passed"], true);
  EXPECT_EQ(criteria[1]["passed"], true);
  EXPECT_EQ(criteria[2]["passed"], false);
  EXPECT_EQ(summary["models"].size(), 1U) << "those without a series";
  const std::string table = folder.text("one/spacings.csv");
  EXPECT_TRUE(table.starts_with("name,spacing [m],indentation [m],relative_error\nfine,")) << table;

  // The run's own parameters are the case again, and nothing is computed twice.
  folder.run("validate --config one/parameters.toml --out two", {}, 4);
  EXPECT_TRUE(omits(folder.text("two/log.txt"), ": started\n"));
  EXPECT_EQ(folder.text("two/spacings.csv"), table);
}
