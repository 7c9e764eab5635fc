// A study from its case file to its report, on lattices and a mesh coarse enough for a test.

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/studies/workplace.h"

using nlohmann::json;

namespace {

constexpr const char* small_study = R"(
[press]
contact = "frictionless"
samples = ["0.03 cm", "0.06 cm"]
[reference]
estimate_error = false
fields = false
[case]
title = "Small study"
x = "R/a"
variant = [
  { series = "hookean", name = "R/4", x = 4, set = { "lattice.spacing" = "tip_radius/4" } },
  { series = "hookean", name = "R/5", x = 5, set = { "lattice.spacing" = "tip_radius/5" } },
  { series = "hookean", name = "R/6", x = 6, set = { "lattice.spacing" = "tip_radius/6" } },
  { series = "again", name = "R/6", x = 6, set = { "lattice.spacing" = "tip_radius/6" } },
]
[[case.criteria]]
name = "all converge"
measure = "variants.not_converged"
limit = 0
)";

constexpr const char* impossible_criterion = R"(
[[case.criteria]]
name = "no error at all"
measure = "hookean.worst_error"
limit = 1e-9
)";

}  // namespace

TEST(Study, GoesFromVariantsToReport) {
  const Workplace folder;
  folder.put("study.toml", small_study);
  EXPECT_TRUE(says(folder.run("validate study.toml --out one").out, "R/5 (hookean)"));
  EXPECT_FALSE(folder.has("one/calibration_hookean")) << "the core case's";
  EXPECT_FALSE(folder.has("one/continuum/2")) << "one continuum for all";

  // The table says what the responses say.
  const auto reference = folder.response("one/continuum/1");
  const std::string table = folder.text("one/variants.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 4 * 2);
  double worst = 0.0;
  for (const std::string name : {"R_4", "R_5", "R_6"}) {
    const auto press = folder.response("one/variants/hookean/" + name);
    ASSERT_EQ(press.samples().size(), 2U);
    for (std::size_t i = 0; i < 2; ++i)
      worst = std::max(
          worst,
          std::abs(press.samples()[i].normal_force / reference.samples()[i].normal_force - 1.0));
  }
  const json series = folder.json("one/summary.json")["variants"]["series"];
  EXPECT_NEAR(series[0]["worst_error"].get<double>(), worst, 1e-9);
  EXPECT_TRUE(series[0]["order"].is_number());
  EXPECT_TRUE(series[1]["order"].is_null());

  const std::string html = folder.text("one/report.html");
  EXPECT_TRUE(says(html, "<section id=\"variants\">"));
  for (const std::string other : {"control", "elasticity", "published", "not-run"})
    EXPECT_TRUE(omits(html, "<section id=\"" + other + "\">"));

  // Nothing is computed twice, and a criterion only judges.
  folder.put("strict.toml", std::string(small_study) + impossible_criterion);
  folder.run("validate strict.toml --out two", {}, 4);
  EXPECT_TRUE(omits(folder.text("two/log.txt"), ": started\n"));
  EXPECT_EQ(folder.text("two/variants.csv"), table);
  folder.run("validate --config two/parameters.toml --out three", {}, 4);
  EXPECT_EQ(folder.text("three/variants.csv"), table);
}

TEST(Study, BadVariantIsRefusedBeforeAnythingRuns) {
  const Workplace folder;
  folder.put("study.toml",
             "[case]\ntitle = \"t\"\n[[case.variant]]\nname = \"soft\"\nset = { "
             "\"lattice.contact_stiffness\" = 0.0 }\n");
  folder.expect_refused("validate study.toml", {},
                        {"study.toml:3 (variant soft): lattice.contact_stiffness"});
}
