#include "lattice/press/press_setup.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lattice/press/press.h"
#include "lattice/press/static_press.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using meshes::ContactMode;

namespace {

using Keys = std::vector<std::string>;

lattice::PressSetup valid_setup() {
  lattice::PressSetup setup;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  return setup;
}

std::vector<std::string> keys_of(const std::vector<meshes::Violation>& violations) {
  std::vector<std::string> keys;
  for (const meshes::Violation& violation : violations) keys.push_back(violation.key);
  return keys;
}

}  // namespace

TEST(PressSetup, TheDefaultIsValid) {
  EXPECT_TRUE(valid_setup().violations().empty());
}

TEST(PressSetup, SlidesMovingAndAtRestAndTwistsAtRestAlone) {
  lattice::PressSetup setup = valid_setup();
  setup.protocol.contact = ContactMode::coulomb;
  for (const lattice::ModelKind kind : fixtures::all_models) {
    setup.lattice.model = kind;
    EXPECT_TRUE(setup.violations().empty()) << name(kind);
    setup.protocol.twist = 0.1;
    EXPECT_EQ(keys_of(setup.violations()), Keys{"press.twist"}) << name(kind);
    setup.protocol.mode = meshes::DriveMode::equilibrium;
    EXPECT_TRUE(setup.violations().empty()) << name(kind);
    setup.protocol.mode = meshes::DriveMode::pid;
    setup.protocol.twist = 0.0;
  }
}

TEST(PressSetup, OnlyThePublishedModelIsPressedStraightOnAStraightGrid) {
  lattice::PressSetup setup = valid_setup();
  setup.protocol.tilt = -0.1;
  setup.protocol.lateral = 1e-3;
  setup.lattice.axes << 0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  for (const lattice::ModelKind kind : fixtures::cell_models) {
    setup.lattice.model = kind;
    EXPECT_TRUE(setup.violations().empty()) << name(kind);
  }
  setup.lattice.model = lattice::ModelKind::published;
  EXPECT_EQ(keys_of(setup.violations()), (Keys{"press.tilt", "press.lateral", "lattice.rotation"}));
  setup.protocol.mode = meshes::DriveMode::equilibrium;
  EXPECT_EQ(keys_of(setup.violations()), Keys{"lattice.rotation"});
}

TEST(PressSetup, RelaxesInTimeAndWhereItsCellsCan) {
  using lattice::Kinematics;
  using lattice::ModelKind;
  lattice::PressSetup usual = valid_setup();
  usual.rubber.relaxation = {{{0.3, 0.1}}, true};
  EXPECT_TRUE(usual.violations().empty());
  const auto refused = [](const lattice::PressSetup& setup) {
    return keys_of(setup.violations()) == Keys{"rubber.relaxation"};
  };
  lattice::PressSetup setup = usual;
  setup.protocol.mode = meshes::DriveMode::equilibrium;
  EXPECT_TRUE(refused(setup));
  setup = usual;
  setup.lattice.model = ModelKind::published;
  EXPECT_TRUE(refused(setup));
  setup = usual;
  setup.lattice.kinematics = Kinematics::finite;
  EXPECT_TRUE(refused(setup));
  setup.lattice.model = ModelKind::network;
  EXPECT_TRUE(setup.violations().empty());
  setup.integrator = lattice::Integrator::energy_controlled;
  EXPECT_TRUE(refused(setup));
  setup.integrator = lattice::Integrator::runge_kutta;
  EXPECT_TRUE(setup.violations().empty());
  setup.rubber.relaxation.bulk = false;
  EXPECT_TRUE(refused(setup));
  setup = usual;
  setup.lattice.model = ModelKind::central;
  EXPECT_TRUE(setup.violations().empty());
  setup.rubber.relaxation.bulk = false;
  EXPECT_TRUE(refused(setup));
}

TEST(PressSetup, AMovingRodDoesNotTurnACorner) {
  lattice::PressSetup setup = valid_setup();
  setup.protocol.lateral_path = meshes::LateralPath::after;
  EXPECT_TRUE(setup.violations().empty()) << "there is no corner without lateral motion";
  setup.protocol.lateral = 1e-3;
  for (const auto mode : {meshes::DriveMode::pid, meshes::DriveMode::quasi_static}) {
    setup.protocol.mode = mode;
    ASSERT_EQ(keys_of(setup.violations()), Keys{"press.lateral_path"});
    EXPECT_EQ(setup.violations()[0].value, "after");
    EXPECT_NE(setup.violations()[0].remedy.find("press.mode = static"), std::string::npos);
  }
  setup.protocol.mode = meshes::DriveMode::equilibrium;
  EXPECT_TRUE(setup.violations().empty());
}

TEST(PressSetup, TheGridsAxesAreARotation) {
  lattice::PressSetup setup = valid_setup();
  for (const double x : {-1.0, 1.1, std::nan("")}) {
    setup.lattice.axes(0, 0) = x;
    EXPECT_EQ(keys_of(setup.violations()), Keys{"lattice.rotation"}) << x;
  }
}

TEST(PressSetup, TiesMustNeitherVanishNorHideTheRubber) {
  for (const double factor : {0.0, 1e-4, 1e7, -1.0, std::nan("")}) {
    lattice::PressSetup setup = valid_setup();
    setup.lattice.ligament_stiffness = factor;
    EXPECT_EQ(keys_of(setup.violations()), Keys{"lattice.ligament_stiffness"}) << factor;
    setup = valid_setup();
    setup.lattice.contact_stiffness = factor;
    EXPECT_EQ(keys_of(setup.violations()), Keys{"lattice.contact_stiffness"}) << factor;
  }
  lattice::PressSetup setup = valid_setup();
  setup.lattice.contact_stiffness = 2.0;
  EXPECT_TRUE(setup.violations().empty());
  setup.lattice.model = lattice::ModelKind::published;
  EXPECT_EQ(keys_of(setup.violations()), Keys{"lattice.contact_stiffness"});
  setup = valid_setup();
  setup.geometry.rod_radius = 0.09 * setup.lattice.spacing;
  EXPECT_EQ(keys_of(setup.violations()), Keys{"lattice.spacing"});
}

TEST(PressSetup, FrictionMattersToCoulombContactAlone) {
  lattice::PressSetup setup = valid_setup();
  for (const ContactMode mode : {ContactMode::stick, ContactMode::frictionless}) {
    setup.protocol.contact = mode;
    setup.protocol.friction = -1.0;
    EXPECT_TRUE(setup.violations().empty()) << name(mode);
  }
}
