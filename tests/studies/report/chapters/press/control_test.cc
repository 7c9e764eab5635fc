// Chapters on presses under controllers, from traces whose numbers are known.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meshes/tables/csv_table.h"
#include "meshes/tables/fields_json.h"
#include "meshes/tables/table_rows.h"
#include "studies/report/chapters/press/press_chapters.h"
#include "studies/report/report.h"
#include "studies/report/results/moving_press.h"
#include "tests/expectations.h"
#include "tests/studies/report/page_check.h"
#include "tests/studies/report/synthetic_run.h"

namespace {

namespace fs = std::filesystem;
using namespace fingertip;
using namespace studies::report;
using nlohmann::json;
using report_testing::write_file;

lattice::TraceRow row(double force, double wanted, bool force_mode) {
  lattice::TraceRow row;
  row.normal_force = force;
  row.wanted_force = wanted;
  row.force_mode = force_mode;
  return row;
}

/// A sphere of points round the origin of radius 1 cm, 40 around and 20 up, joined along circles.
void write_sphere(const fs::path& folder) {
  std::string points = "x [m],y [m],z [m],deformed_x [m],deformed_y [m],deformed_z [m],anchored\n";
  std::string springs = "i,j\n", snapshots = "snapshot,x [m],y [m],z [m],held\n";
  for (int row = 1; row < 20; ++row) {
    for (int k = 0; k < 40; ++k) {
      const double polar = M_PI * row / 40.0, around = 2.0 * M_PI * k / 40.0;
      const std::string place =
          fmt::format("{},{},{}", 0.01 * std::sin(polar) * std::cos(around),
                      0.01 * std::sin(polar) * std::sin(around), 0.01 * std::cos(polar));
      points += place + "," + place + ",0\n";
      springs += fmt::format("{},{}\n", 40 * (row - 1) + k, 40 * (row - 1) + (k + 1) % 40);
      snapshots += "0," + place + (row == 1 ? ",1\n" : ",0\n");
    }
  }
  write_file(folder / "boundary.csv", points);
  write_file(folder / "boundary_springs.csv", springs);
  write_file(folder / "snapshot_points.csv", snapshots);
  write_file(folder / "snapshots.csv",
             "moment,time [s],indentation [m],endpoint_x [m],endpoint_y [m],endpoint_z [m],"
             "turn_x [rad],turn_y [rad],turn_z [rad],force_x [N],force_y [N],force_z [N],"
             "torque_x [N m],torque_y [N m],torque_z [N m],plane_x [m],plane_y [m],plane_z [m],"
             "normal_x,normal_y,normal_z\nend,0.3,0.002,0,0,-0.03,0,0,0,0,0,-0.0980665,0,"
             "0.000980665,0,0,0,0.01,0,0,-1\n");
}

void write_press(const fs::path& folder, double speed, bool force_control, int sectors = 1) {
  std::vector<lattice::TraceRow> trace;
  for (int i = 0; i <= 100; ++i) {
    const double force = 0.002 * i;
    trace.push_back(row(force, force_control ? 0.19 : meshes::unknown, force_control && i > 30));
    trace.back().time = 0.003 * i;
    trace.back().indentation = 1e-5 * i;
    trace.back().commanded_speed = speed;
    trace.back().speed = 1.004 * speed;
    trace.back().command_force = trace.back().plane_force = force;
  }
  fs::create_directories(folder);
  meshes::write_rows(trace, folder / "trace.csv");
  studies::PressSummary summary;
  summary.model = "hookean";
  summary.mode = "pid";
  summary.status = "finished";
  summary.geometry = {0.01, 0.005, 0.015, 0.03, ""};
  summary.first_touch_time = 0.1;
  summary.tracking.speed_deviation = 0.004;
  summary.tracking.speed_deviation_at_touch = 0.021;
  summary.tracking.tilt_deg = sectors == 1 ? 0.003 : meshes::unknown;
  summary.census.sectors = sectors;
  meshes::write_json_file(summary, folder / "summary.json");
}

fs::path write_run(const TemporaryFolder& folder) {
  const fs::path run = folder.path() / "run";
  json presses = json::array();
  for (const auto& [name, speed] : {std::pair{"1 cm/s", 0.01}, {"20 cm/s", 0.2}}) {
    write_press(run / "presses" / name, speed, false);
    presses.push_back({{"series", "s"},
                       {"name", name},
                       {"folder", std::string("presses/") + name},
                       {"continuum", ""},
                       {"beside", ""},
                       {"pictured", speed < 0.1},
                       {"status", "finished"}});
  }
  write_sphere(run / "presses" / "1 cm/s");
  write_press(run / "presses" / "force", 0.01, true);
  presses.push_back({{"series", ""},
                     {"name", "force"},
                     {"folder", "presses/force"},
                     {"continuum", ""},
                     {"beside", "s, 1 cm/s"},
                     {"change", 0.0012},
                     {"pictured", false},
                     {"status", "finished"}});
  write_file(run / "summary.json", json{{"case", "11"},
                                        {"title", "Control <1>"},
                                        {"description", ""},
                                        {"status", "ok"},
                                        {"criteria", json::array()},
                                        {"presses", presses}}
                                       .dump());
  return run;
}

}  // namespace

