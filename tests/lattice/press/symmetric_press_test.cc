#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>

#include "lattice/press/press.h"
#include "lattice/press/press_task.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::Integrator;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::PressOutcome;
using lattice::PressSetup;
using meshes::ContactMode;
using meshes::DriveMode;

namespace {

struct Case {
  ModelKind model;
  Kinematics kinematics;
  Integrator integrator;
  DriveMode mode;
  ContactMode contact;
  double step;  ///< [s]; 0: chosen
  double tilt = 0.0;
  double gravity = 0.0;  ///< [m/s²]
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << label(c.model, c.kinematics) << ", " << name(c.integrator) << ", " << name(c.mode) << ", "
       << name(c.contact) << (c.tilt == 0.0 ? "" : ", tilted");
}

PressSetup setup_of(const Case& c) {
  PressSetup setup;
  setup.lattice = settings_for(c.model, c.kinematics, 5);
  if (c.model == ModelKind::hookean || c.model == ModelKind::network)
    setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.integrator = c.integrator;
  setup.protocol.mode = c.mode;
  setup.protocol.contact = c.contact;
  setup.protocol.friction = 0.3;
  setup.protocol.tilt = c.tilt;
  setup.protocol.clearance = 2e-4;
  setup.protocol.depth = 2e-3;
  setup.protocol.speed = 0.02;
  setup.protocol.samples = {5e-4, 1e-3, 1.5e-3, 2e-3};
  setup.gravity = c.gravity;
  setup.threads = 1;
  if (c.step > 0.0) setup.time_step = c.step;
  return setup;
}

PressOutcome pressed(PressSetup setup, bool symmetry) {
  setup.symmetry = symmetry;
  return lattice::run_press(setup);
}

/// Forces, patch, energies and shape, relative to the largest of each.
void expect_same(const PressOutcome& part, const PressOutcome& whole, double tolerance) {
  const auto& rows = part.response.samples();
  ASSERT_EQ(rows.size(), whole.response.samples().size());
  const meshes::PressSample& last = whole.response.samples().back();
  for (std::size_t n = 0; n < rows.size(); ++n) {
    const meshes::PressSample& other = whole.response.samples()[n];
    EXPECT_NEAR(rows[n].normal_force, other.normal_force, tolerance * last.normal_force) << n;
    EXPECT_NEAR(rows[n].lateral_force_x, other.lateral_force_x, tolerance * last.normal_force);
    EXPECT_NEAR(rows[n].torque_y, other.torque_y, tolerance * last.normal_force * 0.01);
    EXPECT_NEAR(rows[n].contact_radius, other.contact_radius, tolerance * last.contact_radius);
    if (!std::isnan(last.max_pressure)) {  // of one point of the field, where the others are sums
      EXPECT_NEAR(rows[n].max_pressure, other.max_pressure, 10.0 * tolerance * last.max_pressure);
    }
  }
  ASSERT_EQ(part.trace.size(), whole.trace.size());
  const lattice::TraceRow& end = whole.trace.back();
  for (std::size_t n = 0; n < part.trace.size(); ++n) {
    const lattice::TraceRow &row = part.trace[n], &other = whole.trace[n];
    EXPECT_NEAR(row.plane_force, other.plane_force, tolerance * end.plane_force) << n;
    EXPECT_NEAR(row.elastic_energy, other.elastic_energy, tolerance * end.elastic_energy) << n;
    EXPECT_NEAR(row.kinetic_energy, other.kinetic_energy, tolerance * end.elastic_energy) << n;
    EXPECT_EQ(row.anchored, other.anchored) << n;
    EXPECT_EQ(row.sliding, other.sliding) << n;
  }
  EXPECT_EQ(part.census.particles, whole.census.particles);
  EXPECT_EQ(part.census.springs, whole.census.springs);
  EXPECT_EQ(part.census.mass, whole.census.mass);
  ASSERT_EQ(part.boundary_rest, whole.boundary_rest);
  const lattice::FingerPicture &of_part = part.snapshots.back(), &of_whole = whole.snapshots.back();
  EXPECT_EQ(of_part.held, of_whole.held);
  double apart = 0.0;
  for (std::size_t p = 0; p < of_part.boundary.size(); ++p)
    apart = std::max(apart, (of_part.boundary[p] - of_whole.boundary[p]).norm());
  EXPECT_LT(apart, tolerance * 1e-3);
  EXPECT_EQ(part.snapshots.size(), whole.snapshots.size());
}

class SymmetricPress : public testing::TestWithParam<Case> {};

}  // namespace

/// The same steps lead both the same way, but for the order of sums, of single precision where
/// masses are scaled.
TEST_P(SymmetricPress, OfAPartIsThatOfTheWholeTip) {
  const PressSetup setup = setup_of(GetParam());
  const PressOutcome part = pressed(setup, true), whole = pressed(setup, false);
  EXPECT_EQ(part.sectors, GetParam().tilt == 0.0 ? 4 : 2);
  EXPECT_EQ(whole.sectors, 1);
  ASSERT_GT(whole.response.samples().back().normal_force, 1e-3);
  expect_same(part, whole, GetParam().integrator == Integrator::mass_scaled ? 1e-6 : 1e-8);
  EXPECT_LT(part.momentum_defect, 1e-10);
}

