// The files from which a report draws a pressed finger, of presses at rest.

#include <gtest/gtest.h>

#include "meshes/tables/table_rows.h"
#include "studies/files/run_tables.h"
#include "tests/studies/workplace.h"

namespace meshes = fingertip::meshes;
namespace studies = fingertip::studies;
using nlohmann::json;

namespace {

const Words shape_files = {"boundary.csv", "boundary_springs.csv", "snapshots.csv",
                           "snapshot_points.csv"};

ProgramResult press_at_rest(const Workplace& folder, const std::string& out) {
  return folder.run("press --out " + out, {"press.mode=static", "lattice.spacing=tip_radius/5",
                                           "press.samples=[\"0.05 cm\", \"0.1 cm\"]"});
}

const std::string drawn = "<section id=\"snapshots\">";

}  // namespace

TEST(SnapshotFiles, AtTheEndOfAStaticPressTheTipTouchesThePlane) {
  const Workplace folder;
  press_at_rest(folder, "run");
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
  const Workplace folder;
  press_at_rest(folder, "one");
  EXPECT_TRUE(says(press_at_rest(folder, "two").out, "earlier run"));
  const json files = folder.json("one/finished.json")["files"];
  for (const std::string& file : shape_files) {
    EXPECT_TRUE(files.contains(file)) << file;
    EXPECT_EQ(folder.text("one/" + file), folder.text("two/" + file)) << file;
  }
  folder.run("report two");
  EXPECT_TRUE(says(folder.text("two/report.html"), drawn));
  EXPECT_TRUE(folder.has("two/figures/snapshots_1.svg"));
}

TEST(SnapshotFiles, AStaticPressIsReportedWithoutThem) {
  const Workplace folder;
  press_at_rest(folder, "old");
  json finished = folder.json("old/finished.json");
  for (const std::string& file : shape_files) {
    ASSERT_TRUE(std::filesystem::remove(folder / "old" / file));
    ASSERT_EQ(finished["files"].erase(file), 1U);
  }
  folder.put("old/finished.json", finished.dump());
  EXPECT_EQ(folder.run("report old").err, "");
  EXPECT_TRUE(omits(folder.text("old/report.html"), {drawn, "is missing"}));
}
