#include "meshes/cells/surface_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>

#include "tests/expectations.h"

using namespace fingertip::meshes;

namespace {

using std::numbers::pi;

constexpr ProfileSurface surfaces[] = {ProfileSurface::contact, ProfileSurface::bond,
                                       ProfileSurface::free};

std::vector<Geometry> family() {
  return {{},
          {.rod_radius = 0.008, .sleeve_length = 0.0},
          {.rod_radius = 0.001, .sleeve_length = 0.0073},
          {.tip_radius = 0.02, .rod_radius = 0.0195, .sleeve_length = 1e-5}};
}

double integral(const std::vector<SurfacePoint>& points,
                const std::function<double(const SurfacePoint&)>& f) {
  double sum = 0.0;
  for (const SurfacePoint& point : points) sum += point.area * f(point);
  return sum;
}

TEST(SurfacePoints, AreasAddUpToTheExactAreaAtEverySpacing) {
  for (const Geometry& geometry : family()) {
    const double big = geometry.tip_radius, small = geometry.rod_radius;
    const double length = geometry.sleeve_length;
    // Written as hemisphere plus cylinder, and as the difference of two discs.
    const double exact[] = {2 * pi * big * big + 2 * pi * big * length,
                            2 * pi * small * small + 2 * pi * small * length,
                            pi * big * big - pi * small * small};
    for (const ProfileSurface surface : surfaces) {
      const double area = exact[static_cast<int>(surface)];
      EXPECT_NEAR(surface_area(geometry, surface) / area, 1.0, 1e-13) << name(surface);
      for (const double parts : {1.0, 3.3, 12.0, 36.0}) {
        const auto points = surface_points(geometry, surface, big / parts);
        EXPECT_NEAR(integral(points, [](const auto&) { return 1.0; }) / area, 1.0, 1e-12)
            << name(surface) << " R/" << parts;
      }
    }
  }
}

TEST(SurfacePoints, LieOnTheSurfaceWithUnitNormalsOutOfTheRubber) {
  for (const Geometry& geometry : family()) {
    for (const ProfileSurface surface : surfaces) {
      for (const SurfacePoint& point : surface_points(geometry, surface, geometry.tip_radius / 9)) {
        const double step = 0.01 * geometry.thickness();
        ASSERT_NEAR(geometry.signed_distance(point.position), 0.0, 1e-15);
        ASSERT_NEAR(point.normal.norm(), 1.0, 1e-14);
        ASSERT_NEAR(geometry.signed_distance(point.position + step * point.normal), step, 1e-14);
        ASSERT_GT(point.area, 0.0);
      }
    }
  }
}

TEST(SurfacePoints, IntegrateHeightAndNormalExactly) {
  for (const Geometry& geometry : family()) {
    const double length = geometry.sleeve_length;
    for (const ProfileSurface surface : {ProfileSurface::contact, ProfileSurface::bond}) {
      const double radius =
          surface == ProfileSurface::contact ? geometry.tip_radius : geometry.rod_radius;
      const double sign = surface == ProfileSurface::contact ? 1.0 : -1.0;
      const auto points = surface_points(geometry, surface, 0.17 * geometry.tip_radius);
      const double height = integral(points, [](const auto& p) { return p.position.z(); });
      EXPECT_NEAR(height, pi * radius * (radius * radius - length * length), 1e-12 * pi * 1e-4);
      for (int d = 0; d < 3; ++d) {
        // The normal of a closed surface integrates to zero: the disc at the equator closes it.
        const double flux = integral(points, [d](const auto& p) { return p.normal[d]; });
        EXPECT_NEAR(flux, d == 2 ? sign * pi * radius * radius : 0.0, 1e-12 * pi * 1e-4);
      }
    }
    // Polar moment of the annulus.
    const auto points = surface_points(geometry, ProfileSurface::free, 0.17 * geometry.tip_radius);
    const double polar =
        integral(points, [](const auto& p) { return p.position.template head<2>().squaredNorm(); });
    const double exact =
        pi / 2 * (std::pow(geometry.tip_radius, 4) - std::pow(geometry.rod_radius, 4));
    EXPECT_NEAR(polar / exact, 1.0, 1e-12);
  }
}

TEST(SurfacePoints, DivergenceTheoremOverAllSurfacesGivesTheVolume) {
  const Geometry geometry;
  const auto volume = [&](double spacing) {
    double sum = 0.0;
    for (const ProfileSurface surface : surfaces) {
      sum += integral(surface_points(geometry, surface, spacing),
                      [](const auto& p) { return p.position.dot(p.normal) / 3.0; });
    }
    return sum;
  };
  EXPECT_NEAR(volume(1e-3) / geometry.tip_volume(), 1.0, 1e-12);
}

/// Error of the integrals of z² and of (pole) exp(-4 distance/R) over the hemisphere of `outer`.
std::array<double, 2> hemisphere_errors(int parts) {
  const Geometry geometry{.sleeve_length = 0.0};
  const double radius = geometry.tip_radius;
  const auto points = surface_points(geometry, ProfileSurface::contact, pi / 2 * radius / parts);
  const double squares =
      integral(points, [](const auto& p) { return std::pow(p.position.z(), 2); });
  // In the squared distance d² = 2 R (R - z), 0 ... 2 R², area is uniform: dA = pi d(d²).
  const double peak = integral(
      points, [&](const auto& p) { return std::exp(-20.0 * (1.0 - p.position.z() / radius)); });
  return {squares / (2 * pi / 3 * std::pow(radius, 4)) - 1.0,
          peak / (2 * pi * radius * radius / 20.0 * (1.0 - std::exp(-20.0))) - 1.0};
}

TEST(SurfacePoints, OtherIntegralsConvergeAtSecondOrder) {
  const auto coarse = hemisphere_errors(20), fine = hemisphere_errors(40);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_LT(std::abs(fine[i]), 0.01);
    EXPECT_GT(std::log2(coarse[i] / fine[i]), 1.9) << i;
  }
  const Geometry geometry;
  const auto end_error = [&](double spacing) {
    const auto points = surface_points(geometry, ProfileSurface::free, spacing);
    const double sum = integral(points, [](const auto& p) { return p.position.norm(); });
    const double length = geometry.sleeve_length;
    const auto primitive = [&](double s) {
      return 2 * pi / 3 * std::pow(s * s + length * length, 1.5);
    };
    return sum - primitive(geometry.tip_radius) + primitive(geometry.rod_radius);
  };
  EXPECT_GT(std::log2(end_error(1.25e-3) / end_error(0.625e-3)), 1.9);
}

