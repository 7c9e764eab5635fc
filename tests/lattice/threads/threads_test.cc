// Whole presses give the same bits on any number of threads: contact that grows, searches of the
// spectrum, every integrator of the explicit kind.
#include <gtest/gtest.h>

#include <memory>

#include "tests/lattice/finger_scenes.h"

using namespace fingertip;
using namespace fixtures;
using lattice::Integrator;
using lattice::Kinematics;
using lattice::ModelKind;
using meshes::ContactMode;

namespace {

constexpr double speed = 0.1;  // of the rod [m/s]

/// Pressed by 1.5 mm within 15 ms.
std::unique_ptr<lattice::VirtualFinger> pressed(const PressCase& c, int threads) {
  lattice::FingerSetup setup = prescribed_finger(c, threads);
  setup.gravity.y() = 1.0;
  auto finger = std::make_unique<lattice::VirtualFinger>(setup);
  finger->write(advancing(speed));
  for (int period = 0; period < 15; ++period) finger->do_step(1e-3);
  return finger;
}

void expect_same_bits(const PressCase& c) {
  const auto serial = pressed(c, 1);
  EXPECT_GT(serial->finger().touching(), 0);
  for (const int threads : {2, 3}) {
    EXPECT_TRUE(same_bits(*serial, *pressed(c, threads)))
        << label(c.model, c.kinematics) << ", " << name(c.integrator) << ", " << threads;
  }
}

}  // namespace

TEST(Threads, DoNotChangeTheBitsOfSymplecticEuler) {
  const auto integrator = Integrator::symplectic_euler;
  expect_same_bits({ModelKind::network, Kinematics::finite, ContactMode::stick, integrator});
  expect_same_bits({ModelKind::network, Kinematics::finite, ContactMode::coulomb, integrator});
  expect_same_bits({ModelKind::hookean, Kinematics::small, ContactMode::frictionless, integrator});
  expect_same_bits({ModelKind::published, Kinematics::finite, ContactMode::stick, integrator});
}

TEST(Threads, DoNotChangeTheBitsOfScaledMasses) {
  expect_same_bits(
      {ModelKind::network, Kinematics::finite, ContactMode::stick, Integrator::mass_scaled});
}

TEST(Threads, DoNotChangeTheBitsOfAFreeRodThatCarriesItsRubber) {
  const auto pushed = [](int threads) {
    auto finger = std::make_unique<lattice::VirtualFinger>(pushed_finger(
        {ModelKind::network, Kinematics::finite, ContactMode::stick, Integrator::mass_scaled},
        threads));
    finger->write(lattice::Wrench{Vector3(2e-3, 1e-3, 0.04), Vector3(0.0, 1e-5, 0.0)});
    for (int period = 0; period < 40; ++period) finger->do_step(1e-3);
    return finger;
  };
  const auto serial = pushed(1);
  EXPECT_GT(serial->finger().touching(), 0);
  for (const int threads : {2, 3}) EXPECT_TRUE(same_bits(*serial, *pushed(threads))) << threads;
}

TEST(Threads, DoNotChangeTheBitsOfExplicitEuler) {
  expect_same_bits(
      {ModelKind::published, Kinematics::finite, ContactMode::stick, Integrator::explicit_euler});
}