TEST(ControlReport, OvershootAndChangesOfModeAreThoseOfTheTrace) {
  const std::vector<lattice::TraceRow> trace{row(0.5, 0.1, false),  // approaching: no matter
                                             row(0.05, 0.1, true), row(0.104, 0.1, true),
                                             row(0.09, 0.1, true), row(0.0, meshes::unknown, false),
                                             row(0.1, 0.1, true)};
  EXPECT_NEAR(force_overshoot(trace), 0.04, 1e-12);
  EXPECT_EQ(mode_switches(trace), 3.0);
  EXPECT_TRUE(std::isnan(force_overshoot({row(0.5, meshes::unknown, false)})));
  EXPECT_TRUE(std::isnan(mode_switches({})));
}

TEST(ControlReport, ShowsSpeedsSideBySideSnapshotsAndForceControl) {
  const TemporaryFolder folder;
  const fs::path run = write_run(folder);
  studies::report::write_report(run);
  const std::string html = read_text(run / "report.html");
  EXPECT_EQ(report_testing::structure_faults(html), std::vector<std::string>());
  EXPECT_EQ(report_testing::outside_references(html), std::vector<std::string>());
  for (const char* chapter : {"control", "snapshots", "speed"})
    EXPECT_TRUE(says(html, fmt::format("<section id=\"{}\">", chapter))) << chapter;
  for (const char* figure : {"tracking", "force_control", "snapshots_1"})
    EXPECT_TRUE(fs::exists(run / "figures" / fmt::format("{}.svg", figure))) << figure;
  EXPECT_FALSE(fs::exists(run / "figures/snapshots_2.svg"));
  const std::string text = report_testing::visible_text(html);
  EXPECT_TRUE(says(text, "2.1 %"));   // at first touch
  EXPECT_TRUE(says(text, "+5.3 %"));  // 0.2 N where 0.19 N was wanted
  EXPECT_TRUE(says(text, "0.12 %"));  // the change against another press
  EXPECT_TRUE(says(text, "Control <1>"));
  const std::string svg = read_text(run / "figures/snapshots_1.svg");
  EXPECT_TRUE(says(svg, "2 mm deep, force 98.07 mN, torque 980.7 mN mm"));
}

/// Mirror planes hold the rod of a part: its tilt is neither drawn nor told as a result.
TEST(ControlReport, APartOfATipHasNoTilt) {
  const TemporaryFolder folder;
  const auto shown = [&](int sectors) {
    const fs::path press = folder.path() / std::to_string(sectors);
    write_press(press, 0.01, false, sectors);
    studies::report::write_report(press);
    return std::pair(report_testing::visible_text(read_text(press / "report.html")),
                     read_text(press / "figures/tracking.csv"));
  };
  const auto [of_part, drawn_of_part] = shown(4);
  EXPECT_TRUE(says(of_part, "With run.symmetry = false it may tilt"));
  EXPECT_TRUE(omits(drawn_of_part, "tilt"));
  const auto [of_whole, drawn_of_whole] = shown(1);
  EXPECT_TRUE(omits(of_whole, "run.symmetry"));
  EXPECT_TRUE(says(of_whole, "0.0030 degrees"));
  EXPECT_TRUE(says(drawn_of_whole, "tilt"));
}

TEST(ControlReport, SnapshotsHideTheBackOfTheTip) {
  const TemporaryFolder folder;
  const fs::path run = write_run(folder);
  studies::report::write_report(run);
  const meshes::CsvTable points = fingertip::meshes::read_csv(run / "figures/snapshots_1.csv");
  const auto series = points.texts("series");
  const auto drawn = std::ranges::count(series, "springs") / 3;
  // A normal at polar angle p, measured from the pole below, and azimuth f faces a viewer 14
  // degrees above the plane where cos f > tan 14 / tan p.
  double visible = 0.0;
  for (int row = 1; row < 20; ++row) {
    const double bound = std::tan(14.0 * M_PI / 180.0) / std::tan(M_PI * row / 40.0);
    if (bound < 1.0) visible += 40.0 * std::acos(bound) / M_PI;
  }
  // At either end of a row a spring may be left out or more.
  EXPECT_NEAR(double(drawn), visible - 19.0, 25.0);
  EXPECT_EQ(std::ranges::count(series, "held by the obstacle"), 40);
  EXPECT_EQ(std::ranges::count(series, "force"), 2);
  EXPECT_EQ(std::ranges::count(series, "torque"), 2);
}

