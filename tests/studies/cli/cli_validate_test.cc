// The whole path from rubber to report, on meshes coarse enough for a test.

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "meshes/press/press_response.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
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
  const TemporaryFolder folder;
  write_text(folder / "coarse.toml", coarse_case);
  const ProgramResult first =
      run_program(folder.path(), {"validate", "coarse.toml", "--out", "one"});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_NE(first.out.find("hookean"), std::string::npos);
  EXPECT_NE(first.out.find("one/report.html"), std::string::npos);
  for (const char* file :
       {"report.html", "summary.json", "cubes.csv", "published_study.csv", "equilibrium_study.csv",
        "parameters.toml", "reference/response.csv", "reference/fields/press.pvd",
        "published/trace.csv", "central/response.csv", "hookean/boundary.csv",
        "calibration_hookean/material.toml"}) {
    EXPECT_TRUE(fs::exists(folder / "one" / file)) << file;
  }
  const json summary = json::parse(read_text(folder / "one/summary.json"));
  EXPECT_EQ(summary["depths"].size(), 5U);
  for (const char* model : {"published", "central", "hookean"}) {
    const json& entry = summary["models"][model];
    for (const char* key : {"E_100", "E_110", "E_111", "G", "nu_100", "K", "real_time_factor"}) {
      EXPECT_TRUE(entry[key].is_number()) << model << " " << key;
    }
    EXPECT_EQ(entry["force_error"].size(), 5U);
    EXPECT_EQ(entry["status"], "ok");
  }
  EXPECT_EQ(summary["criteria"][0]["passed"], true);

  const ProgramResult second =
      run_program(folder.path(), {"validate", "--config", "one/parameters.toml", "--out", "two"});
  EXPECT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(read_text(folder / "two/log.txt").find(": started\n"), std::string::npos);
  json again = json::parse(read_text(folder / "two/summary.json"));
  again["case"] = summary["case"];
  EXPECT_EQ(again, summary);

  // Criteria only judge: nothing is computed anew, and 4 says that one has failed.
  write_text(folder / "strict.toml", std::string(coarse_case) + impossible_criterion);
  const ProgramResult strict =
      run_program(folder.path(), {"validate", "strict.toml", "--out", "three"});
  EXPECT_EQ(strict.code, 4) << strict.err;
  EXPECT_TRUE(fs::exists(folder / "three/report.html"));
  EXPECT_EQ(json::parse(read_text(folder / "three/manifest.json"))["status"], "criteria failed");

  EXPECT_EQ(run_program(folder.path(), {"report", "three"}).code, 0);
  EXPECT_EQ(run_program(folder.path(), {"compare", "one", "--out", "compared"}).code, 0);
  EXPECT_TRUE(fs::exists(folder / "compared/comparison.csv"));
}

/// Whole, it belongs to the core case and judges it; here it is stopped after its first part.
TEST(Validate, VerifiesTheContinuumAndKeepsWhatItHasWhenStopped) {
  const TemporaryFolder folder;
  write_text(folder / "checks.toml",
             "[case]\ntitle = \"Checks\"\n"
             "run = [ { verb = \"verification\", name = \"verification\" } ]\n");
  Program program(folder.path(), {"validate", "checks.toml", "--out", "run"});
  const fs::path file = folder / "run/verification/verification.json";
  for (int wait = 0; wait < 2000 && !fs::exists(file); ++wait)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  program.send(SIGTERM);
  const ProgramResult stopped = program.wait();
  EXPECT_EQ(stopped.code, 130) << stopped.err;
  const json checks = json::parse(read_text(file))["checks"];
  EXPECT_GT(checks.size(), 100U);
  for (const json& check : checks) EXPECT_EQ(check["passed"], true) << check;
}

TEST(Validate, ReferenceHasExactlyTheSamples) {
  const TemporaryFolder folder;
  const ProgramResult result = run_program(
      folder.path(), {"reference", "--out", "run", "--set", "reference.refinement=0.5", "--set",
                      "reference.estimate_error=false", "--set", "press.contact=frictionless",
                      "--set", "press.samples=[\"0.01 cm\", \"0.04 cm\"]"});
  ASSERT_EQ(result.code, 0) << result.err;
  const auto response = fingertip::meshes::PressResponse::read_csv(folder / "run/response.csv");
  ASSERT_EQ(response.samples().size(), 2U);
  EXPECT_EQ(response.samples()[0].indentation, 1e-4);
  EXPECT_EQ(response.samples()[1].indentation, 4e-4);
  EXPECT_TRUE(fs::exists(folder / "run/fields/press.pvd"));
}
