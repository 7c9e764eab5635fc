#include "studies/measurements/displacement_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "meshes/base/errors.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using meshes::Vector3;
namespace fs = std::filesystem;

namespace {

const std::string table =
    "beads of a cube\n"
    "i,j,k,x0,y0,z0,x1,y1,z1\n"
    "1,1,1,0,0,0,1,0,0\n"
    "2,1,1,10,0,0,10,1,\n"
    "1,2,1,0,10,0,0,10,2\n"
    "1,1,2,2,2,-10,2,2,-10\n";
const std::string description =
    "path = \"table.csv\"\nskip = 1\nmiddle = [\"0 mm\", \"0 mm\", \"40 mm\"]\n"
    "[place]\nx = {column = \"x0\", unit = \"mm\"}\ny = {column = \"y0\", unit = \"mm\"}\n"
    "z = {column = \"z0\", unit = \"mm\", sign = -1}\n"
    "[grid]\ni = {column = \"i\"}\nj = {column = \"j\"}\nk = {column = \"k\", sign = -1}\n"
    "[[sample]]\nindentation = \"4 mm\"\nx = {column = \"x1\", unit = \"mm\"}\n"
    "y = {column = \"y1\", unit = \"mm\"}\nz = {column = \"z1\", unit = \"mm\", sign = -1}\n";

class Displacements : public testing::Test {
 protected:
  DisplacementFile read(const std::string& text, const std::string& name) {
    write_text(folder_ / name, text);
    return read_displacements(folder_ / name);
  }
  std::string refused(const std::string& text, const std::string& name) {
    try {
      read(text, name);
    } catch (const meshes::InvalidInput& error) {
      return error.what();
    }
    return "taken";
  }
  void near(const Vector3& found, const Vector3& wanted) {
    EXPECT_LT((found - wanted).norm(), 1e-12);
  }
  TemporaryFolder folder_;
};

}  // namespace

TEST_F(Displacements, OfADescribedTable) {
  write_text(folder_ / "table.csv", table);
  const DisplacementFile found = read(description, "beads.toml");
  EXPECT_TRUE(has_displacements(folder_ / "beads.toml"));
  ASSERT_EQ(found.places.size(), 4u);
  // Their middle, (3, 3, -2.5) of the file, lies at z = 40 mm of the finger, whose z is its -z.
  near(found.places[0], {-3e-3, -3e-3, 37.5e-3});
  near(found.places[3], {-1e-3, -1e-3, 47.5e-3});
  near(found.grid[3], {1, 1, -2});
  ASSERT_EQ(found.samples.size(), 1u);
  EXPECT_DOUBLE_EQ(found.samples[0].indentation, 4e-3);
  near(found.samples[0].displacement[0], {1e-3, 0, 0});
  near(found.samples[0].displacement[2], {0, 0, -2e-3});
  EXPECT_TRUE(std::isnan(found.samples[0].displacement[1].z()));  // an empty cell
}

TEST_F(Displacements, OfAPlainFile) {
  const std::string rows = "1,0,0,5,0,0,-1\n2,0,0,5,0,0,-2\n2,3,0,5,1,0,-2\n";
  const std::string head = "indentation [mm],x [mm],y [mm],z [mm],";
  const DisplacementFile found = read(
      head + "displacement_x [um],displacement_y [um],displacement_z [um]\n" + rows, "plain.csv");
  EXPECT_TRUE(has_displacements(folder_ / "plain.csv"));
  ASSERT_EQ(found.places.size(), 2u);
  ASSERT_EQ(found.samples.size(), 2u);
  near(found.samples[1].displacement[1], {1e-6, 0, -2e-6});
  EXPECT_TRUE(std::isnan(found.samples[0].displacement[1].x()));  // not seen at 1 mm
  const DisplacementFile moved =
      read(head + "moved_x [mm],moved_y [mm],moved_z [mm]\n" + rows, "moved.csv");
  near(moved.samples[1].displacement[1], {-2e-3, 0, -7e-3});
  write_text(folder_ / "press.csv", "indentation [mm],force [N]\n1,2\n2,5\n");
  EXPECT_FALSE(has_displacements(folder_ / "press.csv"));
}