INSTANTIATE_TEST_SUITE_P(
    Models, SymmetricPress,
    testing::Values(Case{ModelKind::hookean, Kinematics::small, Integrator::symplectic_euler,
                         DriveMode::pid, ContactMode::stick, 5e-5, 0.0, 9.81},
                    Case{ModelKind::network, Kinematics::finite, Integrator::symplectic_euler,
                         DriveMode::pid, ContactMode::coulomb, 4e-5, 0.0, 9.81},
                    Case{ModelKind::central, Kinematics::small, Integrator::symplectic_euler,
                         DriveMode::quasi_static, ContactMode::frictionless, 4e-5},
                    Case{ModelKind::published, Kinematics::finite, Integrator::symplectic_euler,
                         DriveMode::pid, ContactMode::stick, 4e-5},
                    Case{ModelKind::published, Kinematics::small, Integrator::explicit_euler,
                         DriveMode::quasi_static, ContactMode::coulomb, 1e-5},
                    Case{ModelKind::hookean, Kinematics::finite, Integrator::symplectic_euler,
                         DriveMode::quasi_static, ContactMode::stick, 4e-5},
                    Case{ModelKind::network, Kinematics::finite, Integrator::symplectic_euler,
                         DriveMode::pid, ContactMode::stick, 4e-5, 0.1},
                    Case{ModelKind::network, Kinematics::finite, Integrator::mass_scaled,
                         DriveMode::pid, ContactMode::stick, 1e-3},
                    Case{ModelKind::hookean, Kinematics::small, Integrator::mass_scaled,
                         DriveMode::quasi_static, ContactMode::frictionless, 5e-4, 0.0, 9.81},
                    Case{ModelKind::network, Kinematics::finite, Integrator::mass_scaled,
                         DriveMode::pid, ContactMode::coulomb, 5e-4, 0.1}));

/// Steps that errors or energies choose: the same within what these leave open.
TEST(SymmetricPress, IsThatOfTheWholeTipWhateverTakesTheSteps) {
  const auto deviation = [](const PressSetup& setup, double from) {
    const PressOutcome part = pressed(setup, true), whole = pressed(setup, false);
    EXPECT_EQ(part.sectors, 4);
    double worst = 0.0;
    for (const meshes::PressSample& row : whole.response.samples()) {
      if (row.indentation < from) continue;
      const double own = part.response.normal_force_at(row.indentation);
      worst = std::max(worst, std::abs(own / row.normal_force - 1.0));
    }
    return worst;
  };
  const auto setup_for = [](ModelKind model, Integrator integrator) {
    const bool finite = model == ModelKind::network;
    PressSetup setup = setup_of({model, finite ? Kinematics::finite : Kinematics::small, integrator,
                                 DriveMode::quasi_static, ContactMode::stick, 0.0});
    setup.protocol.depth = 5e-4;
    setup.protocol.samples = {2.5e-4, 5e-4};
    return setup;
  };
  PressSetup accurate = setup_for(ModelKind::hookean, Integrator::runge_kutta);
  accurate.tolerance = 1e-8;
  EXPECT_LT(deviation(accurate, 2e-4), 1e-4);
  EXPECT_LT(deviation(setup_for(ModelKind::network, Integrator::energy_controlled), 2e-4), 1e-4);
  PressSetup relaxing = setup_for(ModelKind::hookean, Integrator::symplectic_euler);
  relaxing.rubber.relaxation.branches = {{0.3, 0.02}};
  relaxing.time_step = 4e-5;
  for (const bool bulk : {true, false}) {
    relaxing.rubber.relaxation.bulk = bulk;
    EXPECT_LT(deviation(relaxing, 2e-4), 1e-8) << bulk;
  }
}

TEST(SymmetricPress, IsTakenWhereAllIsItsOwnMirrorImage) {
  const Case usual{ModelKind::hookean, Kinematics::small,  Integrator::symplectic_euler,
                   DriveMode::pid,     ContactMode::stick, 0.0};
  const auto sectors = [&](auto change) {
    PressSetup setup = setup_of(usual);
    change(setup);
    return lattice::moving_sectors(setup);
  };
  EXPECT_EQ(sectors([](PressSetup&) {}), 4);
  EXPECT_EQ(sectors([](PressSetup& s) { s.protocol.tilt = 0.1; }), 2);
  EXPECT_EQ(sectors([](PressSetup& s) { s.lattice.offset.x() = 0.3; }), 2);
  EXPECT_EQ(sectors([](PressSetup& s) { s.lattice.offset.y() = 0.3; }), 1);
  EXPECT_EQ(sectors([](PressSetup& s) { s.symmetry = false; }), 1);
  EXPECT_EQ(sectors([](PressSetup& s) { s.hardware.torque.noise = 1e-6; }), 1);
  EXPECT_EQ(sectors([](PressSetup& s) {
              s.make_controller = [](const lattice::ControlTask&) {
                return std::unique_ptr<lattice::Controller>();
              };
            }),
            1);
}
