/// The contact fields of presses, at rest and in motion.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "meshes/press/contact_map.h"
#include "meshes/press/contact_patch.h"
#include "meshes/press/limit_surface.h"
#include "tests/expectations.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::ContactDifference;
using meshes::ContactMode;
using meshes::ContactPoint;
using meshes::PressSample;
using meshes::Vector3;

namespace {

using Field = std::vector<ContactPoint>;

/// Per indentation, of tests/fem_reference/data/press_linear_contact.csv.
std::map<double, Field> continuum(ContactMode contact) {
  std::map<double, Field> fields;
  std::ifstream file(FINGERTIP_TEST_DATA "/press_linear_contact.csv");
  for (std::string line; std::getline(file, line);) {
    for (char& c : line) c = c == ',' ? ' ' : c;
    std::istringstream cells(line);
    std::string kind;
    ContactPoint ring;
    double shear = 0.0;
    if (!(cells >> kind >> ring.indentation >> ring.place.x() >> ring.area >>
          ring.normal_traction >> shear) ||
        kind != name(contact))
      continue;
    ring.shear.x() = shear;
    for (const ContactPoint& point : turned_around(ring, 36))
      fields[ring.indentation].push_back(point);
  }
  return fields;
}

/// From the two innermost rings: p² goes with r² there.
double pressure_in_the_middle(const Field& rings) {
  std::map<double, double> square;
  for (const ContactPoint& point : rings)
    square[point.place.head<2>().squaredNorm()] = std::pow(point.normal_traction, 2);
  const auto [first, inner] = *square.begin();
  const auto [second, outer] = *square.upper_bound(1.01 * first);
  return std::sqrt(inner + (inner - outer) / (second - first) * first);
}

Field at_sample(const std::vector<ContactPoint>& contact, std::size_t sample) {
  Field field;
  for (const ContactPoint& point : contact)
    if (std::size_t(point.sample) == sample) field.push_back(point);
  return field;
}

ContactDifference difference(const Field& field, const Field& first) {
  const std::array<std::span<const ContactPoint>, 2> both{field, first};
  const meshes::Raster raster = meshes::raster_around(both, 101);
  return difference_of(contact_map(field, raster), contact_map(first, raster));
}

/// Force and torque about the rod's endpoint, along the field's axes, of every sample.
void expect_sums(const PressSetup& setup, const std::vector<PressSample>& samples,
                 const std::vector<ContactPoint>& contact, double tolerance) {
  const Eigen::Matrix3d axes =
      lattice::field_axes(lattice::press_plane(setup.protocol, setup.geometry).normal);
  const Vector3 endpoint = axes.transpose() * setup.geometry.rod_endpoint();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const PressSample& sample = samples[i];
    const auto sums = sums_of(at_sample(contact, i + 1), endpoint);
    const Vector3 force(sample.lateral_force_x, sample.lateral_force_y, -sample.normal_force),
        torque = axes.transpose() * Vector3(sample.torque_x, sample.torque_y, sample.torque_z);
    EXPECT_LT((sums.force - force).norm(), tolerance * force.norm()) << i;
    EXPECT_LT((sums.torque - torque).norm(), tolerance * force.norm() * setup.geometry.rod_length)
        << i;
  }
}

}  // namespace

