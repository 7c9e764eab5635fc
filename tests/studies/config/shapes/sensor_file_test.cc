#include "studies/config/shapes/sensor_file.h"

#include <gtest/gtest.h>

#include <numbers>
#include <string>
#include <vector>

#include "tests/studies/loaded.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

/// Of a configuration beside these taxels; `sensor` are further lines of its section.
std::string refusal_of(const std::string& taxels, const std::string& sensor = "") {
  const TemporaryFolder folder;
  write_text(folder / "skin.csv", taxels);
  write_text(folder / "case.toml", "[sensor]\ntaxels = \"skin.csv\"\n" + sensor);
  return config_refusal([&] { config_in(folder / "case.toml"); });
}

TEST(TaxelFile, HasPlacesInAnyUnitAndMaybeAreas) {
  const TemporaryFolder folder;
  write_text(folder / "skin.csv", "z [cm];x [mm];y [mm]\n1;0;0\n0,8;6;0\n");
  write_text(folder / "areas.csv", "x [mm],y [mm],z [mm],area [mm^2]\n0,0,10,2\n0,-6,8,0.5\n");
  const meshes::Geometry finger;
  meshes::TaxelSkin skin;
  lay_taxels({.file = folder / "skin.csv", .footprint = 2e-3}, finger, skin);
  ASSERT_EQ(skin.taxels.size(), 2u);
  EXPECT_EQ(skin.footprint, 2e-3);
  EXPECT_NEAR((skin.taxels[1].place - meshes::Vector3(6e-3, 0.0, 8e-3)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((skin.taxels[1].normal - meshes::Vector3(0.6, 0.0, 0.8)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(skin.taxels[0].area, std::numbers::pi * 1e-6, 1e-18);
  lay_taxels({.file = folder / "areas.csv"}, finger, skin);
  EXPECT_NEAR(skin.taxels[0].area, 2e-6, 1e-18);
  EXPECT_NEAR(skin.taxels[1].area, 0.5e-6, 1e-18);
  EXPECT_EQ(skin.footprint, 1e-3);  // a tenth of the radius
}

TEST(TaxelFile, IsRefusedLineByLine) {
  const std::string head = "x [mm],y [mm],z [mm]\n";
  EXPECT_EQ(refusal_of(head + "0,0,10\n"), "");
  // Both at once.
  EXPECT_TRUE(says(refusal_of(head + "0,0,10.3\n0,0,10\n0,0,5\n"),
                   {"skin.csv:2", "off the surface that may touch", "skin.csv:4", "in the bond"}));
  EXPECT_TRUE(says(refusal_of(head + "0,0,\n"), {"skin.csv:2", "x, y and z"}));
  EXPECT_TRUE(says(refusal_of(head), {"names no taxel"}));
  EXPECT_TRUE(says(refusal_of("x [mm],y [mm]\n0,0\n"), {"skin.csv:1", "column z"}));
  EXPECT_TRUE(says(refusal_of("x [mm],y [mm],z [s]\n0,0,1\n"), {"skin.csv:1", "z [s]"}));
  EXPECT_TRUE(says(refusal_of("x [mm],y [mm],z [mm],area [mm^2]\n0,0,10,-1\n"),
                   {"skin.csv:2", "positive area"}));
  EXPECT_TRUE(says(refusal_of(head + "0,0,10\n6,0,8\n0,0,10\n"),
                   {"skin.csv:4", "sensor.taxels", "the place of line 2", "a place of its own"}));
  const std::string areas = "x [mm],y [mm],z [mm],area [m^2]\n";
  EXPECT_TRUE(says(refusal_of(areas + "0,0,10,1e-6\n6,0,8,1\n"),
                   {"skin.csv:3", "sensor.taxels", "1 m^2", "part of the surface", "unit"}));
  EXPECT_EQ(refusal_of(areas + "0,0,10,1e-6\n6,0,8,1e-6\n"), "");
  EXPECT_TRUE(says(refusal_of(head + "0,0,10\n", "footprint = \"1 mm\"\ndepth = \"0.05 mm\"\n"),
                   {"sensor.depth = 0.05 mm", "a tenth of the footprint"}));
}

TEST(TaxelTable, LaysRings) {
  const Config config = load_config({{}, {"sensor.taxels={rings = 3, per_ring = 5}"}, {}}).config;
  EXPECT_EQ(config.press.hardware.skin.taxels.size(), 15u);
  EXPECT_EQ(config.press.hardware.skin.footprint, 1e-3);
  // The other number is the usual one.
  const auto taxels = [](const std::string& set) {
    return load_config({{}, {set}, {}}).config.press.hardware.skin.taxels.size();
  };
  EXPECT_EQ(taxels("sensor.taxels={rings = 3}"), 24u);
  EXPECT_EQ(taxels("sensor.taxels={per_ring = 6}"), 24u);
  EXPECT_EQ(taxels("sensor.taxels=none"), 0u);
  EXPECT_EQ(taxels("sensor.noise=1 Pa"), 0u);
}

TEST(TaxelTable, IsRefused) {
  const auto refusal = [](const std::string& value, const std::string& more = "sensor.rate=0 Hz") {
    return config_refusal([&] { load_config({{}, {"sensor.taxels=" + value, more}, {}}); });
  };
  EXPECT_TRUE(says(refusal("{rings = 34, per_ring = 5}"),
                   {"sensor.taxels", "beyond the surface that may touch", "fewer rings"}));
  EXPECT_EQ(refusal("{rings = 34, per_ring = 5}", "sensor.pitch=0.5 mm"), "");
  EXPECT_TRUE(says(refusal("{ring = 3}"), {"knows no ring", "rings"}));
  EXPECT_TRUE(says(refusal("{}"), {"must name something"}));
  EXPECT_TRUE(says(refusal("{rings = 0}"), {"rings must be a whole number from 1"}));
  EXPECT_TRUE(says(refusal("{rings = \"four\"}"), {"rings must be a whole number"}));
  EXPECT_TRUE(says(refusal("{rings = 1000, per_ring = 1000}"), {"at most 10000 taxels"}));
  EXPECT_TRUE(says(refusal("4"), {"path of a file"}));
  EXPECT_TRUE(says(refusal("no_such.csv"), {"sensor.taxels", "no_such.csv"}));
}

/// What a configuration with these markers says; `sensor` are further lines of its section.
std::string refusal_of_markers(const std::string& markers, const std::string& sensor = "") {
  const TemporaryFolder folder;
  write_text(folder / "dots.csv", markers);
  write_text(folder / "case.toml", "[sensor]\nmarkers = \"dots.csv\"\n" + sensor);
  return config_refusal([&] { config_in(folder / "case.toml"); });
}

TEST(MarkerFile, HasPlacesInAnyUnit) {
  const TemporaryFolder folder;
  write_text(folder / "dots.csv", "z [cm];x [mm];y [mm]\n1;0;0\n0,8;5;0\n-0,5;0;-7\n");
  const auto markers = lay_markers({.file = folder / "dots.csv"}, {});
  ASSERT_EQ(markers.size(), 3u);
  EXPECT_NEAR((markers[1] - meshes::Vector3(5e-3, 0.0, 8e-3)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((markers[2] - meshes::Vector3(0.0, -7e-3, -5e-3)).norm(), 0.0, 1e-15);
}

TEST(MarkerFile, IsRefusedLineByLine) {
  const std::string head = "x [mm],y [mm],z [mm]\n";
  EXPECT_EQ(refusal_of_markers(head + "0,0,10\n0,0,9\n"), "");
  // All at once.
  EXPECT_TRUE(says(refusal_of_markers(head + "0,0,11\n0,0,8\n0,0,4\n0,0,8.0005\n"),
                   {"dots.csv:2", "sensor.markers", "1 mm outside the finger", "(0, 0, 10) mm",
                    "dots.csv:4", "in the rod, 1 mm from the rubber", "dots.csv:5",
                    "the place of line 3", "every marker has a place of its own"}));
  EXPECT_TRUE(says(refusal_of_markers(head + "0,,8\n"), {"dots.csv:2", "a marker has x, y and z"}));
  EXPECT_TRUE(says(refusal_of_markers(head), {"names no marker"}));
  EXPECT_TRUE(says(refusal_of_markers("x [mm],y [mm],z\n0,0,8\n"), {"dots.csv:1", "column z"}));
}

TEST(MarkerGridKeys, LayAGrid) {
  const auto markers = [](const std::vector<std::string>& sets) {
    return load_config({{}, sets, {}}).config.press.protocol.markers.size();
  };
  EXPECT_EQ(markers({"sensor.markers=grid"}), 241u);  // a tenth of the radius apart
  EXPECT_LT(markers({"sensor.markers=grid", "sensor.marker_pitch=2 mm"}), 80u);
  EXPECT_EQ(markers({"sensor.markers=none"}), 0u);
  const LoadedConfig inert = load_config({{}, {"sensor.marker_pitch=2 mm"}, {}});
  ASSERT_EQ(inert.notes.size(), 1u);
  EXPECT_TRUE(says(inert.notes[0], {"sensor.marker_pitch", "no effect", "sensor.markers"}));
}

TEST(MarkerGridKeys, AreRefused) {
  const auto refusal = [](const std::string& more) {
    return config_refusal([&] { load_config({{}, {"sensor.markers=grid", more}, {}}); });
  };
  EXPECT_TRUE(says(refusal("sensor.marker_depth=6 mm"),
                   {"--set sensor.marker_depth=6 mm", "not as thick", "smaller depth"}));
  EXPECT_TRUE(says(refusal("sensor.marker_pitch=0.05 mm"),
                   {"sensor.marker_pitch = 0.05 mm", "at most 10000 markers"}));
  EXPECT_TRUE(says(config_refusal([] {
                     load_config({{}, {"sensor.markers=no_such.csv"}, {}});
                   }),
                   {"sensor.markers", "no_such.csv"}));
  // A word that is nearly one of the key's, and no file: both are said.
  EXPECT_TRUE(says(config_refusal([] {
                     load_config({{}, {"sensor.markers=gird"}, {}});
                   }),
                   {"sensor.markers", "none | grid | path of a file", "there is no file", "/gird",
                    "did you mean \"grid\"?"}));
}

}  // namespace
