// The files from which a report draws a pressed finger, of presses at rest.

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meshes/tables/table_rows.h"
#include "studies/files/run_tables.h"
#include "tests/studies/program.h"
#include "tests/temporary_folder.h"

namespace fs = std::filesystem;
namespace meshes = fingertip::meshes;
namespace studies = fingertip::studies;
using nlohmann::json;

namespace {

const std::vector<std::string> shape_files = {"boundary.csv", "boundary_springs.csv",
                                              "snapshots.csv", "snapshot_points.csv"};

ProgramResult press_at_rest(const fs::path& folder, const std::string& out) {
  return run_program(
      folder, {"press", "--set", "press.mode=static", "--set", "lattice.spacing=tip_radius/5",
               "--set", "press.samples=[\"0.05 cm\", \"0.1 cm\"]", "--out", out});
}

bool draws_snapshots(const fs::path& page) {
  return read_text(page).find("<section id=\"snapshots\">") != std::string::npos;
}

}  // namespace

TEST(SnapshotFiles, AtTheEndOfAStaticPressTheTipTouchesThePlane) {
  const TemporaryFolder folder;
  ASSERT_EQ(press_at_rest(folder.path(), "run").code, 0);
  const auto snapshots = meshes::read_rows<studies::SnapshotRow>(folder / "run/snapshots.csv");
  ASSERT_EQ(snapshots.size(), 3U);
  EXPECT_EQ(snapshots[0].moment, "first touch");
  EXPECT_EQ(snapshots[1].moment, "half depth");
  const studies::SnapshotRow& end = snapshots[2];
  EXPECT_EQ(end.moment, "end");
  EXPECT_EQ(end.indentation, 1e-3);
  // z points from the rod to the plane, which stands still while the rod comes nearer.
  EXPECT_EQ(end.plane, snapshots[0].plane);
  EXPECT_NEAR(end.endpoint.z() - snapshots[0].endpoint.z(), 1e-3, 1e-9);
  std::vector<double> lowest(3, -1.0);
  std::vector<int> held(3, 0);
  for (const auto& point :
       meshes::read_rows<studies::SnapshotPointRow>(folder / "run/snapshot_points.csv")) {
    lowest[point.snapshot] = std::max(lowest[point.snapshot], point.place.z());
    held[point.snapshot] += int(point.held);
  }
  for (const double z : lowest) EXPECT_NEAR(z, end.plane.z(), 0.05e-3);
  EXPECT_EQ(held[0], 0);
  EXPECT_GT(held[1], 0);
  EXPECT_GT(held[2], held[1]);
}

TEST(SnapshotFiles, OfAStaticPressComeFromTheCacheAndAreDrawn) {
  const TemporaryFolder folder;
  ASSERT_EQ(press_at_rest(folder.path(), "one").code, 0);
  const ProgramResult again = press_at_rest(folder.path(), "two");
  EXPECT_NE(again.out.find("earlier run"), std::string::npos) << again.out;
  const json files = json::parse(read_text(folder / "one/finished.json"))["files"];
  for (const std::string& file : shape_files) {
    EXPECT_TRUE(files.contains(file)) << file;
    EXPECT_EQ(read_text(folder / "one" / file), read_text(folder / "two" / file)) << file;
  }
  ASSERT_EQ(run_program(folder.path(), {"report", "two"}).code, 0);
  EXPECT_TRUE(draws_snapshots(folder / "two/report.html"));
  EXPECT_TRUE(fs::exists(folder / "two/figures/snapshots_1.svg"));
}

// Neither the files nor, in summary.json, the finger's measures.
TEST(SnapshotFiles, AStaticPressOfEarlierVersionsIsReportedWithoutThem) {
  const TemporaryFolder folder;
  ASSERT_EQ(press_at_rest(folder.path(), "old").code, 0);
  json finished = json::parse(read_text(folder / "old/finished.json"));
  for (const std::string& file : shape_files) {
    ASSERT_TRUE(fs::remove(folder / "old" / file));
    ASSERT_EQ(finished["files"].erase(file), 1U);
  }
  write_text(folder / "old/finished.json", finished.dump());
  json summary = json::parse(read_text(folder / "old/summary.json"));
  ASSERT_EQ(summary.erase("geometry"), 1U);
  write_text(folder / "old/summary.json", summary.dump());
  const ProgramResult report = run_program(folder.path(), {"report", "old"});
  EXPECT_EQ(report.code, 0) << report.err;
  EXPECT_EQ(report.err, "");
  EXPECT_FALSE(draws_snapshots(folder / "old/report.html"));
  EXPECT_EQ(read_text(folder / "old/report.html").find("is missing"), std::string::npos);
}