using Mirror = Vector3 (*)(const Vector3&);

TEST(SurfacePoints, AreTheirOwnMirrorImagesAndAvoidTheMirrorPlanes) {
  const Mirror mirrors[] = {[](const Vector3& w) { return Vector3(-w.x(), w.y(), w.z()); },
                            [](const Vector3& w) { return Vector3(w.x(), -w.y(), w.z()); },
                            [](const Vector3& w) { return Vector3(w.y(), w.x(), w.z()); }};
  const Geometry geometry;
  for (const ProfileSurface surface : surfaces) {
    const auto points = surface_points(geometry, surface, geometry.tip_radius / 7.3);
    for (const SurfacePoint& point : points) {
      for (const Mirror mirror : mirrors) {
        const Vector3 image = mirror(point.position);
        ASSERT_GT((image - point.position).norm(), 1e-4 * geometry.tip_radius);
        const auto twin = std::find_if(
            points.begin(), points.end(),
            [&](const SurfacePoint& other) { return (other.position - image).norm() < 1e-14; });
        ASSERT_NE(twin, points.end()) << name(surface) << " " << point.position.transpose();
        ASSERT_NEAR(twin->area, point.area, 1e-20);
        ASSERT_LT((twin->normal - mirror(point.normal)).norm(), 1e-13);
      }
    }
  }
}

/// A random point of the surface, uniform on each of its parts.
Vector3 random_point(std::mt19937& random, const Geometry& geometry, ProfileSurface surface) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const double angle = 2 * pi * unit(random), t = unit(random);
  const Vector3 direction(std::cos(angle), std::sin(angle), 0.0);
  const Vector3 up = Vector3::UnitZ();
  if (surface == ProfileSurface::free) {
    return (geometry.rod_radius + t * geometry.thickness()) * direction -
           geometry.sleeve_length * up;
  }
  const double radius =
      surface == ProfileSurface::contact ? geometry.tip_radius : geometry.rod_radius;
  if (unit(random) < 0.5) return radius * direction - t * geometry.sleeve_length * up;
  return radius * (std::sqrt(1.0 - t * t) * direction + t * up);
}

TEST(SurfacePoints, AreNowhereSparserThanTheSpacing) {
  std::mt19937 random(4);
  for (const Geometry& geometry : family()) {
    for (const ProfileSurface surface : surfaces) {
      const double spacing = geometry.tip_radius / 10.7;
      const auto points = surface_points(geometry, surface, spacing);
      for (int i = 0; i < 2000; ++i) {
        const Vector3 w = random_point(random, geometry, surface);
        double nearest = geometry.tip_radius;
        for (const auto& point : points) nearest = std::min(nearest, (point.position - w).norm());
        ASSERT_LT(nearest, 0.75 * spacing) << name(surface) << " " << w.transpose();
      }
    }
  }
}

TEST(SurfacePoints, DoNotClusterAtThePole) {
  const Geometry geometry;
  const double spacing = geometry.tip_radius / 36.0;
  const auto points = surface_points(geometry, ProfileSurface::contact, spacing);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(points[i].position.z(), points[0].position.z());
    EXPECT_LT(points[i].position.head<2>().norm(), 0.75 * spacing);
  }
  EXPECT_LT(points[8].position.z(), points[0].position.z());
  double nearest = geometry.tip_radius;
  for (std::size_t i = 0; i < 600; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      nearest = std::min(nearest, (points[i].position - points[j].position).norm());
    }
  }
  EXPECT_GT(nearest, 0.5 * spacing);
  for (const SurfacePoint& point : points) {
    ASSERT_LT(point.area, spacing * spacing);
    ASSERT_GT(point.area, 0.38 * spacing * spacing);
  }
}

TEST(SurfacePoints, RefuseImpossibleRequests) {
  const Geometry geometry;
  for (const double spacing : {0.0, -1e-3, 9.9e-6, 0.0101, std::nan("")}) {
    EXPECT_THROW_SAYING(surface_points(geometry, ProfileSurface::contact, spacing), InvalidInput,
                        "surface_points.spacing")
        << spacing;
  }
  const Geometry inverted{.rod_radius = 0.011};
  EXPECT_THROW_SAYING(surface_points(inverted, ProfileSurface::free, 1e-3), InvalidInput,
                      "geometry.rod_radius");
  EXPECT_THROW_SAYING(surface_area(inverted, ProfileSurface::free), InvalidInput,
                      "geometry.rod_radius");
}

}  // namespace
