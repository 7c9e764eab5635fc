/// Adaptive steps against Euler steps, and what they promise of themselves.
#include <gtest/gtest.h>

#include <cmath>

#include "lattice/control/virtual_finger.h"
#include "lattice/dynamics/integrators/energy_stepper.h"
#include "lattice/dynamics/integrators/runge_kutta.h"
#include "lattice/forces/energy.h"
#include "lattice/press/press.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::FingerSetup;
using lattice::Integrator;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::VirtualFinger;

namespace {

constexpr double clearance = 1e-4, period = 1e-3;

FingerSetup setup_with(Integrator integrator, double tau = 0.0,
                       ModelKind kind = ModelKind::hookean) {
  FingerSetup setup;
  setup.rubber.retardation_time = tau;
  setup.lattice =
      settings_for(kind, kind == ModelKind::network ? Kinematics::finite : Kinematics::small, 6);
  setup.contact = meshes::ContactMode::frictionless;
  setup.plane = {Vector3(0.0, 0.0, 0.01 + clearance), -Vector3::UnitZ()};
  setup.integrator = integrator;
  setup.threads = 1;
  return setup;
}

/// The bond's force along z as it is now, whatever the last step was [N].
double force_now(VirtualFinger& finger) {
  lattice::Finger& f = finger.finger();
  lattice::VectorField force(f.model().points());
  return -f.attempt(f.state(), f.rod(), f.plane(), f.time(), force).surfaces.bond.force.z();
}

/// F(t) at whole periods of a prescribed press that starts smoothly and comes to 2 cm/s.
std::vector<double> pressed(FingerSetup setup, int periods = 18) {
  setup.prescribed = true;
  VirtualFinger finger(setup);
  finger.write([](double t) {
    const double rise = 0.01, speed = 0.02, phase = M_PI * std::min(t / rise, 1.0);
    const double along =
        t < rise ? 0.5 * speed * (t - rise / M_PI * std::sin(phase)) : speed * (t - 0.5 * rise);
    return lattice::RodMotion{{0.0, 0.0, along}, {0.0, 0.0, 0.5 * speed * (1.0 - std::cos(phase))}};
  });
  std::vector<double> force;
  for (int n = 0; n < periods; ++n) {
    finger.do_step(period);
    force.push_back(force_now(finger));
  }
  return force;
}

double largest_of(const std::vector<double>& values) {
  double largest = 0.0;
  for (const double value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

/// Largest difference, relative to the largest force.
double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) worst = std::max(worst, std::abs(a[i] - b[i]));
  return worst / largest_of(b);
}

std::vector<double> runge_kutta(double tolerance, double tau, double ties = 1.0,
                                meshes::ContactMode contact = meshes::ContactMode::frictionless) {
  FingerSetup setup = setup_with(Integrator::runge_kutta, tau);
  setup.tolerance = tolerance;
  setup.contact = contact;
  setup.lattice.ligament_stiffness = setup.lattice.contact_stiffness = ties;
  return pressed(setup);
}

std::vector<double> symplectic(double step, double tau, double ties = 1.0,
                               meshes::ContactMode contact = meshes::ContactMode::frictionless) {
  FingerSetup setup = setup_with(Integrator::symplectic_euler, tau);
  setup.time_step = step;
  setup.contact = contact;
  setup.lattice.ligament_stiffness = setup.lattice.contact_stiffness = ties;
  return pressed(setup);
}

}  // namespace

/// Undamped, with soft ties: Euler steps damp the vibrations of stiff ties at the rate w² dt/2,
/// which takes steps far below a microsecond to become small.
TEST(RungeKutta, SymplecticEulerComesToItInFirstOrder) {
  for (const double tau : {3e-4, 0.0}) {
    const double ties = tau > 0.0 ? 1.0 : 0.03;
    const std::vector<double> exact = runge_kutta(1e-8, tau, ties);
    std::array<double, 3> error{};
    for (int level = 0; level < 3; ++level) {
      error[std::size_t(level)] = apart(symplectic(4e-6 / (1 << level), tau, ties), exact);
    }
    EXPECT_LT(error[2], 1e-3) << tau;
    EXPECT_NEAR(error[0] / error[1], 2.0, 0.3) << tau << ::testing::PrintToString(error);
    EXPECT_NEAR(error[1] / error[2], 2.0, 0.3) << tau << ::testing::PrintToString(error);
  }
}

