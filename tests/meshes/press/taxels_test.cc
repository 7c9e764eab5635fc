#include "meshes/press/taxels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "meshes/base/errors.h"
#include "meshes/shape/geometry.h"

using namespace fingertip;
using meshes::ContactPoint;
using meshes::Taxel;
using meshes::TaxelReading;
using meshes::TaxelSkin;
using meshes::Vector3;
using std::numbers::pi;

namespace {

constexpr double radius = 2e-3, peak = 500.0;

/// Hertz's pressure and a share of it as shear along x, on points about a millimetre's `per`-th
/// apart on the plane z = height, pushed along -z.
std::vector<ContactPoint> hertz(int per, double share, double height = 0.0) {
  std::vector<ContactPoint> points;
  const double step = 1e-3 / per;
  for (double x = -radius; x <= radius; x += step)
    for (double y = -radius; y <= radius; y += step) {
      const double square = 1.0 - (x * x + y * y) / (radius * radius);
      if (!(square > 0.0)) continue;
      ContactPoint point{.area = step * step, .normal_traction = peak * std::sqrt(square)};
      point.rest = point.place = {x, y, height};
      point.shear = {share * point.normal_traction, 0.0, 0.0};
      points.push_back(point);
    }
  return points;
}

TaxelSkin grid(double half, double pitch, double footprint) {
  TaxelSkin skin{.footprint = footprint};
  for (double x = -half; x <= half; x += pitch)
    for (double y = -half; y <= half; y += pitch)
      skin.taxels.push_back({{x, y, 0.0}, Vector3::UnitZ(), pitch * pitch});
  return skin;
}

/// Area times reading: u, v and the push.
Vector3 total(const TaxelSkin& skin, const std::vector<TaxelReading>& readings) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t i = 0; i < readings.size(); ++i)
    sum += skin.taxels[i].area *
           Vector3(readings[i].shear_u, readings[i].shear_v, readings[i].normal_stress);
  return sum;
}

std::string refusal(const auto& make) {
  try {
    make();
  } catch (const meshes::InvalidInput& error) {
    EXPECT_EQ(error.violations().at(0).key, "sensor.taxels");
    return error.violations().at(0).value + ": " + error.violations().at(0).rule;
  }
  return "";
}

TEST(TaxelReadings, OfADenseArrayAddUpToTheForce) {
  const auto points = hertz(6, 0.3);
  const Vector3 force = meshes::sums_of(points, Vector3::Zero()).force;
  for (const double footprint : {0.2e-3, 0.6e-3, 1.5e-3}) {
    const TaxelSkin skin = grid(4e-3, 0.2e-3, footprint);
    const Vector3 felt = total(skin, meshes::taxel_readings(points, skin));
    EXPECT_NEAR(felt.z() / -force.z(), 1.0, 0.005) << footprint;
    EXPECT_NEAR(felt.x() / force.x(), 1.0, 0.005) << footprint;
    EXPECT_NEAR(felt.y(), 0.0, 1e-9) << footprint;
  }
}

/// Of a force on the middle, what goes through a disc of radius L at depth h: of the push
/// 1 - (h/s)³, s² = L² + h², of the shear 1 - (3/2 L² h + h³)/s³.
TEST(TaxelReadings, BelowTheSurfaceAddUpToWhatGoesThrough) {
  auto points = hertz(4, 0.3);
  for (ContactPoint& point : points) point.rest.head<2>() *= 0.1;
  const Vector3 force = meshes::sums_of(points, Vector3::Zero()).force;
  const double depth = 0.6e-3, reach = 6e-3, s = std::hypot(depth, reach);
  TaxelSkin skin = grid(reach, 0.2e-3, 0.2e-3);
  std::erase_if(skin.taxels, [&](const Taxel& taxel) { return taxel.place.norm() > reach; });
  skin.depth = depth;
  const Vector3 felt = total(skin, meshes::taxel_readings(points, skin));
  EXPECT_NEAR(felt.z() / -force.z(), 1.0 - std::pow(depth / s, 3), 0.005);
  EXPECT_NEAR(felt.x() / force.x(),
              1.0 - (1.5 * reach * reach * depth + std::pow(depth, 3)) / std::pow(s, 3), 0.005);
}

