#include "meshes/shape/revolved_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "meshes/shape/solid.h"
#include "tests/fingers.h"

using namespace fingertip::meshes;

namespace {

/// What a polygon of n corners has of its circle's area.
double share_of_circle(int n) {
  const double angle = 2.0 * std::numbers::pi / n;
  return std::sin(angle) / angle;
}

TEST(RevolvedSurface, OfTheDomeHasTwentyThousandTrianglesAndTheVolumeOfItsPolygons) {
  const Geometry dome;
  const Meridian meridian(dome.corners());
  const TriangleMesh mesh = revolved_surface(meridian);
  EXPECT_NEAR(double(mesh.triangles.size()), 20000.0, 1000.0);
  const SurfaceDeviation far = deviation(mesh, meridian);
  // Chords around the axis are highest at the largest radius; a facet's middle lies below one of
  // these and one along the meridian.
  const double around = dome.tip_radius * (1.0 - std::cos(std::numbers::pi / 104));
  EXPECT_GT(far.largest, around);
  EXPECT_LT(far.largest, around + 5e-4 * dome.tip_radius);
  // Chords of the meridian take less than a tenth of what those around the axis take.
  EXPECT_NEAR(far.volume, share_of_circle(104) - 1.0, 1e-4);
  const Solid solid(mesh, fingers::dome_bond());
  EXPECT_NEAR(solid.volume() / dome.tip_volume(), 1.0 + far.volume, 1e-9);
  EXPECT_EQ(solid.pole(), dome.tip_radius);
  EXPECT_NEAR(solid.area(ProfileSurface::bond) / surface_area(dome, ProfileSurface::bond), 1.0,
              1e-3);
}

/// Depth counts from the pole: rings around it lie on the sphere, and chords between them are low.
TEST(RevolvedSurface, IsFineWhereItMayTouch) {
  const Geometry dome;
  std::set<double> heights;
  const TriangleMesh mesh = revolved_surface(Meridian(dome.corners()));
  for (const Vector3& w : mesh.vertices)
    if (w.z() > 0.0 && w.norm() > 0.99 * dome.tip_radius) heights.insert(w.z());
  double above = -1.0;
  for (const double z : heights) {
    const double latitude = std::asin(std::min(1.0, z / dome.tip_radius));
    const double height = dome.tip_radius * (1.0 - std::cos(0.5 * (latitude - above)));
    EXPECT_LT(above < 0.0 ? 0.0 : height, 1.001e-6);
    above = latitude;
  }
}

/// Pieces that meet the axis twice or not at all, straight ones and splines.
TEST(RevolvedSurface, ClosesAroundBodiesOfAnyMeridian) {
  for (const auto& corners : {fingers::solid(), fingers::hollow(), fingers::dome()}) {
    const Meridian meridian(corners);
    const TriangleMesh mesh = closed_surface(revolved_surface(meridian));
    EXPECT_NEAR(deviation(mesh, meridian).volume, 0.0, 2e-3);
    EXPECT_LT(deviation(mesh, meridian).largest, 1e-3 * meridian.largest_radius());
  }
}

}  // namespace
