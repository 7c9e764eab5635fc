// Presses of other shapes than the dome: a profile in every kind of press.
#include <gtest/gtest.h>

#include <cmath>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "tests/fingers.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::ContactMode;
using meshes::DriveMode;
using meshes::Geometry;

namespace {

/// The paper's finger written as a profile, lifted by `height`.
Geometry dome_as_profile(double height = 0.0) {
  return Geometry::of_profile(fingers::dome({}, height), height - Geometry{}.rod_length);
}

PressSetup press_of(const Geometry& geometry, ModelKind model, DriveMode mode,
                    ContactMode contact = ContactMode::stick, double per_radius = 8) {
  return presses::setup_of({.model = model,
                            .per_radius = per_radius,
                            .contact = contact,
                            .mode = mode,
                            .samples = {5e-4, 1e-3, 2e-3},
                            .geometry = geometry});
}

TEST(ShapePress, ProfileOfTheDomeIsTheDomeAtRest) {
  for (const double tilt : {0.0, 0.2}) {
    for (const ModelKind model : {ModelKind::hookean, ModelKind::network}) {
      if (tilt != 0.0 && model == ModelKind::network) continue;  // the whole tip takes long
      PressSetup dome = press_of(Geometry{}, model, DriveMode::equilibrium);
      dome.protocol.tilt = tilt;
      if (model == ModelKind::network) dome.protocol.samples = {dome.protocol.depth = 5e-4};
      PressSetup profile = dome;
      // Tilted, the plane turns about the origin: the profile's is the dome's only at its height.
      profile.geometry = dome_as_profile(tilt == 0.0 ? 0.02 : 0.0);
      const auto expected = lattice::run_static_press(dome).response.samples();
      const auto found = lattice::run_static_press(profile).response.samples();
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) {
        presses::expect_same_load(found[i], expected[i], 1e-6, 0.03);
        EXPECT_NEAR(found[i].contact_radius, expected[i].contact_radius, 1e-8);
      }
    }
  }
}

TEST(ShapePress, ProfileOfTheDomeIsTheDomeInMotion) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::published}) {
    const PressSetup dome = press_of(Geometry{}, model, DriveMode::quasi_static);
    PressSetup profile = dome;
    profile.geometry = dome_as_profile();
    const auto expected = lattice::run_press(dome);
    const auto found = lattice::run_press(profile);
    EXPECT_EQ(found.census.particles, expected.census.particles);
    for (const double depth : dome.protocol.samples) {
      const double force = expected.response.normal_force_at(depth);
      EXPECT_NEAR(found.response.normal_force_at(depth), force, 1e-5 * force) << name(model);
    }
  }
}

/// A base-held finger holds by all of its base, at whatever height that lies.
TEST(ShapePress, TheBaseHoldsAtAnyHeight) {
  const double R = 0.0125;
  double first = 0.0;
  for (const double up : {0.0, 0.005, -0.0153}) {
    const Geometry geometry = Geometry::of_profile(fingers::solid(R, up));
    PressSetup setup = press_of(geometry, ModelKind::hookean, DriveMode::equilibrium,
                                ContactMode::frictionless, 6);
    setup.protocol.samples = {1e-3};
    setup.protocol.depth = 1e-3;
    const double force = lattice::run_static_press(setup).response.samples().back().normal_force;
    if (first == 0.0) first = force;
    EXPECT_NEAR(force, first, 1e-9 * first) << up;
  }
}

/// A base-held finger: what pushes the plane pushes the hand, whatever holds it, and the force
/// does not depend on where on the axis the origin lies.
TEST(ShapePress, SolidFingerBalances) {
  PressSetup setup = press_of(Geometry::of_profile(fingers::solid()), ModelKind::hookean,
                              DriveMode::pid, ContactMode::frictionless, 6);
  // So much rubber sways at 12 Hz where it is as soft as the paper's: a stiff one, pressed slowly.
  setup.rubber.youngs_modulus *= 25.0;
  setup.rubber.shear_modulus *= 25.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.speed = 4e-3;
  const auto moving = lattice::run_press(setup);
  EXPECT_LT(moving.momentum_defect, 1e-9);
  setup.protocol.mode = DriveMode::equilibrium;
  const auto at_rest = lattice::run_static_press(setup);
  for (const auto& sample : at_rest.response.samples()) {
    const double force = sample.normal_force;
    EXPECT_GT(force, 0.0);
    EXPECT_NEAR(moving.response.normal_force_at(sample.indentation), force, 0.01 * force);
    EXPECT_NEAR(sample.lateral_force_x, 0.0, 1e-9 * force);
  }
}

}  // namespace
