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
    for (const ContactPoint& point : field) EXPECT_EQ(point.state, meshes::ContactState::stick);
  }
  EXPECT_EQ(compared, 2);
}
