#include "meshes/press/taxels.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
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

/// Pressure over its peak at a place over the contact's radius.
using Law = std::function<double(double, double)>;

double round_law(double x, double y) {
  return std::sqrt(std::max(0.0, 1.0 - x * x - y * y));
}
double oval_law(double x, double y) {
  return round_law(x, 2.0 * y);
}
/// Of thin rubber pressed far (meshes::contact_patch, b = 2).
double peaked_law(double x, double y) {
  const double inside = std::max(0.0, 1.0 - x * x - y * y);
  return (std::sqrt(inside) + 2.0 * std::pow(inside, 3.5)) / 3.0;
}

ContactPoint point_of(const Law& law, double x, double y, double area) {
  ContactPoint point{.area = area, .normal_traction = peak * law(x / radius, y / radius)};
  point.rest = point.place = {x, y, 0.0};
  point.shear = {0.3 * point.normal_traction, 0.0, 0.0};
  return point;
}

/// Nodes of a solid's mesh, `count` to the radius, no two elements alike: areas as a quadratic
/// element's corners, edges and middles have them.
std::vector<ContactPoint> nodes_of(const Law& law, int count) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> off(-0.3, 0.3);
  const double step = radius / count;
  std::vector<ContactPoint> points;
  for (int i = -count - 1; i <= count + 1; ++i)
    for (int j = -count - 1; j <= count + 1; ++j) {
      const double area = step * step * (i % 2 ? 4.0 : 2.0) / 3.0 * (j % 2 ? 4.0 : 2.0) / 3.0;
      points.push_back(
          point_of(law, (i + off(generator)) * step, (j + off(generator)) * step, area));
    }
  std::erase_if(points, [](const ContactPoint& point) { return point.normal_traction == 0.0; });
  return points;
}

/// A lattice's surface points in circles (meshes::surface_points), `count` to the radius.
std::vector<ContactPoint> circles_of(const Law& law, int count) {
  const double step = radius / count;
  std::vector<ContactPoint> points;
  for (int i = 0; i < count; ++i) {
    const double r = (i + 0.5) * step;
    const int around = 8 * std::max(1, int(std::ceil(2.0 * pi * r / (8.0 * step))));
    for (int j = 0; j < around; ++j) {
      const double angle = 2.0 * pi * (j + 0.5) / around;
      points.push_back(
          point_of(law, r * std::cos(angle), r * std::sin(angle), 2.0 * pi * r * step / around));
    }
  }
  std::erase_if(points, [](const ContactPoint& point) { return point.normal_traction == 0.0; });
  return points;
}

/// A continuum's meridian, `count` nodes to the radius, the edge between two of them.
std::vector<ContactPoint> rings_of(const Law& law, int count) {
  const double width = radius / (count + 0.4);
  std::vector<ContactPoint> points;
  for (int i = 0; i <= count; ++i) {
    const double r = i * width, area = pi * (i > 0 ? 2.0 * r * width : 0.25 * width * width);
    ContactPoint ring = point_of(law, r, 0.0, area);
    ring.shear = {0.0, 0.3 * ring.normal_traction, 0.0};  // of a twist
    const auto turned =
        meshes::turned_around(ring, i > 0 ? 4 * int(std::ceil(19.0 * double(i) / count)) : 1);
    points.insert(points.end(), turned.begin(), turned.end());
  }
  return points;
}

/// The mean over a disc of `part` of the radius, by quadrature.
double mean_of(const Law& law, const Vector3& middle, double part) {
  constexpr int along = 60, around = 120;
  double sum = 0.0;
  for (int i = 0; i < along; ++i)
    for (int j = 0; j < around; ++j) {
      const double away = part * std::sqrt((i + 0.5) / along),
                   angle = 2.0 * pi * (j + 0.5 * (i % 2)) / around;
      sum += law(middle.x() / radius + away * std::cos(angle),
                 middle.y() / radius + away * std::sin(angle));
    }
  return sum / (along * around);
}

/// Places anywhere in the contact and beside it.
TaxelSkin scattered(double part) {
  TaxelSkin skin{.footprint = 2.0 * std::max(part, 1e-9) * radius};
  for (int i = 0; i < 60; ++i) {
    const double away = 1.3 * radius * std::sqrt((i + 0.5) / 60.0), angle = 2.399963 * i;
    skin.taxels.push_back(
        {{away * std::cos(angle), away * std::sin(angle), 0.0}, Vector3::UnitZ(), 0.0});
  }
  return skin;
}

