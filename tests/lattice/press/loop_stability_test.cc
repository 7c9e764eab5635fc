#include "lattice/press/loop_stability.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/control/control_loop.h"
#include "lattice/press/press_setup.h"
#include "lattice/press/press_task.h"
#include "lattice/statics/cut_lattice.h"
#include "tests/fingers.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using lattice::HeldVibrations;
using lattice::LoopMotion;
using lattice::Matrix6;
using lattice::PidSettings;
using lattice::PressSetup;

namespace {

constexpr double pi = std::numbers::pi;

PressSetup setup_of(const meshes::Geometry& geometry, int per_radius, double density,
                    double stiffer = 1.0) {
  PressSetup setup = presses::setup_of(
      {.per_radius = double(per_radius), .mode = meshes::DriveMode::pid, .geometry = geometry});
  setup.rubber.youngs_modulus *= stiffer;
  setup.rubber.shear_modulus *= stiffer;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.rod.density = density;
  return setup;
}

LoopMotion predicted(const PressSetup& setup) {
  const auto body = lattice::build_cut_tip(setup.geometry, setup.rubber, setup.lattice, 1);
  return lattice::loop_motion(lattice::rod_body(setup.geometry, setup.rod).inertia_at_endpoint(),
                              lattice::held_vibrations(body, setup.geometry.rod_endpoint()),
                              setup.rubber.retardation_time, setup.controller, 0.0);
}

/// Rate [1/s] at which a moving finger, far from any plane, leaves the place where it is to be,
/// once it has been beside it and turned, so little that it stays small.
double measured_rate(PressSetup setup) {
  setup.protocol.clearance = 0.1;
  const lattice::PressWay way(setup.protocol, setup.geometry);
  lattice::VirtualFinger finger(lattice::finger_setup(setup, way));
  const meshes::Vector3 start = finger.read().pose.position;
  lattice::PidController controller(
      setup.controller, finger.rod_body().inertia_at_endpoint(), [&](double) {
        lattice::Target target;
        target.pose.position = start + meshes::Vector3(1e-14, 0.0, 0.0);
        target.pose.orientation = lattice::rotation_by(meshes::Vector3(0.0, 0.0, 1e-12));
        return target;
      });
  lattice::ControlLoop loop(finger, controller, setup.hardware, setup.controller,
                            setup.controller.period);
  double early = 0.0, late = 0.0;
  while (finger.time() < 0.5) {
    loop.sample();
    loop.advance();
    double& largest = finger.time() < 0.4 ? early : late;
    if (finger.time() > 0.3)
      largest = std::max(largest, lattice::rotation_vector(finger.read().pose.orientation).norm());
  }
  return std::log(late / early) / 0.1;
}

/// Rubber on a hand of inertia 1 that has `ratio` times its inertia in all motions and swings with
/// one frequency [Hz].
HeldVibrations swinging(double ratio, double frequency) {
  HeldVibrations rubber;
  rubber.inertia = ratio * Matrix6::Identity();
  rubber.squares.setConstant(6, std::pow(2.0 * pi * frequency, 2));
  rubber.shares = std::sqrt(ratio) * Matrix6::Identity();
  return rubber;
}

HeldVibrations rigid(double ratio) {
  HeldVibrations rubber;
  rubber.inertia = ratio * Matrix6::Identity();
  rubber.shares.resize(6, 0);
  return rubber;
}

}  // namespace

TEST(LoopStability, ItsRatesAreThoseOfMovingFingers) {
  const auto base = meshes::Geometry::of_profile(fingers::solid());
  for (const PressSetup& setup :
       {setup_of({}, 5, 450.0), setup_of({}, 5, 900.0), setup_of(base, 5, 450.0, 20.0),
        setup_of(fingers::solid_dome(32, 24), 8, 8100.0)}) {
    const double rate = predicted(setup).rate;
    ASSERT_GT(rate, 10.0);
    EXPECT_NEAR(measured_rate(setup), rate, 0.15 * rate) << setup.rod.density;
  }
}