TEST(PressContact, IsTheContinuums) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    const auto truth = continuum(contact);
    ASSERT_EQ(truth.size(), 4U);
    for (const double per_radius : {8.0, 12.0, 16.0}) {
      const PressSetup setup = presses::setup_of({.model = ModelKind::hookean,
                                                  .per_radius = per_radius,
                                                  .contact = contact,
                                                  .samples = {0.5e-3, 1e-3, 2e-3, 3e-3}});
      const auto outcome = lattice::run_static_press(setup);
      double radius = 0.0;
      for (std::size_t i = 0; i < outcome.response.samples().size(); ++i) {
        const PressSample& sample = outcome.response.samples()[i];
        const Field field = at_sample(outcome.contact, i + 1);
        ASSERT_FALSE(field.empty());
        const ContactDifference d = difference(field, truth.at(sample.indentation));
        SCOPED_TRACE(std::string(name(contact)) + " R/" + std::to_string(int(per_radius)) + " " +
                     std::to_string(sample.indentation));
        const double cells = sample.contact_radius / setup.lattice.spacing;
        EXPECT_LT(d.pressure_l2, cells < 6.0 ? 0.04 : 0.02);
        EXPECT_LT(d.shear_l2, cells < 6.0 ? 0.04 : 0.03);
        EXPECT_LT(std::abs(d.peak), 0.05);
        EXPECT_LT(std::abs(d.radius) * cells, 0.25);
        EXPECT_LT(d.centre, 1e-3 * sample.contact_radius);
        EXPECT_LT(std::abs(largest_pressure(field) /
                               pressure_in_the_middle(truth.at(sample.indentation)) -
                           1.0),
                  cells < 3.0 ? 0.06 : 0.03);
        const double own = contact_patch(field).radius;
        EXPECT_NEAR(own, sample.contact_radius, 0.06 * setup.lattice.spacing);
        EXPECT_GT(own, radius);
        radius = own;
      }
    }
  }
}

TEST(PressContact, AddsUpToForceAndTorque) {
  struct Case {
    ContactMode contact;
    double tilt, lateral;
    bool ball;
  };
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite})
    for (const Case& c : {Case{ContactMode::frictionless, 0.0, 0.0, false},
                          {ContactMode::frictionless, 0.2, 0.0, false},
                          {ContactMode::stick, 0.1, 3e-4, false},
                          {ContactMode::frictionless, 0.0, 0.0, true},
                          {ContactMode::stick, 0.0, 0.0, true}}) {
      PressSetup setup = presses::setup_of({.model = ModelKind::network,
                                            .per_radius = 6,
                                            .contact = c.contact,
                                            .samples = {0.7e-3, 1.5e-3},
                                            .kinematics = kinematics});
      setup.protocol.tilt = c.tilt;
      setup.protocol.lateral = c.lateral;
      if (c.ball) {
        setup.protocol.obstacle.shape = meshes::ObstacleShape::sphere;
        setup.protocol.obstacle.radius = 6e-3;
        setup.protocol.obstacle.offset = 1e-3;
      }
      SCOPED_TRACE(std::string(name(c.contact)) + (c.ball ? " ball" : " plane") +
                   (kinematics == Kinematics::finite ? " finite" : " small"));
      const auto outcome = lattice::run_static_press(setup);
      expect_sums(setup, outcome.response.samples(), outcome.contact, 1e-7);
      for (const ContactPoint& point : outcome.contact) {
        EXPECT_GT(point.normal_traction, 0.0);
        if (c.contact == ContactMode::frictionless) {
          EXPECT_TRUE(point.shear.isZero(0.0));
          EXPECT_EQ(point.state, meshes::ContactState::slip);
        }
      }
    }
}

/// Area, radius, mean and largest pressure of a row are those of its field, whatever touches.
TEST(PressContact, RowsAreOfTheirField) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite})
    for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick})
      for (const double per_radius : {5.0, 9.0})
        for (const bool ball : {false, true}) {
          PressSetup setup = presses::setup_of({.model = ModelKind::network,
                                                .per_radius = per_radius,
                                                .contact = contact,
                                                .samples = {0.4e-3, 1.5e-3},
                                                .kinematics = kinematics});
          setup.protocol.tilt = ball ? 0.0 : 0.1;
          if (ball) {
            setup.protocol.obstacle.shape = meshes::ObstacleShape::sphere;
            setup.protocol.obstacle.radius = 6e-3;
          }
          const auto outcome = lattice::run_static_press(setup);
          const auto& samples = outcome.response.samples();
          for (std::size_t i = 0; i < samples.size(); ++i) {
            const Field field = at_sample(outcome.contact, i + 1);
            double area = 0.0, largest = 0.0;
            for (const ContactPoint& point : field) {
              area += point.area * std::abs(point.normal.z());
              largest = std::max(largest, point.normal_traction);
            }
            EXPECT_NEAR(samples[i].contact_area, area, 1e-12 * area);
            EXPECT_NEAR(samples[i].mean_pressure, samples[i].normal_force / area,
                        1e-9 * samples[i].mean_pressure);
            EXPECT_GE(samples[i].max_pressure, largest);
            EXPECT_LT(samples[i].max_pressure, (i == 0 ? 1.1 : 1.02) * largest);
            EXPECT_NEAR(limit_surface(field).radius, samples[i].contact_radius,
                        1e-12 * samples[i].contact_radius);
          }
        }
}

