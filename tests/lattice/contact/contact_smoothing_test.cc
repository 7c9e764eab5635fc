#include "lattice/contact/contact_smoothing.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "meshes/press/press_response.h"

using namespace fingertip;
using lattice::TiedPoint;
using meshes::ContactMode;
using meshes::ContactPoint;
using meshes::Vector3;

namespace {

constexpr double ball = 4.0;   ///< radius of the obstacle
constexpr int per_cell = 3;    ///< points along each side of a cell
constexpr int particles = 40;  ///< along each side of the grid

double hertz(double x, double y) {
  return std::sqrt(std::max(1.0 - x * x - y * y, 0.0));
}

meshes::ContactPatch hertz_patch() {
  meshes::ContactPatch patch{1.0, 1.0};
  patch.ellipse.setIdentity();
  patch.is_fine = true;
  return patch;
}

const lattice::ContactLaw without(ContactMode::frictionless), sticks(ContactMode::stick);

/// A contact of radius 1 on a ball: nine points in each cell of a grid of `spacing`, on the first
/// quadrant or all around, each with the force of Hertz's pressure, peak 1, and `friction` times
/// that along x.
std::vector<TiedPoint> points_of(double spacing, double friction, bool quarter = false) {
  std::vector<TiedPoint> points;
  const int cells = int(std::ceil(1.2 / spacing));
  for (int i = quarter ? 0 : -cells; i < cells; ++i)
    for (int j = quarter ? 0 : -cells; j < cells; ++j)
      for (int m = 0; m < per_cell * per_cell; ++m) {
        const double u = (m % per_cell + 0.5) / per_cell, v = (m / per_cell + 0.5) / per_cell;
        const double x = (i + u) * spacing, y = (j + v) * spacing;
        TiedPoint& tied = points.emplace_back();
        for (std::uint32_t c = 0; c < 8; ++c) {
          const std::uint32_t right = c & 1, up = c >> 1 & 1;
          tied.particles[c] = (std::uint32_t(j + particles / 2) + up) * particles +
                              std::uint32_t(i + particles / 2) + right +
                              (c >> 2) * particles * particles;
          tied.weights[c] = 0.5 * (right ? u : 1.0 - u) * (up ? v : 1.0 - v);
        }
        ContactPoint& point = tied.point;
        const double height = std::sqrt(ball * ball - x * x - y * y);
        point.place = {x, y, height - ball};
        point.normal = Vector3(-x, -y, -height) / ball;
        point.area = std::pow(spacing / per_cell, 2);
        point.normal_traction = hertz(x, y);
        const Vector3 along = Vector3::UnitX() - point.normal.x() * point.normal;
        point.shear = friction * point.normal_traction * along;
      }
  return points;
}

/// Shared out among the points of each cell as chance has it, the particles' loads as they were.
void share_unevenly(std::vector<TiedPoint>& points) {
  std::mt19937 generator(3);
  std::normal_distribution<double> normal;
  constexpr std::size_t count = per_cell * per_cell;
  for (std::size_t first = 0; first < points.size(); first += count) {
    Eigen::MatrixXd weights(8, count);
    Eigen::VectorXd noise(count);
    for (std::size_t m = 0; m < count; ++m) {
      noise[Eigen::Index(m)] = normal(generator);
      for (std::size_t c = 0; c < 8; ++c)
        weights(Eigen::Index(c), Eigen::Index(m)) = points[first + m].weights[c];
    }
    noise -= weights.completeOrthogonalDecomposition().solve(weights * noise);
    for (std::size_t m = 0; m < count; ++m)
      if (points[first + m].touches())
        points[first + m].point.normal_traction += 0.3 * noise[Eigen::Index(m)];
  }
}

std::vector<ContactPoint> touching(const std::vector<TiedPoint>& points) {
  std::vector<ContactPoint> found;
  for (const TiedPoint& tied : points)
    if (tied.touches()) found.push_back(tied.point);
  return found;
}

void expect_same_sums(const std::vector<ContactPoint>& points,
                      const std::vector<ContactPoint>& others) {
  for (const Vector3& about : {Vector3(0.0, 0.0, 0.0), Vector3(0.4, -2.0, -5.0)}) {
    const auto sums = sums_of(points, about), expected = sums_of(others, about);
    const double scale = expected.force.norm();
    EXPECT_LT((sums.force - expected.force).norm(), 1e-13 * scale);
    EXPECT_LT((sums.torque - expected.torque).norm(), 1e-13 * scale * (1.0 + about.norm()));
  }
}

/// Root mean square over the contact.
double error(const std::vector<ContactPoint>& points) {
  double sum = 0.0, area = 0.0;
  for (const ContactPoint& point : points) {
    const double off = point.normal_traction - hertz(point.place.x(), point.place.y());
    sum += point.area * off * off;
    area += point.area;
  }
  return std::sqrt(sum / area);
}

}  // namespace

