// Presses of triangulated solids.
#include <gtest/gtest.h>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "tests/fingers.h"

using namespace fingertip;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::PressSetup;
using meshes::ContactMode;
using meshes::DriveMode;
using meshes::Geometry;

namespace {

PressSetup press_of(const Geometry& geometry, ModelKind model, double per_radius = 8) {
  PressSetup setup;
  setup.geometry = geometry;
  setup.lattice.model = model;
  setup.lattice.kinematics =
      model == ModelKind::hookean ? Kinematics::small : Kinematics::finite;
  setup.lattice.spacing = 0.01 / per_radius;
  setup.lattice.constants = model == ModelKind::published
                                ? lattice::published_constants(setup.rubber, setup.lattice.spacing)
                                : lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.contact = ContactMode::stick;
  setup.protocol.mode = DriveMode::equilibrium;
  setup.protocol.samples = {1e-3, 2e-3, 3e-3};
  setup.protocol.depth = 3e-3;
  return setup;
}

TEST(SolidPress, TrianglesOfTheDomeAreTheDomeAtRest) {
  const Geometry solid = fingers::solid_dome();
  for (const double tilt : {0.0, 0.2}) {
    PressSetup dome = press_of(Geometry{}, ModelKind::hookean);
    dome.protocol.tilt = tilt;
    PressSetup triangles = press_of(solid, ModelKind::hookean);
    triangles.protocol.tilt = tilt;
    const auto expected = lattice::run_static_press(dome).response.samples();
    const auto found = lattice::run_static_press(triangles).response.samples();
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const double force = expected[i].normal_force;
      std::printf("%g %g %g %g\n", tilt, expected[i].indentation, force, found[i].normal_force / force - 1);
      EXPECT_NEAR(found[i].normal_force, force, 5e-3 * force);
      EXPECT_NEAR(found[i].lateral_force_x, expected[i].lateral_force_x, 5e-3 * force);
      EXPECT_NEAR(found[i].torque_y, expected[i].torque_y, 5e-3 * force * 0.03);
    }
  }
}

}  // namespace