/// A soft pad with a flat face, sharp or rounded at its rim: no ellipse. 6.68 kPa is the
/// continuum's (fingertip reference, tolerance 0.001).
TEST(PressContact, OfAPadIsItsFace) {
  using enum meshes::ProfileSurface;
  const double R = 0.01, rim = 1e-3;
  const auto sharp = meshes::Geometry::of_profile(
                 {{0.0, R, contact}, {R, R, free}, {R, 0.0, bond}, {0.0, 0.0, axis}}),
             rounded = meshes::Geometry::of_profile(
                 {{0.0, R, contact},
                  {R - rim, R, contact, meshes::ProfileCurve::arc, R - rim, R - rim},
                  {R, R - rim, free},
                  {R, 0.0, bond},
                  {0.0, 0.0, axis}});
  const auto press = [](const meshes::Geometry& geometry, double depth, double per_radius) {
    PressSetup setup = presses::setup_of({.model = ModelKind::hookean,
                                          .per_radius = per_radius,
                                          .contact = ContactMode::frictionless,
                                          .samples = {depth},
                                          .geometry = geometry});
    setup.rubber.youngs_modulus = 1e5;
    setup.rubber.shear_modulus = 1e5 / 2.9;
    setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
    return lattice::run_static_press(setup);
  };
  for (const double per_radius : {8.0, 12.0}) {
    auto flat = press(sharp, 0.5e-3, per_radius);
    const PressSample& sample = flat.response.back();
    EXPECT_NEAR(sample.contact_radius, R, 1e-3 * R) << per_radius;
    EXPECT_NEAR(sample.max_pressure, 6680.0, 0.05 * 6680.0) << per_radius;
    EXPECT_FALSE(contact_patch(flat.contact).is_ellipse());
    auto round = press(rounded, 1.67e-5, per_radius);
    // The rim bears most; there no lattice resolves the pressure.
    EXPECT_NEAR(round.response.back().contact_radius, R - rim, 0.6 * R / per_radius) << per_radius;
    EXPECT_GT(round.response.back().max_pressure, 500.0) << per_radius;
    EXPECT_FALSE(contact_patch(round.contact).is_ellipse());
  }
}

/// However small friction is, what slid in the last step slips, and no shear exceeds mu p.
TEST(PressContact, SlipsAllOver) {
  for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite})
    for (const double mu : {0.3, 1e-2, 1e-4, 1e-6}) {
      SCOPED_TRACE(std::to_string(mu) + (kinematics == Kinematics::finite ? " finite" : " small"));
      PressSetup setup = presses::setup_of({.model = ModelKind::network,
                                            .per_radius = 6,
                                            .contact = ContactMode::coulomb,
                                            .samples = {1e-3},
                                            .kinematics = kinematics});
      setup.protocol.friction = mu;
      setup.protocol.lateral = 1.2e-3;
      setup.protocol.lateral_path = meshes::LateralPath::after;
      setup.protocol.lateral_samples = 1;
      auto outcome = lattice::run_static_press(setup);
      const PressSample& last = outcome.response.back();
      EXPECT_NEAR(std::hypot(last.lateral_force_x, last.lateral_force_y), mu * last.normal_force,
                  (1e-3 * mu + 1e-8) * last.normal_force);  // 1e-8: the solver
      double slips = 0.0, area = 0.0;
      for (const ContactPoint& point :
           at_sample(outcome.contact, outcome.response.samples().size())) {
        area += point.area;
        slips += point.state == meshes::ContactState::slip ? point.area : 0.0;
        EXPECT_LE(point.shear.norm(), (1.0 + 1e-9) * mu * point.normal_traction);
      }
      EXPECT_GT(slips, 0.999 * area);
    }
}