/// The mean of Hertz's pressure over a disc about its middle.
TEST(TaxelReadings, AreMeansOverTheFootprint) {
  const auto points = hertz(20, 0.5);
  TaxelSkin skin{.taxels = {{Vector3::Zero(), Vector3::UnitZ(), 0.0}}};
  for (const double part : {0.1, 0.5, 0.9, 1.5}) {
    skin.footprint = 2.0 * part * radius;
    const double rim = std::max(0.0, 1.0 - part * part),
                 mean = 2.0 / 3.0 * (1.0 - rim * std::sqrt(rim)) / (part * part);
    const TaxelReading felt = meshes::taxel_readings(points, skin).at(0);
    EXPECT_NEAR(felt.normal_stress / peak, mean, 0.005) << part;
    EXPECT_NEAR(felt.shear_u / peak, 0.5 * mean, 0.003) << part;
    EXPECT_NEAR(felt.shear_v, 0.0, 1e-9 * peak) << part;
  }
}

/// Of a continuum's meridian: rings much narrower than its points on them are apart, or wider.
TEST(TaxelReadings, OfRingsAreThoseOfTheirPressure) {
  for (const int rings : {20, 150}) {
    std::vector<ContactPoint> points;
    const double width = radius / rings;
    for (int i = 0; i < rings; ++i) {
      const double r = (i + 0.5) * width;
      ContactPoint ring{.area = 2.0 * pi * r * width,
                        .normal_traction = peak * std::sqrt(1.0 - r * r / (radius * radius))};
      ring.rest = ring.place = {r, 0.0, 0.0};
      const int count = 4 * int(std::ceil(19.0 * r / radius));
      const auto turned = meshes::turned_around(ring, count);
      points.insert(points.end(), turned.begin(), turned.end());
    }
    TaxelSkin skin{.footprint = radius / 3.0};
    for (int i = 0; i < 40; ++i) {
      const double r = 0.8 * radius * i / 40.0, angle = 2.4 * i;
      skin.taxels.push_back({{r * std::cos(angle), r * std::sin(angle), 0.0}, Vector3::UnitZ()});
    }
    const auto felt = meshes::taxel_readings(points, skin);
    for (std::size_t i = 0; i < felt.size(); ++i) {
      // The mean over a disc of Hertz's pressure is that in its middle and its Laplacian's part.
      const double x = skin.taxels[i].place.norm() / radius, root = std::sqrt(1.0 - x * x),
                   laplacian = -(2.0 - x * x) / (root * root * root),
                   mean = root + laplacian / 36.0 / 8.0;
      EXPECT_NEAR(felt[i].normal_stress / peak, mean, 0.02) << rings << " " << x;
    }
  }
}

/// Under the middle of Hertz's tractions (Johnson, Contact Mechanics, equations 3.45 and 7.22):
///   sigma_z = p0/(1 + z²/a²),
///   tau_xz = q0 (1 - 3/2 z/a atan(a/z) + z²/(2 (a² + z²))).
TEST(TaxelReadings, BelowTheSurfaceAreThoseOfTheHalfSpace) {
  const auto points = hertz(10, 0.4);
  TaxelSkin skin{.taxels = {{Vector3::Zero(), Vector3::UnitZ(), 0.0}}, .footprint = 0.05e-3};
  for (const double z : {0.1, 0.25, 0.5, 1.0, 2.0}) {
    skin.depth = z * radius;
    const TaxelReading felt = meshes::taxel_readings(points, skin).at(0);
    EXPECT_NEAR(felt.normal_stress / peak, 1.0 / (1.0 + z * z), 0.005) << z;
    EXPECT_NEAR(felt.shear_u / peak,
                0.4 * (1.0 - 1.5 * z * std::atan(1.0 / z) + z * z / (2.0 * (1.0 + z * z))), 0.003)
        << z;
  }
}

/// A footprint, however wide beside the depth, feels the mean of what narrow ones feel.
TEST(TaxelReadings, OfWideFootprintsAreMeansOfNarrowOnes) {
  const auto points = hertz(6, 0.4);
  TaxelSkin narrow{.depth = 0.3e-3, .footprint = 0.02e-3}, wide = narrow;
  const Vector3 middle(1.7e-3, 0.3e-3, 0.0);
  wide.taxels = {{middle, Vector3::UnitZ(), 0.0}};
  for (const double diameter : {0.5e-3, 2e-3}) {
    wide.footprint = diameter;
    narrow.taxels.clear();
    for (int ring = 0; ring < 12; ++ring)
      for (int i = 0; i < 6 * ring + 3; ++i) {
        const double angle = 2.0 * pi * i / (6 * ring + 3),
                     away = diameter / 24.0 * std::sqrt(ring * (ring + 1) + 0.5);
        narrow.taxels.push_back({middle + away * Vector3(std::cos(angle), std::sin(angle), 0.0),
                                 Vector3::UnitZ(), 1.0 / 432.0});
      }
    const Vector3 mean = total(narrow, meshes::taxel_readings(points, narrow));
    const TaxelReading felt = meshes::taxel_readings(points, wide).at(0);
    EXPECT_NEAR(felt.normal_stress, mean.z(), 0.01 * peak) << diameter;
    EXPECT_NEAR(felt.shear_u, mean.x(), 0.005 * peak) << diameter;
    EXPECT_NEAR(felt.shear_v, mean.y(), 0.005 * peak) << diameter;
  }
}