/// A torque with a lever of 45 nm is what grid and solver leave; a pad of a tenth of its radius in
/// height is not overtowered by its force.
TEST(ControlReport, SnapshotsShowNoTorqueOfNoiseAndNoForceTallerThanAPad) {
  const TemporaryFolder folder;
  const fs::path press = folder.path() / "pad";
  write_press(press, 0.01, false);
  write_sphere(press);
  const auto replace = [&](const char* file, const std::string& old, const std::string& put) {
    std::string text = read_text(press / file);
    ASSERT_TRUE(says(text, old)) << file;
    write_file(press / file, text.replace(text.find(old), old.size(), put));
  };
  replace("snapshots.csv", "0.000980665", "4.4e-9");
  std::string pad = "x [m],y [m],z [m],deformed_x [m],deformed_y [m],deformed_z [m],anchored\n";
  for (int i = 0; i < 19 * 40; ++i) {
    const double x = 0.01 * std::cos(0.1 * i), y = 0.01 * std::sin(0.1 * i);
    const double z = i % 2 == 0 ? 0.009 : 0.01;
    pad += fmt::format("{0},{1},{2},{0},{1},{2},0\n", x, y, z);
  }
  write_file(press / "boundary.csv", pad);
  studies::report::write_report(press);
  EXPECT_TRUE(says(read_text(press / "figures/snapshots_1.svg"), "torque 0 "));
  const meshes::CsvTable points = meshes::read_csv(press / "figures/snapshots_1.csv");
  const auto series = points.texts("series");
  EXPECT_EQ(std::ranges::count(series, "torque"), 0);
  const auto arrow = std::ranges::find(series, "force") - series.begin();
  ASSERT_EQ(series.at(arrow + 1), "force");
  const auto y = points.numbers("");  // a picture's axes have no names
  EXPECT_NEAR(std::abs(y[arrow + 1] - y[arrow]), 1.2 * std::cos(14.0 * M_PI / 180.0), 0.01)
      << "mm: of the pad's 1 mm, seen from 14 degrees above";
}

TEST(ControlReport, AComparisonOfPressesInTimeShowsThemUnderControl) {
  const TemporaryFolder folder;
  const fs::path run = write_run(folder);
  std::vector<fs::path> runs;
  for (const char* name : {"1 cm/s", "20 cm/s"}) {
    runs.push_back(run / "presses" / name);
    std::string response =
        "indentation [m],normal_force [N],lateral_force_x [N],lateral_force_y [N],torque_x [N m],"
        "torque_y [N m],torque_z [N m],contact_radius [m],max_pressure [Pa],force_error [N],"
        "time [s],contact_area [m^2],mean_pressure [Pa]\n";
    for (const double depth : {0.001, 0.002})
      response += fmt::format("{},{},0,0,0,0,0,,,,0,,\n", depth, 100.0 * depth);
    write_file(runs.back() / "response.csv", response);
  }
  studies::report::write_comparison(runs, folder / "out");
  EXPECT_TRUE(says(read_text(folder / "out/comparison.html"), "<section id=\"control\">"));
  EXPECT_TRUE(fs::exists(folder / "out/figures/tracking.svg"));
}

TEST(ControlReport, APressAloneHasItsControlAndSnapshots) {
  const TemporaryFolder folder;
  const fs::path press = write_run(folder) / "presses/1 cm/s";
  studies::report::write_report(press);
  const std::string html = read_text(press / "report.html");
  for (const char* chapter : {"control", "snapshots"})
    EXPECT_TRUE(says(html, fmt::format("<section id=\"{}\">", chapter))) << chapter;
  EXPECT_TRUE(omits(html, "id=\"not-run\""));
  EXPECT_TRUE(says(report_testing::visible_text(html), "within 0.40 % of its set point"));
}

/// Where the section across the contact has a pressure [mm, kPa].
std::vector<std::pair<double, double>> section_of(const fs::path& press) {
  const auto table = meshes::read_csv(press / "figures/contact_section.csv");
  std::vector<std::pair<double, double>> points;
  for (const auto& row : table.rows)
    if (!row.back().empty()) points.emplace_back(std::stod(row[2]), std::stod(row[3]));
  return points;
}

