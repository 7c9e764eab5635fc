#include "studies/config/shapes/profile_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "meshes/base/errors.h"
#include "tests/studies/loaded.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

const std::string solid_finger =
    "r [mm],z [mm],surface,curve\n"
    "12.5,0,contact,\n"
    "12.5,12.5,contact,arc 0 12.5\n"
    "0,25,axis,\n"
    "0,0,bond,\n";

std::string with(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

/// What the loader says of a configuration with this meridian; empty when it is fine.
std::string refusal_of(const std::string& profile) {
  const TemporaryFolder folder;
  write_text(folder / "finger.csv", profile);
  write_text(
      folder / "case.toml",
      "[geometry]\nshape = \"profile\"\nprofile = \"finger.csv\"\n[press]\ndepth = \"1 mm\"\n");
  return config_refusal([&] { config_in(folder / "case.toml"); });
}

void expect_refused(const std::string& profile, const std::vector<std::string>& parts) {
  EXPECT_TRUE(says(refusal_of(profile), parts));
}

TEST(ProfileFile, TakesAnyUnitOfLength) {
  const TemporaryFolder folder;
  write_text(folder / "mm.csv", solid_finger);
  write_text(folder / "cm.csv",
             "curve,surface,z [m],r [cm]\n,contact,0,1.25\narc 1e-99 0.0125,contact,0.0125,1.25\n"
             ",axis,0.025,0\n,bond,0,0\n");
  const auto mm = read_profile(folder / "mm.csv"), cm = read_profile(folder / "cm.csv");
  ASSERT_EQ(mm.size(), 4u);
  ASSERT_EQ(cm.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(mm[i].r, cm[i].r, 1e-15);
    EXPECT_NEAR(mm[i].z, cm[i].z, 1e-15);
    EXPECT_EQ(mm[i].surface, cm[i].surface);
    EXPECT_EQ(mm[i].curve, cm[i].curve);
  }
  EXPECT_NEAR(mm[1].centre_z, 0.0125, 1e-15);
}

TEST(ProfileFile, TakesWhatSpreadsheetsSeparateBy) {
  const TemporaryFolder folder;
  write_text(folder / "commas.csv", solid_finger);
  std::string decimals;  // decimal commas
  for (const char c : solid_finger) decimals += c == ',' ? ';' : c == '.' ? ',' : c;
  write_text(folder / "semicolons.csv", "\xEF\xBB\xBF" + decimals.substr(0, decimals.size() - 1));
  std::ranges::replace(decimals, ';', '\t');
  write_text(folder / "tabs.csv", decimals);
  const auto commas = read_profile(folder / "commas.csv");
  ASSERT_EQ(commas.size(), 4u);
  for (const char* other : {"semicolons.csv", "tabs.csv"}) {
    const auto corners = read_profile(folder / other);
    ASSERT_EQ(corners.size(), 4u) << other;
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(corners[i].r, commas[i].r) << other;
      EXPECT_EQ(corners[i].z, commas[i].z) << other;
      EXPECT_EQ(corners[i].surface, commas[i].surface) << other;
      EXPECT_EQ(corners[i].centre_z, commas[i].centre_z) << other;
    }
  }
}

TEST(ProfileFile, SaysHowCellsAreSeparated) {
  // A decimal comma among commas, a comma between the numbers of an arc, blanks between names.
  expect_refused(
      with(solid_finger, "12.5,0,contact", "12,5,0,contact"),
      {"finger.csv:2", "5 cells", "commas, semicolons or tabs", "decimals have a point"});
  expect_refused(with(solid_finger, "12.5,0,contact", "\"12,5\",0,contact"),
                 {"finger.csv:2, r [mm]: 12,5", "decimals have a point"});
  expect_refused(with(solid_finger, "arc 0 12.5", "\"arc 0,12.5\""),
                 {"finger.csv:3", "a blank between"});
  expect_refused(with(solid_finger, "r [mm],z [mm],surface,curve", "r [mm] z [mm] surface curve"),
                 {"finger.csv:2: 4 cells", "names (1)", "commas, semicolons or tabs"});
}

TEST(ProfileFile, MakesTheFingerOfAConfiguration) {
  const TemporaryFolder folder;
  write_text(folder / "finger.csv", solid_finger);
  write_text(folder / "case.toml",
             "[geometry]\nshape = \"profile\"\nprofile = \"finger.csv\"\nendpoint = \"-1 mm\"\n"
             "[lattice]\nspacing = \"tip_radius/12\"\n");
  const Config config = config_in(folder / "case.toml").config;
  EXPECT_NEAR(config.press.geometry.tip_radius, 0.0125, 1e-15);
  EXPECT_NEAR(config.press.geometry.rod_endpoint().z(), -0.001, 1e-15);
  EXPECT_NEAR(config.press.lattice.spacing, 0.0125 / 12, 1e-15);
  EXPECT_EQ(config.continuum().geometry.profile.size(), 4u);
}

TEST(ProfileFile, RefusesWithPlaceAndRemedy) {
  expect_refused("", {"finger.csv"});
  expect_refused(with(solid_finger, "r [mm]", "r"),
                 {"finger.csv:1", "r [mm],z [mm],surface,curve", "semicolons"});
  expect_refused(with(solid_finger, "z [mm]", "z [kg]"), {"finger.csv", "z [kg]"});
  expect_refused(with(solid_finger, "[mm],z [mm]", "[m],z [m]"), {"check the unit"});
  expect_refused(with(solid_finger, "0,25,axis", "0,25,axle"), {"finger.csv:4", "axle", "axis"});
  expect_refused(with(solid_finger, "arc 0 12.5", "arc 12.5"), {"finger.csv:3", "arc R C"});
  expect_refused(with(solid_finger, "arc 0 12.5", "bow"), {"finger.csv:3", "bow"});
  expect_refused(with(solid_finger, "arc 0 12.5", "arc 0 11"), {"corner 2", "equally far"});
  expect_refused(with(solid_finger, "0,0,bond", "1,0,bond"), {"corner 3", "axis"});
  expect_refused(with(solid_finger, "bond", "free"), {"name at least one piece bond"});
  expect_refused("r [mm],z [mm],surface,curve\n0,0,axis,\n0,9,contact,\n5,0,bond,\n3,12,free,\n",
                 {"cross or touch itself"});
  EXPECT_EQ(refusal_of(solid_finger), "");
}

}  // namespace