/// What the axes of the field are does not matter, nor how the skin lies as long as it is turned.
TEST(TaxelReadings, GoWithTheAxes) {
  auto points = hertz(4, 0.3, 10e-3);
  const meshes::Geometry finger;
  TaxelSkin skin{.taxels = meshes::taxel_rings(*meshes::shape_of(finger), 3, 5, 0.6e-3),
                 .depth = 0.0,
                 .footprint = 1e-3};
  const auto felt = meshes::taxel_readings(points, skin);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(0.4, Vector3(1.0, 2.0, 0.5).normalized()).toRotationMatrix();
  for (ContactPoint& point : points)
    for (Vector3* vector : point.vectors()) *vector = turn * *vector;
  const auto again = meshes::taxel_readings(points, skin, turn);
  for (std::size_t i = 0; i < felt.size(); ++i) {
    EXPECT_NEAR(again[i].normal_stress, felt[i].normal_stress, 1e-9 * peak);
    EXPECT_NEAR(again[i].shear_u, felt[i].shear_u, 1e-9 * peak);
    EXPECT_NEAR(again[i].shear_v, felt[i].shear_v, 1e-9 * peak);
    EXPECT_NEAR(felt[i].shear_u, 0.3 * felt[i].normal_stress, 1e-9 * peak);
  }
}

TEST(TaxelRings, LieOnTheSurfaceAtEqualSteps) {
  const meshes::Geometry finger;
  const double tip = finger.tip_radius, pitch = 1.2e-3;
  const auto taxels = meshes::taxel_rings(*meshes::shape_of(finger), 4, 6, pitch);
  ASSERT_EQ(taxels.size(), 24u);
  double area = 0.0;
  for (std::size_t i = 0; i < taxels.size(); ++i) {
    const Taxel& taxel = taxels[i];
    EXPECT_NEAR(taxel.place.norm(), tip, 1e-9 * tip);
    EXPECT_NEAR((taxel.normal - taxel.place / tip).norm(), 0.0, 1e-9);
    EXPECT_NEAR(std::acos(taxel.normal.z()), (i / 6 + 0.5) * pitch / tip, 1e-4);
    EXPECT_NEAR(std::atan2(taxel.place.y(), taxel.place.x()),
                std::remainder((i % 6 + 0.5) * pi / 3.0, 2.0 * pi), 1e-9);
    area += taxel.area;
  }
  EXPECT_NEAR(area / (2.0 * pi * tip * tip * (1.0 - std::cos(4.0 * pitch / tip))), 1.0, 1e-3);
}

TEST(TaxelLayout, IsCheckedAgainstTheFinger) {
  const meshes::Geometry finger;
  const auto shape = meshes::shape_of(finger);
  const double tip = finger.tip_radius;
  const Taxel near = meshes::taxel_at(*shape, {0.6 * tip, 0.0, 0.805 * tip});
  EXPECT_NEAR(near.place.norm(), tip, 1e-12);
  EXPECT_NEAR((near.normal - near.place / tip).norm(), 0.0, 1e-9);
  EXPECT_NE(refusal([&] {
              meshes::taxel_at(*shape, {0.0, 0.0, 1.02 * tip});
            }).find("off the surface that may touch"),
            std::string::npos);
  EXPECT_NE(refusal([&] {
              meshes::taxel_at(*shape, {0.0, 0.0, finger.rod_radius});
            }).find("lies in the bond"),
            std::string::npos);
  EXPECT_NE(refusal([&] { meshes::taxel_rings(*shape, 40, 6, 1e-3); }).find("beyond the surface"),
            std::string::npos);
}

TEST(TaxelLayout, RulesOfTheSkin) {
  EXPECT_TRUE(TaxelSkin().violations().empty());
  const std::vector<Taxel> one = {{Vector3::Zero(), Vector3::UnitZ(), 1e-6}};
  const auto key = [](const TaxelSkin& skin) { return skin.violations().at(0).key; };
  EXPECT_EQ(key({.taxels = one, .footprint = 0.0}), "sensor.footprint");
  EXPECT_EQ(key({.taxels = one, .depth = -1e-3}), "sensor.depth");
  EXPECT_EQ(key({.taxels = one, .depth = 0.09e-3, .footprint = 1e-3}), "sensor.depth");
}

}  // namespace