/// Footprints from none to as wide as the radius, wherever they lie, of points as both models have
/// them, whose forces are the pressure's within 0.6 %.
TEST(TaxelReadings, AreMeansOfHertzWithinAHundredthOfThePeak) {
  const std::vector<std::pair<Law, std::vector<ContactPoint>>> fields = {
      {round_law, hertz(6, 0.3)},
      {round_law, hertz(10, 0.3)},
      {round_law, nodes_of(round_law, 20)},
      {oval_law, nodes_of(oval_law, 20)},
      {round_law, circles_of(round_law, 20)},
      {peaked_law, circles_of(peaked_law, 20)}};
  for (const double part : {0.0, 0.05, 0.2, 0.5})
    for (std::size_t k = 0; k < fields.size(); ++k) {
      const auto& [law, points] = fields[k];
      const TaxelSkin skin = scattered(part);
      const auto felt = meshes::taxel_readings(points, skin);
      for (std::size_t i = 0; i < felt.size(); ++i) {
        const double mean = mean_of(law, skin.taxels[i].place, part);
        EXPECT_NEAR(felt[i].normal_stress / peak, mean, k < 5 ? 0.01 : 0.02)
            << part << " " << k << " " << i;
        EXPECT_NEAR(felt[i].shear_u / peak, 0.3 * mean, 0.006) << part << " " << k << " " << i;
      }
    }
}

/// Rings much narrower than their points on them are apart, or as wide: at every angle, too.
TEST(TaxelReadings, OfRingsAreThoseOfTheirPressure) {
  for (const int count : {40, 190})
    for (const double part : {0.0, 0.06, 0.2, 0.5}) {
      const auto points = rings_of(round_law, count);
      const TaxelSkin skin = scattered(part);
      const auto felt = meshes::taxel_readings(points, skin);
      for (std::size_t i = 0; i < felt.size(); ++i) {
        const Vector3& place = skin.taxels[i].place;
        const double mean = mean_of(round_law, place, part);
        EXPECT_NEAR(felt[i].normal_stress / peak, mean, 0.01) << count << " " << part << " " << i;
        if (part > 0.0) continue;
        // Around the axis.
        const Vector3 across = Vector3::UnitZ().cross(place).normalized();
        EXPECT_NEAR(felt[i].shear_u / peak, 0.3 * mean * across.x(), 0.004) << count << " " << i;
        EXPECT_NEAR(felt[i].shear_v / peak, 0.3 * mean * across.y(), 0.004) << count << " " << i;
      }
    }
}

/// Also where the outermost points bear what presses beyond them, as a lattice's do, and where the
/// edge is sharp.
TEST(TaxelReadings, OfADenseArrayAddUpToTheForceWhateverTheEdgeIs) {
  auto heavy = circles_of(round_law, 10);
  for (ContactPoint& point : heavy)
    if (point.rest.norm() > 0.8 * radius) point.normal_traction *= 1.2;
  const auto flat = circles_of([](double x, double y) { return double(x * x + y * y < 1.0); }, 10);
  for (const auto& points : {heavy, flat, rings_of(peaked_law, 30)}) {
    const double force = -meshes::sums_of(points, Vector3::Zero()).force.z();
    const TaxelSkin skin = grid(3.2e-3, 0.1e-3, 0.3e-3);
    EXPECT_NEAR(total(skin, meshes::taxel_readings(points, skin)).z() / force, 1.0, 0.005)
        << points.size();
  }
}

/// Coulomb's bound holds between points, too: shear over pressure is at most theirs.
TEST(TaxelReadings, HaveNoMoreShearOverPressureThanThePoints) {
  const auto points = nodes_of(peaked_law, 8);
  for (const TaxelReading& felt : meshes::taxel_readings(points, scattered(0.1)))
    EXPECT_LE(std::hypot(felt.shear_u, felt.shear_v), (0.3 + 1e-9) * felt.normal_stress);
}