TEST(LoopStability, RigidRubberIsStableUpToEightNinthsOfADelay) {
  // (s + w)^3 + ratio T s^4 = 0 at s = sqrt(3) i w, for periods much shorter than 1/w.
  PidSettings servo;
  servo.derivative_filter = 1e4;
  servo.period = 1e-5;
  const double omega = 2.0 * pi * servo.natural_frequency,
               limit = 8.0 / (9.0 * omega * servo.period);
  const auto rate = [&](double ratio) {
    return lattice::loop_motion(Matrix6::Identity(), rigid(ratio), 0.0, servo, 0.0);
  };
  EXPECT_LT(rate(0.97 * limit).rate, 0.0);
  EXPECT_GT(rate(1.03 * limit).rate, 0.0);
  EXPECT_NEAR(rate(limit).frequency, std::sqrt(3.0) * servo.natural_frequency, 2.0);
}

TEST(LoopStability, ABareHandIsAsTheControllerPlacesIt) {
  PidSettings servo;
  servo.derivative_filter = 1e4;
  servo.period = 1e-5;
  const LoopMotion bare = lattice::loop_motion(Matrix6::Identity(), rigid(0.0), 0.0, servo, 0.0);
  EXPECT_NEAR(bare.rate, -2.0 * pi * servo.natural_frequency, 0.1 * 2.0 * pi * 60.0);
  EXPECT_GT(lattice::loop_motion(Matrix6::Identity(), rigid(0.0), 0.0, PidSettings(), 1e-3).rate,
            0.0);  // the delay alone
}

TEST(LoopStability, UpToTheHarmlessRatioRubberOfAnyStiffnessHoldsStill) {
  for (const double natural : {20.0, 60.0, 80.0}) {
    PidSettings servo;
    servo.natural_frequency = natural;
    const double damping = meshes::Rubber().retardation_time,
                 ratio = lattice::harmless_ratio(servo, 0.0, damping);
    for (double frequency = 5.0; frequency < 1e4; frequency *= 1.1)
      EXPECT_LT(
          lattice::loop_motion(Matrix6::Identity(), swinging(ratio, frequency), damping, servo, 0.0)
              .rate,
          0.0)
          << natural << " Hz, rubber " << frequency << " Hz";
  }
}

TEST(LoopStability, AHandThatSwaysIsRefusedAndWhatIsToldHoldsStill) {
  PressSetup setup = setup_of(fingers::solid_dome(32, 24), 8, 8100.0);
  ASSERT_EQ(setup.violations().size(), 1u);
  EXPECT_EQ(setup.violations()[0].key, "rod.density");
  EXPECT_EQ(lattice::beyond_the_lattice(setup).size(), 1u);
  const auto sways = lattice::swaying_hand(setup);
  ASSERT_TRUE(sways);
  EXPECT_GT(sways->ratio, 5.0);
  const auto with = [&](double density, double frequency) {
    PressSetup other = setup;
    other.rod.density = density;
    other.controller.natural_frequency = frequency;
    return other.violations().empty();
  };
  EXPECT_TRUE(with(sways->density, 60.0));
  EXPECT_FALSE(with(0.9 * sways->density, 60.0));
  EXPECT_TRUE(with(8100.0, sways->natural_frequency));
  EXPECT_FALSE(with(8100.0, 1.1 * sways->natural_frequency));
  setup.protocol.mode = meshes::DriveMode::quasi_static;
  EXPECT_TRUE(setup.violations().empty());
}

TEST(LoopStability, HandsThatHoldStillAreLetBe) {
  for (const double density : {900.0, 2700.0})  // soft rubber that swings far below the controller
    EXPECT_TRUE(
        setup_of(meshes::Geometry::of_profile(fingers::solid()), 6, density).violations().empty())
        << density;
  EXPECT_TRUE(setup_of(fingers::solid_dome(32, 24), 8, 32400.0).violations().empty());
  PressSetup fast = setup_of({}, 6, 2700.0);
  fast.controller.natural_frequency = 250.0;  // unstable with the bare hand: not the hand's fault
  EXPECT_TRUE(fast.violations().empty());
}
