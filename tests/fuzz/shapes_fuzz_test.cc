// Damaged meridians and surfaces: a finger, or a refusal.

#include <gtest/gtest.h>

#include <cmath>

#include "campaign.h"
#include "meshes/base/errors.h"
#include "studies/config/shapes/profile_file.h"
#include "studies/config/shapes/solid_file.h"
#include "tests/fingers.h"
#include "tests/stl_text.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using meshes::InvalidInput;

namespace {

meshes::TriangleMesh cone() {
  return fingers::revolved({{0.0, 0.0}, {0.006, 0.0}, {0.0, 0.012}}, 7);
}

fuzz::Reader surface_reader(const std::filesystem::path& file) {
  return fuzz::refusing<InvalidInput>([file](const std::string& input) {
    write_text(file, input);
    const auto solid = studies::read_solid({file, "mm", "z < 1 mm or x > 3 mm"});
    EXPECT_GT(solid->volume(), 0.0);
    EXPECT_GT(solid->wall(), 0.0);
    EXPECT_TRUE(std::isfinite(solid->signed_distance({0.0, 0.0, 0.03})));
  });
}

}  // namespace

TEST(FuzzShapes, Meridians) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "finger.csv";
  const std::vector<std::string> seeds = {
      "r [mm],z [mm],surface,curve\n12.5,0,contact,\n12.5,12.5,contact,arc 0 12.5\n0,25,axis,\n"
      "0,0,bond,\n",
      "r [cm],z [cm],surface,curve\n1.25,0,contact,\n1.25,1.25,contact,spline\n"
      "0.9,2.2,contact,spline\n0,2.5,axis,\n0,2.25,free,arc 0 1.25\n1,1.25,free,\n1,0,bond,\n"};
  const std::vector<std::string> words = {
      "axis",     "bond", "contact", "free",    "spline", "arc 0 1 ",    "arc", "[mm]", "[m]", "r",
      "\n0,12,,", "-",    "e9",      "\n5,5,,", "curve",  "\n0,0,bond,", ";",   ",",    "#"};
  fuzz::attack({seeds, words}, fuzz::refusing<InvalidInput>([&](const std::string& input) {
                 write_text(file, input);
                 const auto geometry = meshes::Geometry::of_profile(studies::read_profile(file));
                 EXPECT_GT(geometry.tip_volume(), 0.0);
                 EXPECT_GT(geometry.coarsest_spacing(), 0.0);
               }));
}

TEST(FuzzShapes, SurfacesAsText) {
  const TemporaryFolder folder;
  fuzz::attack({{stl_text(cone())},
                {"vertex 0 0 0\n", "facet", "outer loop\n", "endloop\n", "endfacet\n", "solid",
                 "endsolid\n", "normal", "1e30", "-6"}},
               surface_reader(folder / "finger.stl"));
}

TEST(FuzzShapes, SurfacesAsBytes) {
  const TemporaryFolder folder;
  fuzz::attack({{stl_bytes(cone())}, {std::string(4, '\xff'), std::string(12, '\0'), "solid"}},
               surface_reader(folder / "finger.stl"));
}