TEST(RungeKutta, KeepsCloserWithASmallerTolerance) {
  const std::vector<double> exact = runge_kutta(1e-8, 0.0);
  EXPECT_LT(apart(runge_kutta(1e-6, 0.0), exact), 1e-3);
  EXPECT_LT(apart(runge_kutta(1e-7, 0.0), exact), 1e-4);
}

TEST(RungeKutta, SticksWhereEulerStepsStick) {
  const auto stick = meshes::ContactMode::stick;
  const std::vector<double> exact = runge_kutta(1e-7, 3e-4, 1.0, stick);
  EXPECT_LT(apart(symplectic(4e-6, 3e-4, 1.0, stick), exact), 5e-3);
}

/// Sheared and let go, without damping and load: energy comes and goes with the integrator's
/// ripple. The bond is soft: what stiff implicit ties vibrate with (here 1 % of the energy) they
/// lose for good, at a rate that only steps far below a microsecond make small.
TEST(SymplecticEuler, KeepsTheEnergyOfAnUndampedFingerUpToItsRipple) {
  std::array<double, 3> deviation{};
  for (std::size_t level = 0; level < deviation.size(); ++level) {
    FingerSetup setup = setup_with(Integrator::symplectic_euler);
    setup.plane.point.z() = 1.0;
    setup.lattice.ligament_stiffness = 0.03;
    setup.time_step = 4e-5 / double(1 << level);
    VirtualFinger finger(setup);
    lattice::Finger& f = finger.finger();
    for (const std::uint32_t i : f.model().particles) {
      const Vector3 place = f.model().rest_position(i);
      const double way = std::max(0.0, place.z());
      f.state().velocity.set(
          i, f.model().grid.axes.transpose() * Vector3(500.0 * way * way, 0.0, 0.0));
    }
    const auto energy = [&] {
      return lattice::elastic_energy(f.model(), f.state()) + f.bond_energy() +
             lattice::kinetic_energy(f.model(), f.state()) + f.rod().kinetic_energy();
    };
    const double start = energy();
    finger.do_step(20.0 * period, [&] {
      deviation[level] = std::max(deviation[level], std::abs(energy() / start - 1.0));
      return true;
    });
  }
  EXPECT_LT(deviation[2], 0.02) << ::testing::PrintToString(deviation);
  EXPECT_GT(deviation[0] / deviation[1], 1.6) << ::testing::PrintToString(deviation);
  EXPECT_GT(deviation[1] / deviation[2], 1.6) << ::testing::PrintToString(deviation);
}

/// Momentum to round-off, energy and, for a lattice that turns without forces, angular momentum to
/// the tolerance; the rod is free.
TEST(RungeKutta, AFreeFingerConservesMomentumEnergyAndAngularMomentum) {
  FingerSetup setup = setup_with(Integrator::runge_kutta, 0.0, ModelKind::network);
  setup.plane.point.z() = 1.0;
  setup.tolerance = 1e-7;
  VirtualFinger finger(setup);
  lattice::Finger& f = finger.finger();
  f.state() = random_state(f.model(), 0.02, 0.05, 9);
  f.rod().set_velocity({0.01, 0.0, -0.02}, {0.5, -0.3, 0.8});
  const auto energy = [&] {
    return f.elastic_energy() + lattice::kinetic_energy(f.model(), f.state()) +
           f.rod().kinetic_energy();
  };
  const auto momentum = [&] {
    return Vector3(lattice::linear_momentum(f.model(), f.state()) + f.rod().momentum());
  };
  const auto spin = [&] {
    Vector3 sum = f.rod().angular_momentum() + f.rod().centre().cross(f.rod().momentum());
    for (const std::uint32_t i : f.model().particles) {
      sum += lattice::position(f.model(), f.state(), i)
                 .cross(f.model().mass[i] * (f.model().grid.axes * f.state().velocity.at(i)));
    }
    return sum;
  };
  const double energy_before = energy();
  const Vector3 momentum_before = momentum(), spin_before = spin();
  finger.do_step(0.01);
  EXPECT_NEAR(energy() / energy_before, 1.0, 1e-4);
  EXPECT_LT((momentum() - momentum_before).norm(), 1e-11 * f.largest_impulse() + 1e-16);
  EXPECT_LT((spin() - spin_before).norm(), 1e-7 * spin_before.norm());
  EXPECT_LT(f.momentum_defect(), 1e-10 * f.largest_impulse());
}

