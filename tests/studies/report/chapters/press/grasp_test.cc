// The chapter on grasps, from time series whose numbers are known.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "meshes/tables/csv_table.h"
#include "meshes/tables/fields_json.h"
#include "studies/files/grasp_summary.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/report.h"
#include "studies/report/results/grasp_run.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using namespace studies::report;
using nlohmann::json;
using report_testing::write_file;

constexpr double limit = 0.05;  ///< m g/(2 mu) [N], mu = 0.5

/// A row of grasp.csv: all friction but a share `inward` is along the load.
std::string row(double time, const std::string& phase, double normal, double load, double slip) {
  return fmt::format("{},{},{},0,0,{},0.001,0,{},{}", time, phase, 1e-3 * time, 2e-3 * time, load,
                     slip) +
         fmt::format(",{0},{1},100,100,{0},{1},100,100,{2},{3},{2},{3}\n", normal, 0.5 * load,
                     0.5 * normal, 0.05 * normal);
}

void write_grasp(const fs::path& folder, double force, const std::string& fate, bool released) {
  std::string table =
      "time [s],phase,height [m],velocity [m/s],tilt [rad],finger_height [m],indentation [m],"
      "support_force [N],load [N],slip [m],normal_force_1 [N],tangential_force_1 [N],touching_1,"
      "sliding_1,normal_force_2 [N],tangential_force_2 [N],touching_2,sliding_2,"
      "point_friction_1 [N],inward_friction_1 [N],point_friction_2 [N],inward_friction_2 [N]\n";
  for (int i = 0; i < 20; ++i) table += row(0.01 * i, "load", force, 0.0025 * i, 0.0);
  if (fate == "held")
    for (int i = 20; i < 30; ++i) table += row(0.01 * i, "hold", force, 0.05, 1e-5);
  if (released)
    for (int i = 30; i < 60; ++i)
      table += row(0.01 * i, "release", force * (1.0 - 0.01 * (i - 30)), 0.05, 1e-5 * (i - 29));
  write_file(folder / "grasp.csv", table);
  studies::GraspSummary summary;
  summary.status = "finished";
  summary.fate = fate;
  summary.friction = 0.5;
  summary.lift_height = 3e-3;
  summary.wanted_force = force;
  summary.least_force = 0.051;
  summary.least_force_at_rest = limit;
  summary.momentum_defect = 1e-13;
  if (released || fate != "held") {
    summary.slip_force = released ? 0.0506 : force;
    summary.slip_ratio = 0.494;
    summary.sliding_ratio = 0.5;
  }
  meshes::write_json_file(summary, folder / "summary.json");
}

fs::path write_run(const TemporaryFolder& folder) {
  const fs::path run = folder.path() / "run";
  json grasps = json::array();
  for (const auto& [name, force, fate, released] : {std::tuple{"weak", 0.0505, "not lifted", false},
                                                    {"firm", 0.05202, "held", false},
                                                    {"released", 0.06, "held", true}}) {
    write_grasp(run / "grasps" / name, force, fate, released);
    grasps.push_back({{"series", "s"},
                      {"name", name},
                      {"folder", std::string("grasps/") + name},
                      {"status", "finished"}});
  }
  write_file(run / "summary.json", json{{"case", "12"},
                                        {"title", "Grasp <1>"},
                                        {"description", ""},
                                        {"status", "ok"},
                                        {"criteria", json::array()},
                                        {"grasps", grasps}}
                                       .dump());
  return run;
}

}  // namespace

TEST(GraspReport, ShowsFateReleaseFrictionAndTime) {
  const TemporaryFolder folder;
  const fs::path run = write_run(folder);
  studies::report::write_report(run);
  const std::string html = read_text(run / "report.html");
  EXPECT_EQ(report_testing::structure_faults(html), std::vector<std::string>());
  EXPECT_EQ(report_testing::outside_references(html), std::vector<std::string>());
  EXPECT_TRUE(says(html, "<section id=\"grasp\">"));
  EXPECT_TRUE(omits(html, "id=\"not-run\""));
  for (const char* figure : {"grasp_fate", "grasp_release", "grasp_friction", "grasp_in_time"})
    EXPECT_TRUE(fs::exists(run / "figures" / fmt::format("{}.svg", figure))) << figure;
  const std::string text = report_testing::visible_text(html);
  EXPECT_TRUE(says(text, "Grasp <1>"));
  // 52.02 against 51 mN holds, 50.5 does not; it slips 1.2 % above 50 mN.
  EXPECT_TRUE(says(
      text, {"is off the friction limit m (g + a)/(2 mu) by +2.0 %",
             "the strongest that does not by −0.98 %", "begins to slip at m g/(2 mu) +1.2 %"}));
  EXPECT_TRUE(says(studies::report::verdict_text(run), "s, weak"));
}

TEST(GraspReport, FigureOfReleaseIsGripAgainstSlip) {
  const TemporaryFolder folder;
  const fs::path run = write_run(folder);
  studies::report::write_report(run);
  const meshes::CsvTable figure = fingertip::meshes::read_csv(run / "figures/grasp_release.csv");
  const auto slip = figure.numbers("slip of the block along the fingers [mm]");
  const auto force = figure.numbers("grip force per finger [mN]");
  ASSERT_GE(slip.size(), 30u);
  EXPECT_NEAR(slip[0], 0.01, 1e-9);
  EXPECT_NEAR(force[0], 60.0, 1e-6);
  EXPECT_NEAR(force[10], 54.0, 1e-6);
  EXPECT_NEAR(force.back(), 1e3 * limit, 1e-6);  // the limit is the last curve
}

TEST(GraspReport, AGraspAloneHasItsPage) {
  const TemporaryFolder folder;
  const fs::path grasp = write_run(folder) / "grasps/released";
  studies::report::write_report(grasp);
  const std::string html = read_text(grasp / "report.html");
  EXPECT_TRUE(says(html, "<section id=\"grasp\">"));
  EXPECT_TRUE(omits(html, "id=\"not-run\""));
  EXPECT_TRUE(says(report_testing::visible_text(html), "The block was held. Where the grip falls"));
}

TEST(GraspReport, WithoutCoulombsFrictionThereIsNoLimit) {
  const TemporaryFolder folder;
  const fs::path grasp = folder.path() / "stick";
  write_grasp(grasp, 0.06, "held", false);
  json summary = json::parse(read_text(grasp / "summary.json"));
  for (const char* key : {"friction", "least_force", "least_force_at_rest"}) summary[key] = 0.0;
  write_file(grasp / "summary.json", summary.dump());
  studies::report::write_report(grasp);
  const std::string text = report_testing::visible_text(read_text(grasp / "report.html"));
  EXPECT_TRUE(says(text, "The block was held."));
  EXPECT_TRUE(omits(text, "inf"));
  EXPECT_TRUE(fs::exists(grasp / "figures/grasp_in_time.svg"));
  EXPECT_TRUE(omits(read_text(grasp / "figures/grasp_in_time.csv"), "m g/(2 mu)"));
}
