// The whole of `bench` with its smallest plan: everything but the numbers is real.
#include "studies/bench/bench.h"
#include "meshes/tables/fields_json.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include "studies/files/places.h"
#include "studies/jobs/provenance.h"
#include "studies/report/report.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using nlohmann::ordered_json;
using studies::BenchPlan;

namespace {

bool kernels_are_built() {
  return ::access((studies::executable_folder() / "fingertip-kernels").c_str(), X_OK) == 0;
}

/// Runs the plan in `folder`/run and leaves bench.json there.
ordered_json bench_in(const TemporaryFolder& folder, const BenchPlan& plan) {
  const studies::LoadedConfig loaded = studies::load_config({});
  studies::RunFolder run({"bench", folder / "run", false, false, {}}, loaded);
  studies::Progress progress(studies::ProgressStyle::off);
  studies::Session session(run, progress, studies::Cache(folder / "cache"), 1);
  const ordered_json bench = studies::run_bench(session, loaded, plan);
  meshes::write_json_file(bench, folder / "run/bench.json");
  run.finish("finished", 0);
  return bench;
}

void expect_number_or_null(const ordered_json& value, const std::string& what) {
  EXPECT_TRUE(value.is_null() || (value.is_number() && value.get<double>() > 0.0)) << what;
}

/// The names and types others rely on.
void expect_contract(const ordered_json& bench) {
  ASSERT_TRUE(bench.at("kernels").is_array());
  for (const ordered_json& kernel : bench.at("kernels")) {
    EXPECT_TRUE(kernel.at("name").is_string());
    EXPECT_TRUE(kernel.at("isa").is_string());
    EXPECT_TRUE(kernel.at("precision") == "float64" || kernel.at("precision") == "float32");
    EXPECT_GE(kernel.at("threads").get<int>(), 1);
    EXPECT_GT(kernel.at("masses").get<double>(), 0.0);
    EXPECT_GT(kernel.at("ns_per_spring_step").get<double>(), 0.0) << kernel.dump();
  }
  for (const char* name : {"lammps_48_1t", "lammps_20_1t", "lammps_48_2t", "lammps_20_2t",
                           "threads_published", "threads_network"}) {
    expect_number_or_null(bench.at("ratios").at(name), name);
    EXPECT_EQ(bench.at("ratios").at(name).is_null(), bench.at("missing_ratios").contains(name));
  }
  for (const ordered_json& press : bench.at("press")) {
    for (const char* name : {"model", "kinematics", "contact", "mode"})
      EXPECT_TRUE(press.at(name).is_string()) << name;
    for (const char* name : {"speed", "spacing_over_R", "threads"})
      EXPECT_GT(press.at(name).get<double>(), 0.0) << name;
    expect_number_or_null(press.at("real_time_factor"), "real_time_factor");
    expect_number_or_null(press.at("worst_force_error"), "worst_force_error");
  }
  EXPECT_TRUE(bench.at("machine").at("cpu").is_string());
  EXPECT_TRUE(bench.at("date").is_string());
}

}  // namespace

TEST(Bench, TheSmallestRunKeepsTheContractAndMakesAPage) {
  const TemporaryFolder folder;
  const ordered_json bench = bench_in(folder, studies::smallest_plan());
  expect_contract(bench);
  EXPECT_EQ(bench.at("kernels").empty(), !kernels_are_built());
  ASSERT_EQ(bench.at("press").size(), 3u);
  const ordered_json &press = bench.at("press")[0], &scaled = bench.at("press")[1];
  EXPECT_EQ(press.at("integrator"), "symplectic-euler");
  EXPECT_EQ(scaled.at("integrator"), "mass-scaled");
  EXPECT_DOUBLE_EQ(scaled.at("time_step").get<double>(), 1e-3);
  EXPECT_LT(scaled.at("steps").get<int>(), press.at("steps").get<int>());
  EXPECT_GT(scaled.at("static_error").get<double>(), 0.0);
  EXPECT_EQ(scaled.at("static_error"), press.at("static_error"));
  const ordered_json& whole = bench.at("press")[2];
  EXPECT_EQ(scaled.at("parts"), 4);
  EXPECT_EQ(whole.at("parts"), 1);
  EXPECT_EQ(whole.at("particles"), scaled.at("particles"));
  EXPECT_EQ(press.at("model"), "network");
  EXPECT_EQ(press.at("kinematics"), "finite");
  EXPECT_EQ(press.at("mode"), "pid");
  EXPECT_DOUBLE_EQ(press.at("spacing_over_R").get<double>(), 0.25);
  EXPECT_TRUE(press.at("real_time_factor").is_number());
  EXPECT_TRUE(press.at("worst_force_error").is_number());
  studies::report::write_report(folder / "run");
  const std::string page = read_text(folder / "run/report.html");
  EXPECT_NE(page.find("Error against speed"), std::string::npos);
  EXPECT_NE(page.find("network"), std::string::npos);
  EXPECT_EQ(bench.at("parts").empty(), !kernels_are_built());
  for (const ordered_json& part : bench.at("parts"))
    EXPECT_GT(part.at("seconds").get<double>(), 0.0) << part;
  EXPECT_NE(studies::bench_text(bench).find("network"), std::string::npos);
}

TEST(Bench, WithoutTheWidestRegistersAndPeersTheRatiosAreNull) {
  const TemporaryFolder folder;
  BenchPlan plan = studies::smallest_plan();
  plan.widest = 2;
  plan.lammps = "a-program-that-is-not-there";
  plan.bullet = false;
  plan.presses.clear();
  const ordered_json bench = bench_in(folder, plan);
  expect_contract(bench);
  EXPECT_EQ(bench.at("machine").at("isa_measured"), "sse2");
  for (const auto& [name, value] : bench.at("ratios").items()) EXPECT_TRUE(value.is_null()) << name;
  for (const ordered_json& kernel : bench.at("kernels")) EXPECT_EQ(kernel.at("isa"), "sse2");
  EXPECT_TRUE(bench.at("peers").empty());
  EXPECT_TRUE(bench.at("parts").empty()) << "they take the widest registers there are";
  EXPECT_EQ(bench.at("missing_programs").at("lammps"),
            "a-program-that-is-not-there is not on the PATH (package lammps)");
}