/// Not even where symmetry ends: the field of a plane that is hardly tilted is that of one that is
/// not.
TEST(PressContact, IsContinuousInTilt) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    const auto at = [contact](double degrees) {
      PressSetup setup = presses::setup_of(
          {.model = ModelKind::hookean, .per_radius = 10, .contact = contact, .samples = {1.5e-3}});
      setup.protocol.tilt = degrees * std::numbers::pi / 180.0;
      return lattice::run_static_press(setup).contact;
    };
    const Field straight = at(0.0);
    const double radius = contact_patch(straight).radius;
    for (const double degrees : {0.1, 1.0, 5.0}) {
      const Field tilted = at(degrees);
      const ContactDifference d = difference(tilted, straight);
      EXPECT_NEAR(contact_patch(tilted).radius, radius, (degrees < 0.5 ? 2e-3 : 0.015) * radius)
          << degrees;
      if (degrees < 0.5) {
        EXPECT_LT(d.pressure_l2, 0.02) << name(contact);
      }
    }
  }
}

/// Where the rod moves aside the contact stays with it: about the same field as of the press at
/// rest, whose rod stands still.
TEST(PressContact, GoesAsideWithTheRod) {
  PressSetup setup = presses::setup_of({.model = ModelKind::network,
                                        .per_radius = 8,
                                        .contact = ContactMode::frictionless,
                                        .mode = meshes::DriveMode::quasi_static,
                                        .samples = {1.5e-3}});
  setup.protocol.lateral = 3e-3;
  const auto moving = lattice::run_press(setup);
  const Field field = at_sample(moving.contact, moving.response.samples().size());
  ASSERT_FALSE(field.empty());
  const Field resting = lattice::run_static_press(setup).contact;
  const ContactDifference d = difference(field, at_sample(resting, 1));
  EXPECT_LT(d.pressure_l2, 0.05);
  EXPECT_LT(d.centre, 0.1e-3);
}

/// A slow press in time has the field of the press at rest, and its sums are its forces but for
/// what the tip's inertia takes.
TEST(PressContact, OfASlowPressIsThatAtRest) {
  PressSetup setup = presses::setup_of({.model = ModelKind::hookean,
                                        .per_radius = 8,
                                        .contact = ContactMode::stick,
                                        .mode = meshes::DriveMode::quasi_static,
                                        .samples = {0.5e-3, 1e-3}});
  const auto moving = lattice::run_press(setup);
  const auto& rows = moving.response.samples();
  const auto resting = lattice::run_static_press(setup);
  int compared = 0;
  for (std::size_t row = 1; row <= rows.size(); ++row) {
    const Field field = at_sample(moving.contact, row);
    if (field.empty()) continue;
    ++compared;
    const PressSample& sample = rows[row - 1];
    EXPECT_NEAR(-sums_of(field, Vector3::Zero()).force.z(), sample.normal_force,
                0.02 * sample.normal_force);
    const Field other = at_sample(resting.contact, std::size_t(compared));
    EXPECT_LT(difference(field, other).pressure_l2, 0.02) << sample.indentation;
    // Of the end of a step, brought back to the depth that was asked for.
    EXPECT_NEAR(sample.contact_radius, contact_radius(field), 5e-3 * sample.contact_radius);
    EXPECT_NEAR(sample.max_pressure, largest_pressure(field), 1e-2 * sample.max_pressure);
    for (const ContactPoint& point : field) EXPECT_EQ(point.state, meshes::ContactState::stick);
  }
  EXPECT_EQ(compared, 2);
}