TEST(ContactField, KeepsForceAndTorque) {
  for (const double friction : {0.0, 0.4}) {
    auto points = points_of(0.2, friction);
    share_unevenly(points);
    const auto field = contact_field(
        points, hertz_patch(), 1,
        friction > 0.0 ? lattice::ContactLaw(ContactMode::coulomb, friction) : without);
    expect_same_sums(field, touching(points));
    for (const ContactPoint& point : field) {
      EXPECT_GT(point.normal_traction, 0.0);
      EXPECT_LT(std::abs(point.shear.dot(point.normal)), 1e-14);
      if (friction == 0.0) {
        EXPECT_TRUE(point.shear.isZero(0.0));
      }
    }
  }
}

/// What points of a cell bear among themselves does not matter.
TEST(ContactField, IsThatOfTheParticles) {
  const auto even = points_of(0.15, 0.3);
  for (const meshes::ContactPatch& patch :
       {hertz_patch(), meshes::ContactPatch{1.0, meshes::unknown}}) {
    auto points = even;
    share_unevenly(points);
    const auto field = contact_field(even, patch, 1, sticks),
               other = contact_field(points, patch, 1, sticks);
    ASSERT_EQ(field.size(), other.size());
    for (std::size_t i = 0; i < field.size(); ++i) {
      if (field[i].place.head<2>().norm() > 0.6) continue;
      EXPECT_NEAR(field[i].normal_traction, other[i].normal_traction, 0.01);
    }
  }
}

/// Mindlin's tractions: beyond a radius c they are mu p. A tie slides where its own load holds
/// less.
TEST(ContactField, SticksWhereMindlinHasIt) {
  constexpr double mu = 0.4;
  const auto area_of_slip = [](const std::vector<ContactPoint>& points) {
    double area = 0.0;
    for (const ContactPoint& point : points)
      area += point.state == meshes::ContactState::slip ? point.area : 0.0;
    return area / std::numbers::pi;
  };
  for (const double c : {0.9, 0.7, 0.5}) {
    auto points = points_of(0.12, mu);
    share_unevenly(points);
    for (TiedPoint& tied : points) {
      ContactPoint& point = tied.point;
      if (!tied.touches()) continue;
      point.normal_traction = std::max(point.normal_traction, 0.01);
      const double r = point.place.head<2>().norm();
      const double held = mu * (hertz(r, 0.0) - c * hertz(r / c, 0.0));
      const bool slips = r > c || held > mu * point.normal_traction;
      point.shear.normalize();
      point.shear *= slips ? mu * point.normal_traction : held;
      point.state = slips ? meshes::ContactState::slip : meshes::ContactState::stick;
    }
    const double slips =
        area_of_slip(contact_field(points, hertz_patch(), 1, {ContactMode::coulomb, mu}));
    EXPECT_NEAR(std::sqrt(1.0 - slips), c, 0.05) << "ties: " << area_of_slip(touching(points));
    EXPECT_GT(area_of_slip(touching(points)), slips);
  }
}

/// However unevenly the ties share their load: sliding along, turning on the spot, turning about a
/// place beside, and sliding in part. On a ball normals differ from point to point.
TEST(ContactField, ShearsNoMoreThanFrictionAllows) {
  constexpr double mu = 0.4;
  const auto along = [](const Vector3&) { return Vector3::UnitX().eval(); };
  const auto about = [](double x) {
    return [x](const Vector3& place) {
      return Vector3(-place.y(), place.x() - x, 0.0).normalized().eval();
    };
  };
  const std::vector<std::function<Vector3(const Vector3&)>> ways{along, about(0.0), about(0.4),
                                                                 about(3.0)};
  for (const bool noisy : {false, true})
    for (const double spacing : {0.12, 0.25})
      for (const double share : {1.0, 0.6})
        for (const auto& way : ways) {
          auto points = points_of(spacing, 0.0);
          if (noisy) share_unevenly(points);
          for (TiedPoint& tied : points) {
            ContactPoint& point = tied.point;
            point.normal_traction = std::max(point.normal_traction, 0.0);
            const Vector3 direction = way(point.place);
            const double r = point.place.head<2>().norm();
            point.shear = direction - direction.dot(point.normal) * point.normal;
            point.shear.normalize();
            point.shear *= mu * point.normal_traction * (r < 0.5 ? share : 1.0);
            point.state = meshes::ContactState::slip;
          }
          const auto patch = lattice::tied_patch(points, 1);
          const auto field = contact_field(points, patch, 1, {ContactMode::coulomb, mu});
          expect_same_sums(field, touching(points));
          double most = 0.0;
          for (const ContactPoint& point : field)
            most = std::max(most, point.shear.norm() / (mu * point.normal_traction));
          EXPECT_LE(most, 1.0 + 1e-9) << noisy << " " << spacing << " " << share;
          EXPECT_GT(most, 0.99);
        }
}