TEST_F(Displacements, RefusesWithPlaceAndRemedy) {
  write_text(folder_ / "table.csv", table);
  const auto changed = [&](const std::string& what, const std::string& by) {
    std::string text = description;
    return text.replace(text.find(what), what.size(), by);
  };
  EXPECT_NE(refused(changed("\"x1\"", "\"x7\""), "a.toml").find("'x7' is missing"),
            std::string::npos);
  EXPECT_NE(refused(changed("[\"0 mm\", \"0 mm\", \"40 mm\"]", "[\"0 mm\"]"), "a.toml")
                .find("three lengths"),
            std::string::npos);
  EXPECT_NE(refused(changed("indentation = \"4 mm\"\n", ""), "a.toml").find("indentation"),
            std::string::npos);
  EXPECT_NE(refused(changed("x = {column = \"x0\", unit = \"mm\"}\n", ""), "a.toml").find("place"),
            std::string::npos);
  const std::string head = "indentation [mm],x [mm],y [mm],z [mm],";
  const std::string seen = "displacement_x [mm],displacement_y [mm],displacement_z [mm]\n";
  EXPECT_NE(refused(head + seen + "1,0,0,0,0,0,a\n2,0,0,0,0,0,0\n", "b.csv").find("number"),
            std::string::npos);
  EXPECT_NE(refused(head + seen + "1,0,0,0,0,0,1\n1,0,0,0,0,0,2\n", "b.csv").find("b.csv:3"),
            std::string::npos);
  EXPECT_NE(refused("indentation,x [mm],y [mm],z [mm]," + seen + "1,0,0,0,0,0,1\n", "b.csv")
                .find("indentation [mm]"),
            std::string::npos);
}

namespace {

/// Mean extent across the layer k of the Truth Cube's beads, in state 0 (rest) to 3, along x [mm].
double width(const DisplacementFile& beads, int layer, std::size_t state) {
  double sum = 0.0;
  for (std::size_t i = 0; i < beads.places.size(); ++i) {
    const Vector3& grid = beads.grid[i];
    if (std::lround(grid.z()) != layer || (grid.x() > 1.5 && grid.x() < 6.5)) continue;
    Vector3 at = beads.places[i];
    if (state > 0) at += beads.samples[state - 1].displacement[i];
    sum += (grid.x() > 4.0 ? 1.0 : -1.0) * at.x() / 7.0;
  }
  return 1e3 * sum;
}

double height(const DisplacementFile& beads, std::size_t state) {
  double sum = 0.0;
  for (std::size_t i = 0; i < beads.places.size(); ++i) {
    const long layer = std::lround(beads.grid[i].z());
    if (layer != 1 && layer != 7) continue;
    double at = beads.places[i].z();
    if (state > 0) at += beads.samples[state - 1].displacement[i].z();
    sum += (layer == 7 ? 1.0 : -1.0) * at / 49.0;
  }
  return 1e3 * sum;
}

}  // namespace

/// The bars that anyone can check in the file: the block is compressed along the file's z, and
/// bulges more in its middle than beside the plates.
TEST_F(Displacements, TheTruthCubeIsReadAsItStands) {
  const char* given = std::getenv("FINGERTIP_OPEN_DATA");
  const fs::path data =
      given != nullptr ? fs::path(given) : fs::path(FINGERTIP_SOURCES) / "../shared/data";
  if (!fs::exists(data / "truth_cube"))
    GTEST_SKIP() << "no open data: give their folder in FINGERTIP_OPEN_DATA";
  setenv("FINGERTIP_OPEN_DATA", data.c_str(), 1);
  const DisplacementFile beads =
      read_displacements(fs::path(FINGERTIP_SOURCES) / "studies/cases/23_truth_cube/beads.toml");
  ASSERT_EQ(beads.places.size(), 343u);
  ASSERT_EQ(beads.samples.size(), 3u);
  const double heights[] = {59.60, 55.57, 50.34, 46.05}, middle[] = {60.9, 63.2, 66.8, 70.2},
               fixed[] = {62.7, 64.1, 66.0, 68.0}, moving[] = {60.2, 62.5, 65.0, 67.2};
  for (std::size_t state = 0; state < 4; ++state) {
    EXPECT_NEAR(height(beads, state), heights[state], 0.01);
    EXPECT_NEAR(width(beads, 4, state), middle[state], 0.06);
    EXPECT_NEAR(width(beads, 1, state), fixed[state], 0.06);
    EXPECT_NEAR(width(beads, 7, state), moving[state], 0.06);
  }
  const auto scatter = calibration::grid_scatter(beads.grid, beads.places);
  EXPECT_NEAR(1e3 * scatter.rms, 0.900, 0.005);
  EXPECT_NEAR(1e3 * scatter.pitch, 10.10, 0.02);
}
