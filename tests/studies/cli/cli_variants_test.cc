// A study from its case file to its report, on lattices and a mesh coarse enough for a test.

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
  const TemporaryFolder folder;
  write_text(folder / "study.toml", small_study);
  const ProgramResult first =
      run_program(folder.path(), {"validate", "study.toml", "--out", "one"});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("hookean, R/5"), std::string::npos) << first.out;
  EXPECT_FALSE(fs::exists(folder / "one/calibration_hookean")) << "the core case's";
  EXPECT_FALSE(fs::exists(folder / "one/continuum/2")) << "one continuum for all";

  // The table says what the responses say.
  const auto reference = PressResponse::read_csv(folder / "one/continuum/1/response.csv");
  const auto lattice = PressResponse::read_csv(folder / "one/variants/hookean/R_5/response.csv");
  ASSERT_EQ(lattice.samples().size(), 2U);
  const std::string table = read_text(folder / "one/variants.csv");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 1 + 4 * 2);
  const json summary = json::parse(read_text(folder / "one/summary.json"));
  double worst = 0.0;
  for (const char* name : {"R_4", "R_5", "R_6"}) {
    const auto press =
        PressResponse::read_csv(folder / "one/variants/hookean" / name / "response.csv");
    for (std::size_t i = 0; i < 2; ++i)
      worst = std::max(
          worst,
          std::abs(press.samples()[i].normal_force / reference.samples()[i].normal_force - 1.0));
  }
  EXPECT_NEAR(summary["variants"]["series"][0]["worst_error"].get<double>(), worst, 1e-9);
  EXPECT_TRUE(summary["variants"]["series"][0]["order"].is_number());
  EXPECT_TRUE(summary["variants"]["series"][1]["order"].is_null());

  const std::string html = read_text(folder / "one/report.html");
  EXPECT_NE(html.find("<section id=\"variants\">"), std::string::npos);
  for (const char* other : {"control", "elasticity", "published", "not-run"})
    EXPECT_EQ(html.find("<section id=\"" + std::string(other) + "\">"), std::string::npos) << other;

  // Nothing is computed twice, and a criterion only judges.
  write_text(folder / "strict.toml", std::string(small_study) + impossible_criterion);
  const ProgramResult strict =
      run_program(folder.path(), {"validate", "strict.toml", "--out", "two"});
  EXPECT_EQ(strict.code, 4) << strict.err;
  EXPECT_EQ(read_text(folder / "two/log.txt").find(": started\n"), std::string::npos);
  EXPECT_EQ(read_text(folder / "two/variants.csv"), table);
  const ProgramResult again =
      run_program(folder.path(), {"validate", "--config", "two/parameters.toml", "--out", "three"});
  EXPECT_EQ(again.code, 4) << again.err;
  EXPECT_EQ(read_text(folder / "three/variants.csv"), table);
}

TEST(Study, BadVariantIsRefusedBeforeAnythingRuns) {
  const TemporaryFolder folder;
  write_text(folder / "study.toml",
             "[case]\ntitle = \"t\"\n[[case.variant]]\nname = \"soft\"\nset = { "
             "\"lattice.contact_stiffness\" = 0.0 }\n");
  const ProgramResult result = run_program(folder.path(), {"validate", "study.toml"});
  EXPECT_EQ(result.code, 2);
  EXPECT_NE(result.err.find("study.toml:3 (variant soft): lattice.contact_stiffness"),
            std::string::npos)
      << result.err;
  EXPECT_EQ(made_in(folder.path()), std::vector<std::string>{"study.toml"});
}
