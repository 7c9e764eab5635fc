#include "meshes/shape/meridian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "meshes/cells/cut_cells.h"
#include "meshes/cells/revolved_cells.h"
#include "meshes/cells/surface_points.h"
#include "tests/expectations.h"
#include "tests/fingers.h"

using namespace fingertip::meshes;

namespace {

using std::numbers::pi;
using enum ProfileSurface;
using enum ProfileCurve;

/// A solid ellipsoid of half axes a (across) and b (up) cut at its middle, as a spline through n
/// corners a quarter, held at its base.
std::vector<ProfileCorner> half_ellipsoid(double a, double b, int n) {
  std::vector<ProfileCorner> corners;
  for (int i = 0; i < n; ++i) {
    const double t = 0.5 * pi * i / n;
    corners.push_back({a * std::cos(t), b * std::sin(t), contact, spline});
  }
  corners.push_back({0.0, b, axis, straight});
  corners.push_back({0.0, 0.0, bond, straight});
  return corners;
}

void expect_refused(std::vector<ProfileCorner> corners, const std::string& rule) {
  EXPECT_TRUE(refuses<InvalidInput>([&] { Geometry::of_profile(std::move(corners)); }, rule));
}

TEST(Meridian, OfTheDomeIsTheDome) {
  const Geometry dome, profile = Geometry::of_profile(fingers::dome(dome), -dome.rod_length);
  EXPECT_NEAR(profile.tip_radius, dome.tip_radius, 1e-15);
  EXPECT_NEAR(profile.rod_radius, dome.rod_radius, 1e-15);
  EXPECT_NEAR(profile.sleeve_length, dome.sleeve_length, 1e-15);
  EXPECT_EQ(profile.rod_length, dome.rod_length);
  EXPECT_NEAR(profile.pole(), dome.pole(), 1e-15);
  EXPECT_NEAR(profile.thickness(), dome.thickness(), 1e-15);
  EXPECT_NEAR(profile.tip_volume() / dome.tip_volume(), 1.0, 1e-14);
  const Meridian meridian(profile.corners());
  EXPECT_NEAR(meridian.wall(), dome.thickness(), 1e-12);
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> place(-0.02, 0.02);
  for (int i = 0; i < 2000; ++i) {
    const Vector3 w(place(generator), place(generator), place(generator));
    EXPECT_NEAR(meridian.signed_distance(w), dome.signed_distance(w), 1e-14) << w.transpose();
  }
}

TEST(Meridian, MayBeginAtAnyCornerEitherWayRound) {
  const Geometry dome;
  const double volume = dome.tip_volume();
  const std::vector<ProfileCorner> corners = fingers::dome(dome);
  for (std::size_t first = 0; first < corners.size(); ++first) {
    std::vector<ProfileCorner> turned = corners;
    std::rotate(turned.begin(), turned.begin() + std::ptrdiff_t(first), turned.end());
    EXPECT_NEAR(Geometry::of_profile(turned).tip_volume() / volume, 1.0, 1e-14);
    // Backward: each piece keeps its surface and curve, now named at its other end.
    std::vector<ProfileCorner> backward;
    for (std::size_t i = corners.size(); i-- > 0;) {
      ProfileCorner corner = turned[(i + corners.size() - 1) % corners.size()];
      corner.r = turned[i].r, corner.z = turned[i].z;
      backward.push_back(corner);
    }
    const Geometry geometry = Geometry::of_profile(backward);
    EXPECT_NEAR(geometry.tip_volume() / volume, 1.0, 1e-14);
    EXPECT_NEAR(Meridian(geometry.corners()).area(bond), surface_area(dome, ProfileSurface::bond),
                1e-14);
  }
}

TEST(Meridian, SplinesRunThroughTheirCornersAndMeetTheAxisSquarely) {
  const double a = 0.012, b = 0.006;
  double last = 0.0;
  for (const int n : {4, 8, 16}) {
    const Geometry geometry = Geometry::of_profile(half_ellipsoid(a, b, n));
    const double error = std::abs(geometry.tip_volume() / (2.0 / 3.0 * pi * a * a * b) - 1.0);
    // Natural at the base, so of lower order there than the cubic's fourth.
    if (last > 0.0) {
      EXPECT_LT(error, last / 3.5) << n;
    }
    last = error;
    const Meridian meridian(geometry.corners());
    const MeridianPiece* top = nullptr;
    for (const MeridianPiece& piece : meridian.pieces())
      if (piece.surface() == contact && piece.to().x() == 0.0) top = &piece;
    ASSERT_NE(top, nullptr);
    EXPECT_NEAR(top->normal(1.0).x(), 0.0, 1e-12);
    EXPECT_EQ(geometry.pole(), b);
    EXPECT_NEAR(meridian.wall(), b, 1e-2 * b);  // aslant, beside the pole
  }
  EXPECT_LT(last, 1e-4);
}

TEST(Meridian, DistanceToASplineIsThatToItsPoints) {
  const Geometry geometry = Geometry::of_profile(half_ellipsoid(0.012, 0.006, 8));
  const Meridian meridian(geometry.corners());
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> place(0.0, 0.015);
  for (int i = 0; i < 200; ++i) {
    const Vector2 p(place(generator), place(generator) - 0.004);
    double nearest = 1.0;
    for (const MeridianPiece& piece : meridian.pieces())
      if (piece.surface() != axis)
        for (int k = 0; k <= 2000; ++k)
          nearest = std::min(nearest, (piece.at(k / 2000.0) - p).norm());
    const double distance = std::abs(meridian.signed_distance(p));
    EXPECT_LE(distance, nearest);
    EXPECT_GE(distance, nearest - 1e-6);  // 2000 points a piece
    const bool inside =
        p.y() > 0.0 && std::pow(p.x() / 0.012, 2) + std::pow(p.y() / 0.006, 2) < 0.999;
    if (inside) {
      EXPECT_LT(meridian.signed_distance(p), 0.0);
    }
  }
}

TEST(Meridian, WallOfAHollowFinger) {
  const Geometry geometry = Geometry::of_profile(fingers::hollow());
  EXPECT_NEAR(Meridian(geometry.corners()).wall(), 0.0025, 1e-9);
  EXPECT_NEAR(geometry.thickness(), 0.025, 1e-15);
  EXPECT_NEAR(geometry.coarsest_spacing(), 0.0025 / 4, 1e-9);
  EXPECT_EQ(geometry.rod_length, 0.0);
}

TEST(Meridian, WallsAreThereAndWedgesAreNone) {
  const auto wall = [](std::vector<ProfileCorner> corners) {
    return Meridian(std::move(corners)).wall();
  };
  // A shell of 1 mm, glued inside at its base, with a free rim below.
  EXPECT_NEAR(wall({{0.012, 0.0, contact, straight},
                    {0.012, 0.012, contact, arc, 0.0, 0.012},
                    {0.0, 0.024, axis, straight},
                    {0.0, 0.023, free, arc, 0.0, 0.012},
                    {0.011, 0.012, free, straight},
                    {0.011, 0.004, bond, straight},
                    {0.011, 0.0, free, straight}}),
              0.001, 1e-6);
  // A thick finger with a slot of 0.3 mm, 3.5 mm below its side.
  EXPECT_NEAR(wall({{0.0125, 0.0, contact, straight},
                    {0.0125, 0.0125, contact, arc, 0.0, 0.0125},
                    {0.0, 0.025, axis, straight},
                    {0.0, 0.0, bond, straight},
                    {0.0087, 0.0, free, straight},
                    {0.0087, 0.012, free, straight},
                    {0.0090, 0.012, free, straight},
                    {0.0090, 0.0, bond, straight}}),
              0.0035, 1e-6);
  // Acute corners: a cone, and a cap that undercuts its base.
  const double cone = wall(
      {{0.01, 0.0, contact, straight}, {0.0, 0.0058, axis, straight}, {0.0, 0.0, bond, straight}});
  EXPECT_GT(cone, 0.003);
  // No axis: a tube standing on its rim is no finger, for nothing of it touches first on the axis.
  expect_refused({{0.01, 0.0, bond, straight},
                  {0.012, 0.0, contact, straight},
                  {0.012, 0.02, contact, straight},
                  {0.01, 0.02, free, straight}},
                 "lie on the axis");
}

TEST(Meridian, PoleRadius) {
  EXPECT_NEAR(Meridian(Geometry{}.corners()).pole_radius(), 0.010, 1e-15);
  const Geometry pad = Geometry::of_profile(half_ellipsoid(0.012, 0.006, 24));
  EXPECT_NEAR(Meridian(pad.corners()).pole_radius(), 0.024, 0.0003);  // a²/b
}

TEST(Meridian, BondsArcsReachAsHighAsTheyBulge) {
  // A ball joint: the bond's arc rises above its corners.
  const Geometry geometry = Geometry::of_profile({{0.0125, 0.0, contact, straight},
                                                  {0.0125, 0.0125, contact, arc, 0.0, 0.0125},
                                                  {0.0, 0.025, axis, straight},
                                                  {0.0, 0.005, bond, arc, 0.004, 0.004},
                                                  {0.008, 0.005, bond, straight},
                                                  {0.008, 0.0, free, straight}});
  EXPECT_NEAR(geometry.thickness(), geometry.pole() - Meridian(geometry.corners()).bond_top(),
              1e-12);
}

TEST(Meridian, GluedAtTheSideItIsAsThickAsAlongTheAxis) {
  // In a cup up to its face; in a bowl; a membrane in a ring.
  const Geometry cup = Geometry::of_profile({{0.0032, 0.0, bond, straight},
                                             {0.0032, 0.00796, contact, straight},
                                             {0.0, 0.00796, axis, straight},
                                             {0.0, 0.0, bond, straight}}),
                 bowl = Geometry::of_profile({{0.002, 0.001, bond, straight},
                                              {0.004, 0.006, contact, straight},
                                              {0.0, 0.006, axis, straight},
                                              {0.0, 0.001, bond, straight}}),
                 ring = Geometry::of_profile({{0.006, 0.001, bond, straight},
                                              {0.006, 0.003, contact, straight},
                                              {0.0, 0.003, axis, straight},
                                              {0.0, 0.001, free, straight}});
  EXPECT_NEAR(cup.thickness(), 0.00796, 1e-15);
  EXPECT_NEAR(bowl.thickness(), 0.005, 1e-15);
  EXPECT_NEAR(ring.thickness(), 0.002, 1e-15);
  EXPECT_NEAR(cup.coarsest_spacing(), 0.25 * 0.00796, 1e-9);
  EXPECT_NEAR(ring.coarsest_spacing(), 0.25 * 0.002, 1e-9);
}

/// Cells, whatever the grid's place: volume, centroid and second moments of bodies known in closed
/// form.
TEST(Meridian, CutCellsAddUpToTheBody) {
  struct Body {
    const char* what;
    Geometry geometry;
    double volume, first;  ///< closed form: integrals of 1 and z
  };
  const double a = 0.012, b = 0.006, R = 0.0125, wall = 0.0025, H = 0.025, r = R - wall;
  const double z0 = H - R;
  const auto ball = [](double q) { return 2.0 / 3.0 * pi * q * q * q; };
  const auto lever = [&](double q) { return ball(q) * z0 + pi / 4 * std::pow(q, 4); };
  const Geometry spline_body = Geometry::of_profile(half_ellipsoid(a, b, 24));
  const std::vector<Body> bodies = {
      {"hollow", Geometry::of_profile(fingers::hollow(R, wall)),
       pi * (R * R - r * r) * z0 + ball(R) - ball(r),
       pi * (R * R - r * r) * z0 * z0 / 2 + lever(R) - lever(r)},
      {"cone",
       Geometry::of_profile({{0.01, 0.0, contact, straight},
                             {0.0, 0.02, axis, straight},
                             {0.0, 0.0, bond, straight}}),
       pi / 3 * 0.01 * 0.01 * 0.02, pi / 12 * 0.01 * 0.01 * 0.02 * 0.02},
      {"spline", spline_body, spline_body.tip_volume(), 0.0},
      {"torus rim",  // a flat disc with a rounded rim: off-axis arcs
       Geometry::of_profile({{0.01, 0.0, contact, arc, 0.01, 0.002},
                             {0.012, 0.002, contact, arc, 0.01, 0.002},
                             {0.01, 0.004, contact, straight},
                             {0.0, 0.004, axis, straight},
                             {0.0, 0.0, bond, straight}}),
       pi * 0.01 * 0.01 * 0.004 + pi * pi * 0.002 * 0.002 * 0.01 +
           4.0 / 3.0 * pi * std::pow(0.002, 3),
       0.0}};
  for (const Body& body : bodies)
    for (const Vector3& offset : {Vector3(0, 0, 0), Vector3(0.3, -0.2, 0.7)})
      for (const int turn : {0, 1, 2}) {
        Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
        if (turn == 1) axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
        if (turn == 2) axes << 0, -1, 0, 0, 0, 1, -1, 0, 0;
        const double spacing = std::min(0.9 * body.geometry.coarsest_spacing(), 0.001);
        const CubicGrid grid = covering_grid(body.geometry, spacing, offset, 1, axes);
        double volume = 0.0, first = 0.0;
        for (const CutCell& cell : cut_cells(body.geometry, grid, 0.0)) {
          const auto& m = cell.moments;
          const Vector3 corner = grid.position(cell.index[0], cell.index[1], cell.index[2]);
          volume += m[0];
          first +=
              corner.z() * m[0] + spacing * axes.row(2).dot(Eigen::RowVector3d(m[1], m[2], m[4]));
        }
        volume *= std::pow(spacing, 3), first *= std::pow(spacing, 3);
        EXPECT_NEAR(volume / body.volume, 1.0, 1e-8) << body.what;
        if (body.first > 0.0) {
          EXPECT_NEAR(first / body.first, 1.0, 1e-8) << body.what;
        }
      }
}

/// Fine cells are no differences of large numbers: eight cells make the cell that they fill.
TEST(Meridian, FineCellsAddUp) {
  const Geometry geometry;
  for (const int per_radius : {40, 80}) {
    const double spacing = geometry.tip_radius / per_radius;
    CubicGrid coarse = covering_grid(geometry, spacing, Vector3(0.3, 0.1, 0.2), 1), fine = coarse;
    fine.spacing /= 2;
    const Meridian meridian(geometry.corners());
    for (const int i : {per_radius / 3, per_radius / 2, 2 * per_radius / 3})
      for (int j = 2; j < coarse.size[1] - 2; j += per_radius / 4) {
        const int k = coarse.size[2] - per_radius / 2;
        const auto whole = revolved_moments(meridian, coarse, i, j, k);
        double volume = 0.0, product = 0.0;
        for (int part = 0; part < 8; ++part) {
          const int x = part & 1, y = part >> 1 & 1, z = part >> 2;
          const auto m = revolved_moments(meridian, fine, 2 * i + x, 2 * j + y, 2 * k + z);
          volume += m[0] / 8;
          product += (m[3] + x * m[2] + y * m[1] + x * y * m[0]) / 32;
        }
        EXPECT_NEAR(whole[0], volume, 1e-10);
        EXPECT_NEAR(whole[3], product, 1e-10);
      }
  }
}

TEST(Meridian, SurfacePointsCarryAreaAndCloseTheBody) {
  for (const auto& corners :
       {fingers::hollow(), half_ellipsoid(0.012, 0.006, 12), fingers::dome(Geometry{})}) {
    const Geometry geometry = Geometry::of_profile(corners);
    double flux = 0.0, push = 0.0, whole = 0.0;
    for (const ProfileSurface surface :
         {ProfileSurface::contact, ProfileSurface::bond, ProfileSurface::free}) {
      double area = 0.0;
      for (const SurfacePoint& point : surface_points(geometry, surface, 2e-4)) {
        area += point.area;
        flux += point.area * point.normal.dot(point.position) / 3.0;
        push += point.area * point.normal.z();
      }
      const double exact = surface_area(geometry, surface);
      EXPECT_NEAR(area, exact, 1e-11 * exact);
      whole += area;
    }
    EXPECT_NEAR(flux / geometry.tip_volume(), 1.0, 3e-4);  // Gauss
    EXPECT_NEAR(push / whole, 0.0, 2e-5);
  }
}

TEST(Meridian, RefusesWhatIsNoFinger) {
  const auto with = [](auto&& change) {
    std::vector<ProfileCorner> corners = fingers::dome(Geometry{});
    change(corners);
    return corners;
  };
  expect_refused({{0, 0, axis, straight}, {0.01, 0, contact, straight}}, "at least three");
  expect_refused(with([](auto& c) { c[2].r = -0.005; }), "must not be negative");
  expect_refused(with([](auto& c) {
                   for (auto& corner : c) corner.r *= 1000, corner.z *= 1000;
                 }),
                 "0.5 mm to 0.5 m");
  expect_refused(with([](auto& c) { c[1].r = 0.001; }), "a piece of the axis runs from r = 0");
  expect_refused(with([](auto& c) { c[5].centre_r = 0.001; }), "equally far from its centre");
  expect_refused(with([](auto& c) { c[4].surface = c[5].surface = free; }),
                 "name at least one piece contact");
  expect_refused(with([](auto& c) { c[1].surface = c[2].surface = free; }),
                 "name at least one piece bond");
  expect_refused(with([](auto& c) { c.insert(c.begin() + 3, c[3]); }), "must differ from the next");
  expect_refused({{0.01, 0, contact, straight},
                  {0.0, 0.02, axis, straight},
                  {0.0, 0.0, bond, straight},
                  {0.012, 0.01, free, straight}},
                 "must not cross or touch itself");
  expect_refused({{0.005, 0, contact, straight},
                  {0.01, 0.01, contact, straight},
                  {0.005, 0.0, bond, straight}},
                 "");
  // Upside down, with arcs mirrored, too, or with the names exchanged.
  expect_refused(with([](auto& c) {
                   for (auto& corner : c) corner.z *= -1, corner.centre_z *= -1;
                 }),
                 "tip at (r, z) = (0, -10) mm, bond up to z = 15 mm: the finger is upside down");
  expect_refused({{0.0125, 0.0, bond, straight},
                  {0.0125, 0.0125, bond, arc, 0.0, 0.0125},
                  {0.0, 0.025, axis, straight},
                  {0.0, 0.0, contact, straight}},
                 "exchange the names contact and bond");
  // A crater, whose rim touches first.
  expect_refused({{0.01, 0.0, contact, straight},
                  {0.01, 0.02, contact, straight},
                  {0.0, 0.015, axis, straight},
                  {0.0, 0.0, bond, straight}},
                 "highest point of `contact` at (r, z) = (10, 20) mm: it must lie on the axis");
  // A nail above the tip.
  expect_refused({{0.01, 0.005, contact, straight},
                  {0.0, 0.01, axis, straight},
                  {0.0, 0.0, bond, straight},
                  {0.012, 0.0, free, straight},
                  {0.012, 0.02, free, straight},
                  {0.01, 0.02, free, straight}},
                 "`contact` ends at z = 10 mm: no piece may lie higher");
  expect_refused(
      {{0.0, 0.0, axis, straight}, {0.0, 0.01, bond, straight}, {0.01, 0.0, contact, straight}},
      "");
}

TEST(Meridian, RefusesATurnedGridWithTheReason) {
  const Geometry geometry = Geometry::of_profile(fingers::dome(Geometry{}));
  CubicGrid grid = covering_grid(geometry, 1e-3, Vector3::Zero(), 1);
  grid.axes << 0.8, -0.6, 0, 0.6, 0.8, 0, 0, 0, 1;
  EXPECT_THROW_SAYING(cut_cells(geometry, grid, 0.0), InvalidInput, "lattice.rotation");
}

}  // namespace