TEST(ControlReport, APressAtRestHasSnapshotsWithoutTimes) {
  const TemporaryFolder folder;
  const fs::path press = folder.path() / "rest";
  write_press(press, 0.0, false);
  fs::remove(press / "trace.csv");
  write_sphere(press);
  studies::PressSummary summary;
  summary.model = "hookean";
  summary.mode = "static";
  summary.status = "finished";
  summary.geometry = {0.01, 0.005, 0.015, 0.03, ""};
  meshes::write_json_file(summary, press / "summary.json");
  auto snapshots = meshes::read_rows<studies::SnapshotRow>(press / "snapshots.csv");
  snapshots.front().time = meshes::unknown;
  meshes::write_rows(snapshots, press / "snapshots.csv");
  meshes::PressResponse response;
  for (const double depth : {1e-3, 2e-3}) {
    meshes::PressSample sample;
    sample.indentation = depth;
    sample.normal_force = 50.0 * depth;
    sample.max_pressure = 39.5e6 * depth / 2.0;
    sample.contact_radius = 2.0 * depth;
    response.append(sample);
  }
  response.write_csv(press / "response.csv");
  report_testing::write_contact_field(press, {1e-3, 2e-3});
  EXPECT_TRUE(studies::report::write_report(press).empty());
  const std::string html = read_text(press / "report.html");
  EXPECT_TRUE(says(html, "<section id=\"snapshots\">"));
  EXPECT_TRUE(omits(html, "<section id=\"control\">"));
  // The contact at full depth: 2 kPa in the middle, out to 4.69 mm.
  EXPECT_TRUE(says(html, "<section id=\"contact\">"));
  double highest = 0.0, widest = 0.0;
  for (const auto& [x, pressure] : section_of(press)) {
    highest = std::max(highest, pressure);
    widest = std::max(widest, x);
  }
  EXPECT_NEAR(highest, 2.0, 0.01);
  EXPECT_NEAR(widest, std::sqrt(1.1 * 2e-3 * 0.01) * 1e3, 0.1);
  EXPECT_TRUE(says(read_text(press / "figures/contact_maps.svg"), "data:image/png"));
  const std::string svg = read_text(press / "figures/snapshots_1.svg");
  EXPECT_TRUE(says(svg, "end"));
  EXPECT_TRUE(omits(svg, "nan"));
  fs::remove(press / "snapshots.csv");
  EXPECT_TRUE(studies::report::write_report(press).empty());
  EXPECT_TRUE(omits(read_text(press / "report.html"), "<section id=\"snapshots\">"));
}

TEST(IntegratorReport, ShowsCostAgainstErrorAndNoControl) {
  const TemporaryFolder folder;
  const fs::path run = folder.path() / "run";
  json presses = json::array();
  for (const auto& [name, evaluations, change] :
       {std::tuple{"1e-8", 9000, 0.0}, {"4 us", 500, 0.002}, {"2 us", 1000, 0.001}}) {
    const fs::path press = run / "presses" / name;
    write_press(press, 0.05, false);
    json summary = json::parse(read_text(press / "summary.json"));
    summary["mode"] = "quasi-static";
    summary["wall_time"] = 1e-4 * evaluations;
    summary["steps"] = {{"accepted", evaluations},
                        {"rejected", 3},
                        {"forced", 0},
                        {"force_evaluations", evaluations}};
    write_file(press / "summary.json", summary.dump());
    presses.push_back({{"series", change > 0.0 ? "symplectic-euler" : "runge-kutta"},
                       {"name", name},
                       {"folder", std::string("presses/") + name},
                       {"continuum", ""},
                       {"beside", change > 0.0 ? "runge-kutta, 1e-8" : ""},
                       {"pictured", false},
                       {"status", "finished"}});
    if (change > 0.0) presses.back()["change"] = change;
  }
  write_file(run / "summary.json", json{{"case", "10"},
                                        {"title", "I"},
                                        {"description", ""},
                                        {"status", "ok"},
                                        {"criteria", json::array()},
                                        {"presses", presses}}
                                       .dump());
  studies::report::write_report(run);
  const std::string html = read_text(run / "report.html");
  EXPECT_EQ(report_testing::structure_faults(html), std::vector<std::string>());
  EXPECT_TRUE(says(html, "<section id=\"integrators\">"));
  EXPECT_TRUE(omits(html, "<section id=\"control\">"));
  const meshes::CsvTable figure =
      fingertip::meshes::read_csv(run / "figures/cost_of_integrators.csv");
  EXPECT_EQ(figure.numbers("force evaluations of the press [1]"),
            (std::vector<double>{500.0, 1000.0}));
  EXPECT_TRUE(says(report_testing::visible_text(html),
                   "the force of symplectic-euler, 2 us comes closest, within 0.10 %"));
  EXPECT_TRUE(says(studies::report::verdict_text(run), "0.20 %"));
}