/// Radius, area and peak are those of the field, and the ellipse's where there is one.
TEST(ContactField, HasThePatchsArea) {
  for (const double spacing : {0.1, 0.17, 0.3}) {
    auto points = points_of(spacing, 0.3);
    share_unevenly(points);
    const auto patch = lattice::tied_patch(points, 1);
    ASSERT_TRUE(patch.is_ellipse());
    const auto field = contact_field(points, 1, sticks);
    EXPECT_NEAR(contact_radius(field), patch.radius, 1e-12) << spacing;
    EXPECT_NEAR(largest_pressure(field), 1.0, 0.03) << spacing;
    const auto own = contact_patch(field);
    EXPECT_TRUE(own.is_ellipse());
    EXPECT_NEAR(own.radius, patch.radius, 0.02) << spacing;
  }
}

/// Ties with the forces of Hertz on the squares around them, some of which its edge cuts.
TEST(ContactField, OfHertzIsHertz) {
  const auto error_at = [](double spacing, const meshes::ContactPatch& patch) {
    auto points = points_of(spacing, 0.0);
    constexpr int parts = 20;
    const double width = spacing / per_cell;
    for (TiedPoint& tied : points) {
      double sum = 0.0;
      for (int i = 0; i < parts * parts; ++i) {
        const double right = (i % parts + 0.5) / parts - 0.5, up = (i / parts + 0.5) / parts - 0.5;
        sum += hertz(tied.point.place.x() + right * width, tied.point.place.y() + up * width);
      }
      tied.point.normal_traction = sum / (parts * parts);
    }
    return error(contact_field(points, patch, 1, without));
  };
  EXPECT_LT(error_at(0.15, hertz_patch()), 6e-3);
  EXPECT_LT(error_at(0.3, hertz_patch()), 1e-2);
  // Without a profile the edge is that of the points.
  const meshes::ContactPatch none{1.0, meshes::unknown};
  const double coarse = error_at(0.15, none), fine = error_at(0.075, none);
  EXPECT_LT(coarse, 0.06);
  EXPECT_LT(fine, 0.6 * coarse);
}

/// A contact of which a quarter is computed.
TEST(ContactField, OfAQuarterIsTheWhole) {
  const auto whole = contact_field(points_of(0.2, 0.0), hertz_patch(), 1, without),
             quarter = contact_field(points_of(0.2, 0.0, true), hertz_patch(), 4, without);
  ASSERT_EQ(whole.size(), quarter.size());
  for (const ContactPoint& point : quarter) {
    const auto found = std::ranges::find_if(whole, [&](const ContactPoint& other) {
      return (other.place - point.place).norm() < 1e-12;
    });
    ASSERT_NE(found, whole.end());
    EXPECT_NEAR(found->normal_traction, point.normal_traction, 1e-12);
  }
}

/// Fewer points than six sums need: none, one, two, some in a line; an ellipse between them.
TEST(ContactField, OfFewPoints) {
  EXPECT_TRUE(contact_field(std::vector<TiedPoint>{}, hertz_patch(), 1, sticks).empty());
  meshes::ContactPatch narrow = hertz_patch();
  narrow.ellipse(1, 1) = 1e12;
  narrow.centre.y() = 0.01;
  std::vector<TiedPoint> points;
  for (std::uint32_t i = 0; i < 5; ++i) {
    TiedPoint& tied = points.emplace_back();
    tied.particles.fill(i);
    tied.weights[0] = 1.0;
    tied.point.place = {0.1 * i, 0.0, 0.0};
    tied.point.area = 0.01;
    tied.point.normal_traction = 1.0 + i % 2;
    tied.point.shear = {0.3, 0.1 * i, 0.0};
    for (const auto& patch : {hertz_patch(), narrow, meshes::ContactPatch{}}) {
      const auto field = contact_field(points, patch, 1, sticks);
      expect_same_sums(field, touching(points));
      for (std::size_t j = 0; j <= i; ++j)  // a particle itself
        EXPECT_LT((field[j].force() - points[j].point.force()).norm(), 1e-15);
    }
  }
}