TEST(RungeKutta, ADrivenRodGoesWhereSmallEulerStepsTakeIt) {
  const auto end = [](Integrator integrator, std::optional<double> step) {
    FingerSetup setup = setup_with(integrator, 3e-4);
    setup.time_step = step;
    setup.tolerance = 1e-7;
    VirtualFinger finger(setup);
    finger.write(lattice::Wrench{{0.02, 0.0, 0.4}, {0.0, 5e-4, 1e-4}});
    for (int n = 0; n < 20; ++n) finger.do_step(period);
    EXPECT_LT(finger.finger().momentum_defect(), 1e-10 * finger.finger().largest_impulse());
    EXPECT_GT(finger.finger().touching(), 0);
    return finger.finger().rod();
  };
  const auto exact = end(Integrator::runge_kutta, {});
  const auto coarse = end(Integrator::symplectic_euler, 8e-6);
  const auto fine = end(Integrator::symplectic_euler, 4e-6);
  const double travel = (exact.endpoint() - lattice::RodState(exact.body()).endpoint()).norm();
  const double error = (coarse.endpoint() - exact.endpoint()).norm();
  const double halved = (fine.endpoint() - exact.endpoint()).norm();
  EXPECT_LT(error, 2e-3 * travel);
  EXPECT_NEAR(error / halved, 2.0, 0.3);
}

/// Forces of a state that is only tried leave no trace: neither anchors nor points that are near.
TEST(Surfaces, RememberNothingOfWhatIsTried) {
  FingerSetup setup = setup_with(Integrator::runge_kutta);
  setup.contact = meshes::ContactMode::stick;
  VirtualFinger finger(setup);
  lattice::Finger& f = finger.finger();
  const auto moved = [&](double down, double tangential) {
    lattice::State state(f.model());
    for (const std::uint32_t i : f.model().particles) {
      state.displacement.set(i, f.model().grid.axes.transpose() * Vector3(tangential, 0.0, down));
    }
    return state;
  };
  lattice::VectorField force(f.model().points());
  const auto plane_force = [&](const lattice::State& state) {
    return f.attempt(state, f.rod(), f.plane(), f.time(), force).surfaces.plane.force;
  };
  const Vector3 first = plane_force(moved(2.0 * clearance, 0.0));
  EXPECT_LT(first.z(), 0.0);
  EXPECT_EQ(plane_force(moved(0.9 * clearance, 0.0)), Vector3::Zero());
  // Anchored there, going laterally would be held; untouched, it is not.
  plane_force(moved(2.0 * clearance, 5.0 * clearance));
  EXPECT_EQ(plane_force(moved(2.0 * clearance, 0.0)), first);
  EXPECT_EQ(f.touching(), 0);
}

TEST(AdaptiveSteps, ComeToTheSameBitsFromASavedState) {
  for (const Integrator integrator : {Integrator::runge_kutta, Integrator::energy_controlled}) {
    FingerSetup setup = setup_with(integrator);
    setup.contact = meshes::ContactMode::stick;
    setup.energy_bound = 1e-6;
    VirtualFinger finger(setup);
    finger.write(lattice::Wrench{Vector3(0.0, 0.0, 0.5), Vector3::Zero()});
    finger.do_step(6.0 * period);
    const VirtualFinger::Snapshot snapshot = finger.save();
    finger.do_step(1.5 * period);
    EXPECT_GT(finger.finger().touching(), 0);
    const Vector3 once = finger.finger().rod().endpoint();
    finger.load(snapshot);
    finger.do_step(1.5 * period);
    EXPECT_EQ(finger.finger().rod().endpoint(), once) << name(integrator);
  }
}