TEST(TaxelReadings, BetweenTwoPadsAreZero) {
  std::vector<ContactPoint> points = nodes_of(round_law, 10), other = points;
  for (ContactPoint& point : points) point.rest.x() = point.place.x() -= 1.3 * radius;
  for (ContactPoint& point : other) point.rest.x() = point.place.x() += 1.3 * radius;
  points.insert(points.end(), other.begin(), other.end());
  TaxelSkin skin{.footprint = 0.1 * radius};
  for (const double y : {-0.5, 0.0, 0.5})
    skin.taxels.push_back({{0.0, y * radius, 0.0}, Vector3::UnitZ(), 0.0});
  skin.taxels.push_back({{1.3 * radius, 0.0, 0.0}, Vector3::UnitZ(), 0.0});
  const auto felt = meshes::taxel_readings(points, skin);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(felt[i].normal_stress, 0.0) << i;
  EXPECT_NEAR(felt[3].normal_stress / peak, 1.0, 0.01);
}

/// Coarse points and a pressure that they do not resolve: nine of ten within twice the error.
TEST(TaxelRows, HaveAnErrorOfWhatThePointsLeaveOpen) {
  int covered = 0, all = 0;
  for (const int count : {6, 9, 14}) {
    auto points = nodes_of(peaked_law, count);
    for (ContactPoint& point : points) point.sample = 1, point.indentation = 1e-3;
    const double part = 0.15;
    const TaxelSkin skin = scattered(part);
    for (const auto& row : taxel_rows(points, skin, Eigen::Matrix3d::Identity())) {
      if (!(row.spacing > 0.0)) {
        EXPECT_EQ(row.error, 0.0);
        EXPECT_EQ(row.normal_stress, 0.0);
        continue;
      }
      EXPECT_NEAR(row.spacing * count / radius, 1.0, 0.3);
      EXPECT_LT(row.error, 0.3 * peak);
      const double off = row.normal_stress - peak * mean_of(peaked_law, row.place, part);
      covered += std::abs(off) <= std::max(2.0 * row.error, 0.003 * peak);
      ++all;
    }
  }
  EXPECT_GE(covered, 9 * all / 10) << "of " << all;
}

/// What the pressures are known to be off, where a taxel touches; what the particles resolve.
TEST(TaxelRows, KnowTheErrorOfTheField) {
  auto points = hertz(6, 0.3);
  for (ContactPoint& point : points) point.sample = 2;
  TaxelSkin skin = grid(3e-3, 3e-3, 0.4e-3);
  const auto rows = taxel_rows(points, skin, Eigen::Matrix3d::Identity(), {{5.0, 40.0}, 0.7e-3});
  ASSERT_EQ(rows.size(), 9u);
  EXPECT_NEAR(rows[4].error, 40.0, 1.0);
  EXPECT_EQ(rows[4].spacing, 0.7e-3);
  EXPECT_EQ(rows[0].error, 0.0);
  EXPECT_EQ(rows[0].spacing, 0.0);
  EXPECT_EQ(meshes::coarsest_spacing(rows), 0.7e-3);
  skin.depth = 1e-3;
  for (const auto& row : taxel_rows(points, skin, Eigen::Matrix3d::Identity(), {{}, 0.7e-3}))
    EXPECT_TRUE(std::isnan(row.error) && std::isnan(row.spacing));
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

/// Below a load on the surface (Johnson, Contact Mechanics, equation 3.19) sigma_z is
/// 3 P z³/(2 pi r⁵); over a disc of radius a under it the mean is P/(pi a²) (1 - (z/sqrt(a² +
/// z²))³).
TEST(TaxelReadings, BelowALoadAreMeansInClosedForm) {
  ContactPoint load{.area = 1e-14};
  load.normal = -Vector3::UnitZ();
  load.set_force({0.0, 0.0, -1e-3});
  const double a = 0.5e-3;
  for (const double z : {0.25e-3, 0.5e-3, 1e-3, 2e-3}) {
    const TaxelSkin skin{
        .taxels = {{Vector3::Zero(), Vector3::UnitZ(), 0.0}}, .depth = z, .footprint = 2.0 * a};
    const double mean = 1e-3 / (pi * a * a) * (1.0 - std::pow(z / std::hypot(a, z), 3));
    EXPECT_NEAR(meshes::taxel_readings(std::vector{load}, skin).at(0).normal_stress, mean,
                0.05 * mean)
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
