// The whole path from rubber to report, on meshes coarse enough for a test.

#include <gtest/gtest.h>

#include <csignal>

#include "tests/studies/workplace.h"

using nlohmann::json;

namespace {

/// Runs of every kind that the core case has; its own take minutes, and the continuum's
/// verification most of these. That a file without runs gets the core's is asserted by Cases.
constexpr const char* coarse_case = R"(
[lattice]
spacing = "tip_radius/6"
[press]
depth = "0.03 cm"
speed = "2 cm/s"
[reference]
refinement = 0.5
[case]
title = "Coarse"
run = [
  { verb = "reference", name = "reference" },
  { verb = "press", name = "published", beside = "reference", exhibit = true, set = { "lattice.model" = "published" } },
  { verb = "press", name = "central", beside = "reference", exhibit = true, set = { "lattice.model" = "central" } },
  { verb = "press", name = "hookean", beside = "reference" },
  { verb = "press", series = "equilibrium", name = "hookean", beside = "reference", set = { "press.mode" = "static" } },
  { verb = "press", series = "published_study", name = "spacing_base", varied = "spacing", beside = "reference", exhibit = true, set = { "lattice.model" = "published" } },
  { verb = "press", series = "published_study", name = "spacing_R5", varied = "spacing", when = "another", beside = "reference", exhibit = true, set = { "lattice.model" = "published", "lattice.spacing" = "tip_radius/5" } },
  { verb = "moduli", name = "calibration_hookean" },
  { verb = "cubes", name = "cubes" },
]
table = [
  { file = "published_study.csv", series = "published_study", columns = ["varied", "spacing [m]", "offset_x", "offset_y", "offset_z", "ligament_stiffness", "indentation [m]", "normal_force [N]", "relative_error"] },
  { file = "equilibrium_study.csv", series = "equilibrium", columns = ["model", "spacing [m]", "indentation [m]", "normal_force [N]", "relative_error"] },
]
[[case.criteria]]
name = "nu of hookean"
measure = "hookean.poissons_ratio_error"
limit = 1e-9
)";

constexpr const char* impossible_criterion = R"(
[[case.criteria]]
name = "central springs reach the bulk modulus"
measure = "central.bulk_modulus_error"
limit = 0.1
)";

}  // namespace

TEST(Validate, GoesFromRubberToReportAndComesFromTheCacheAfterwards) {
  const Workplace folder;
  folder.put("coarse.toml", coarse_case);
  EXPECT_TRUE(
      says(folder.run("validate coarse.toml --out one").out, {"hookean", "one/report.html"}));
  folder.expect_files("one",
                      {"report.html", "summary.json", "cubes.csv", "published_study.csv",
                       "equilibrium_study.csv", "parameters.toml", "reference/response.csv",
                       "reference/fields/press.pvd", "published/trace.csv", "central/response.csv",
                       "hookean/boundary.csv", "calibration_hookean/material.toml"});
  const json summary = folder.json("one/summary.json");
  EXPECT_EQ(summary["depths"].size(), 5U);
  for (const char* model : {"published", "central", "hookean"}) {
    const json& entry = summary["models"][model];
    for (const char* key : {"E_100", "E_110", "E_111", "G", "nu_100", "K", "real_time_factor"})
      EXPECT_TRUE(entry[key].is_number()) << model << " " << key;
    EXPECT_EQ(entry["force_error"].size(), 5U);
    EXPECT_EQ(entry["status"], "ok");
  }
  EXPECT_EQ(summary["criteria"][0]["passed"], true);

  folder.run("validate --config one/parameters.toml --out two");
  EXPECT_TRUE(omits(folder.text("two/log.txt"), ": started\n"));
  json again = folder.json("two/summary.json");
  again["case"] = summary["case"];
  EXPECT_EQ(again, summary);

  // Criteria only judge: nothing is computed anew, and 4 says that one has failed.
  folder.put("strict.toml", std::string(coarse_case) + impossible_criterion);
  folder.run("validate strict.toml --out three", {}, 4);
  EXPECT_TRUE(folder.has("three/report.html"));
  EXPECT_EQ(folder.json("three/manifest.json")["status"], "criteria failed");

  folder.run("report three");
  folder.run("compare one --out compared");
  EXPECT_TRUE(folder.has("compared/comparison.csv"));
}

/// Whole, it belongs to the core case and judges it; here it is stopped after its first part.
TEST(Validate, VerifiesTheContinuumAndKeepsWhatItHasWhenStopped) {
  const Workplace folder;
  folder.put("checks.toml",
             "[case]\ntitle = \"Checks\"\n"
             "run = [ { verb = \"verification\", name = \"verification\" } ]\n");
  Program program = folder.start("validate checks.toml --out run");
  folder.comes("run/verification/verification.json");
  program.send(SIGTERM);
  const ProgramResult stopped = program.wait();
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  const json checks = folder.json("run/verification/verification.json")["checks"];
  EXPECT_GT(checks.size(), 100U);
  for (const json& check : checks) EXPECT_EQ(check["passed"], true) << check;
}

TEST(Validate, ReferenceHasExactlyTheSamples) {
  const Workplace folder;
  folder.run("reference --out run",
             {"reference.refinement=0.5", "reference.estimate_error=false",
              "press.contact=frictionless", R"(press.samples=["0.01 cm", "0.04 cm"])"});
  const auto response = folder.response("run");
  ASSERT_EQ(response.samples().size(), 2U);
  EXPECT_EQ(response.samples()[0].indentation, 1e-4);
  EXPECT_EQ(response.samples()[1].indentation, 4e-4);
  EXPECT_TRUE(folder.has("run/fields/press.pvd"));
}