/// A finger thrown against the plane, on its own: kinetic plus elastic energy, taken here from the
/// state alone, changes by no more than the bound over any step.
TEST(EnergyControlledStep, KeepsItsBoundAndShrinksAtImpact) {
  FingerSetup setup = setup_with(Integrator::energy_controlled);
  setup.energy_bound = 1e-7;
  VirtualFinger finger(setup);
  lattice::Finger& f = finger.finger();
  const Vector3 velocity(0.0, 0.0, 0.05), along_grid = f.model().grid.axes.transpose() * velocity;
  for (const std::uint32_t i : f.model().particles) f.state().velocity.set(i, along_grid);
  f.rod().set_velocity(velocity, Vector3::Zero());
  const auto energy = [&] {
    double sum = lattice::elastic_energy(f.model(), f.state()) + f.bond_energy() +
                 lattice::kinetic_energy(f.model(), f.state()) + f.rod().kinetic_energy();
    for (const lattice::EmbeddedPoint& tie : f.model().outer) {
      const Vector3 place = tie.rest + f.model().grid.axes * lattice::shift(tie, f.state(), 0.0);
      const double gap = std::min(f.plane().gap(place), 0.0);
      sum += 0.5 * tie.stiffness * gap * gap;
    }
    return sum;
  };
  const double bound = setup.energy_bound * setup.rubber.youngs_modulus * 1e-6;  // R = 1 cm
  const double start = energy();
  double before = start, worst = 0.0, quiet = 0.0, smallest = 1.0;
  finger.do_step(20.0 * period, [&] {
    const double now = energy();
    worst = std::max(worst, std::abs(now - before));
    before = now;
    (f.touching() == 0 && f.time() < 2e-3 ? quiet : smallest) = f.touching() == 0 && f.time() < 2e-3
                                                                    ? std::max(quiet, f.step())
                                                                    : std::min(smallest, f.step());
    return true;
  });
  EXPECT_EQ(finger.step_count().forced, 0);
  EXPECT_GT(finger.step_count().rejected, 0);
  EXPECT_LE(worst, bound * (1.0 + 1e-9) + 1e-13 * start);
  EXPECT_GT(worst, 0.3 * bound);
  EXPECT_GT(quiet, 3.0 * smallest);
}

/// Dissipation and the work of rod and plane are accounted for: along accurate motion the balance
/// closes, though neither kinetic nor elastic energy is conserved.
TEST(EnergyBalance, ClosesAlongADampedPressAgainstAMovingAndTurningPlane) {
  FingerSetup setup = setup_with(Integrator::runge_kutta, 3e-4);
  setup.prescribed = true;
  setup.tolerance = 1e-7;
  setup.time_step = 1e-5;  // for the trapezoidal rule of the works
  setup.gravity = {0.3, 0.0, -9.81};
  setup.plane.velocity = {0.0, 0.0, -0.01};
  setup.plane.point.x() = 5e-3;
  setup.plane.angular_velocity = {0.0, -3.0, 0.0};
  VirtualFinger finger(setup);
  const lattice::Motion motion = [](double t) {
    return lattice::RodMotion{{0.0, 0.0, 1.0 * t * t}, {0.0, 0.0, 2.0 * t}};
  };
  finger.write(motion);
  lattice::EnergyBalance balance(finger.finger());
  const lattice::EnergyInstant start = balance.measure(true);
  lattice::EnergyInstant from = start;
  double drift = 0.0, dissipated = 0.0, by_plane = 0.0;
  finger.do_step(12.0 * period, [&] {
    const lattice::EnergyInstant to = balance.measure(true);
    const double step = finger.finger().step();
    drift += lattice::EnergyBalance::drift(from, to, step, motion);
    dissipated += 0.5 * step * (from.dissipation + to.dissipation);
    by_plane += 0.5 * step * (from.plane_power + to.plane_power);
    from = to;
    return true;
  });
  EXPECT_GT(finger.finger().touching(), 0);
  const double scale = from.kinetic + from.stored - start.kinetic - start.stored;
  EXPECT_GT(dissipated, 0.01 * scale);
  EXPECT_GT(by_plane, 0.005 * scale);
  EXPECT_LT(std::abs(drift), 1e-4 * scale);
}

TEST(AdaptiveSteps, AreNotForThePublishedModel) {
  lattice::PressSetup setup;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  for (const Integrator integrator : {Integrator::runge_kutta, Integrator::energy_controlled}) {
    setup.integrator = integrator;
    setup.lattice.model = ModelKind::hookean;
    EXPECT_TRUE(setup.violations().empty());
    setup.lattice.model = ModelKind::published;
    ASSERT_EQ(setup.violations().size(), 1u);
    EXPECT_EQ(setup.violations()[0].key, "run.integrator");
  }
  setup = {};
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.tolerance = 0.0;
  setup.energy_bound = -1.0;
  ASSERT_EQ(setup.violations().size(), 2u);
  EXPECT_EQ(setup.violations()[0].key, "run.tolerance");
  EXPECT_EQ(setup.violations()[1].key, "run.energy_bound");
}
