// A rubber that relaxes against exact solutions, against itself by other integrators, and without
// drive.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "lattice/control/virtual_finger.h"
#include "lattice/dynamics/spectrum.h"
#include "lattice/dynamics/time_step.h"
#include "lattice/forces/energy.h"
#include "lattice/forces/forces.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::FingerSetup;
using lattice::Integrator;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::RelaxingMemory;
using lattice::State;
using lattice::VectorField;
using meshes::Relaxation;

namespace {

const Relaxation two{{{0.3, 0.01}, {0.2, 1.0}}, true};

LatticeModel relaxing_block(ModelKind kind, const Relaxation& relaxation, double tau = 3e-4) {
  meshes::Rubber rubber;
  rubber.relaxation = relaxation;
  rubber.retardation_time = tau;
  return cell_block(settings_for(kind, Kinematics::small, 10), {3, 3, 3}, rubber);
}

/// Homogeneous deformation u = strain H X of a block, its rest undisturbed.
State deformed(const LatticeModel& model, const Eigen::Matrix3d& H) {
  State state(model);
  for (const std::size_t i : model.particles) state.displacement.set(i, H * model.rest_position(i));
  return state;
}

/// The part of the internal forces' virtual work that goes with a deformation: V P:H.
double work(const LatticeModel& model, const VectorField& force, const Eigen::Matrix3d& H) {
  double sum = 0.0;
  for (const std::size_t i : model.particles) sum -= force.at(i).dot(H * model.rest_position(i));
  return sum;
}

Eigen::Matrix3d shear() {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  H(0, 2) = 1.0;
  return H;
}
Eigen::Matrix3d swelling() {
  return Eigen::Matrix3d::Identity();
}

/// Stress over that after long times of a block whose strain goes through strain(t), in steps.
template <typename Strain>
std::vector<double> answers(const Relaxation& relaxation, const Eigen::Matrix3d& H, double step,
                            int steps, const Strain& strain, ModelKind kind = ModelKind::hookean) {
  const LatticeModel model = relaxing_block(kind, relaxation);
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  RelaxingMemory memory(model);
  VectorField force(model.points());
  constexpr double amplitude = 1e-3;
  forces.accumulate(deformed(model, amplitude * H), force);
  const double stiffness = work(model, force, H) / amplitude;
  std::vector<double> result;
  for (int n = 1; n <= steps; ++n) {
    const State state = deformed(model, amplitude * strain(n * step) * H);
    if (n % 2 == 0) {  // noted or looked ahead to: the same
      forces.note(state, n * step, memory, force);
      forces.accumulate(state, n * step, memory, force);
    } else {
      forces.accumulate(state, n * step, memory, force);
      VectorField same(model.points());
      forces.note(state, n * step, memory, same);
    }
    result.push_back(work(model, force, H) / (amplitude * stiffness));
  }
  return result;
}

}  // namespace

/// Over G_inf: strain + sum b tau rate (1 - exp(-t/tau)) on the ramp, then fading.
TEST(RelaxingLattice, RampAndHoldInShearIsExact) {
  constexpr double ramp = 0.1, step = 4e-3;
  const auto strain = [=](double t) { return std::min(t, ramp) / ramp; };
  for (const ModelKind kind : {ModelKind::hookean, ModelKind::central}) {
    const std::vector<double> stress = answers(two, shear(), step, 100, strain, kind);
    for (std::size_t n = 0; n < stress.size(); ++n) {
      const double t = step * double(n + 1);
      double exact = strain(t);
      for (std::size_t i = 0; i < 2; ++i) {
        const double tau = two.branches[i].time, on = std::min(t, ramp);
        exact += two.relative_modulus(i) * tau / ramp * (1.0 - std::exp(-on / tau)) *
                 std::exp(-(t - on) / tau);
      }
      EXPECT_NEAR(stress[n] / exact, 1.0, 1e-10) << t;
    }
  }
}

/// In steps far shorter than the branches' times these are noted now and then only.
TEST(RelaxingLattice, ShortStepsGoAlongStraightLines) {
  constexpr double frequency = 40.0, step = 2e-5;
  LatticeModel model = relaxing_block(ModelKind::hookean, two);
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  RelaxingMemory often(model);
  VectorField force(model.points()), exact(model.points());
  double time_of_note = -1.0, worst = 0.0, largest_force = 0.0;
  int notes = 0;
  for (int n = 0; n < 5000; ++n) {
    const State state = deformed(model, 1e-3 * std::sin(frequency * n * step) * shear());
    forces.accumulate(state, n * step, often, exact);
    forces.note(state, n * step, often, force);
    if (often.time != time_of_note) ++notes;
    time_of_note = often.time;
    for (const std::size_t i : model.particles) {
      worst = std::max(worst, (force.at(i) - exact.at(i)).norm());
      largest_force = std::max(largest_force, exact.at(i).norm());
    }
  }
  EXPECT_LT(worst, 3e-5 * largest_force);
  EXPECT_GT(worst, 0.0);
  EXPECT_NEAR(notes, 300, 20);
}

TEST(RelaxingLattice, StorageAndLossOverFourDecades) {
  for (const double frequency : {0.3, 3.0, 30.0, 300.0, 3000.0}) {
    constexpr int per_cycle = 200;
    const double step = 2.0 * std::numbers::pi / frequency / per_cycle;
    const int settling = per_cycle * (1 + int(12.0 * frequency / (2.0 * std::numbers::pi))),
              cycles = std::min(settling / per_cycle, 40);
    // The slow branch needs no settling where it hardly moves.
    const int start = per_cycle * cycles, total = start + per_cycle;
    const std::vector<double> stress =
        answers(two, shear(), step, total, [&](double t) { return std::sin(frequency * t); });
    double storage = 0.0, loss = 0.0;
    for (int n = start; n < total; ++n) {
      const double t = step * (n + 1);
      storage += 2.0 / per_cycle * stress[std::size_t(n)] * std::sin(frequency * t);
      loss += 2.0 / per_cycle * stress[std::size_t(n)] * std::cos(frequency * t);
    }
    EXPECT_NEAR(storage / two.storage(frequency), 1.0, 1e-3) << frequency;
    EXPECT_NEAR(loss, two.loss(frequency), 1e-3 * two.storage(frequency)) << frequency;
  }
}

TEST(RelaxingLattice, ABulkThatStaysDoesNotFade) {
  Relaxation shear_alone = two;
  shear_alone.bulk = false;
  const auto sudden = [](double) { return 1.0; };
  const std::vector<double> swollen = answers(shear_alone, swelling(), 1e-3, 5, sudden),
                            sheared = answers(shear_alone, shear(), 1e-3, 5, sudden),
                            both = answers(two, shear(), 1e-3, 5, sudden);
  for (std::size_t n = 0; n < both.size(); ++n) {
    EXPECT_NEAR(swollen[n], 1.0, 1e-12);
    EXPECT_NEAR(sheared[n], both[n], 1e-12);
    EXPECT_GT(both[n], 1.3);
  }
}

namespace {

/// A block at large strain of a law of each kernel.
std::vector<LatticeModel> large_blocks(const Relaxation& relaxation, double tau = 3e-4) {
  std::vector<LatticeModel> models;
  for (const meshes::StrainEnergy& energy :
       {meshes::StrainEnergy{},
        meshes::StrainEnergy{
            meshes::RubberLaw::yeoh, meshes::VolumetricLaw::quadratic, {0.05, 0.005}},
        meshes::StrainEnergy{
            meshes::RubberLaw::ogden, meshes::VolumetricLaw::quadratic, {0.8, 1.3, 0.2, 5.0}}}) {
    meshes::Rubber rubber;
    rubber.retardation_time = tau;
    rubber.relaxation = relaxation;
    rubber.energy = energy;
    models.push_back(
        cell_block(settings_for(ModelKind::network, Kinematics::finite, 10), {3, 3, 3}, rubber));
  }
  return models;
}

Eigen::Matrix3d turn(double angle) {
  return Eigen::AngleAxisd(angle, Vector3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
}

/// x = Q (X + u).
State turned(const LatticeModel& model, const State& state, const Eigen::Matrix3d& Q) {
  State result(model);
  for (const std::size_t i : model.particles) {
    const Vector3 X = model.rest_position(i);
    result.displacement.set(i, Q * (X + state.displacement.at(i)) - X);
  }
  return result;
}

}  // namespace

/// F(t) = 1 + t H: S = S_inf + integral of b exp(-(t - s)/tau) dS_inf/ds (Holzapfel & Simo), with
/// S_inf from the law of a point.
TEST(RelaxingLattice, LargeStrainKeepsAStressOnTheRestShape) {
  Eigen::Matrix3d H;
  H << 0.3, 0.2, -0.1, 0.0, -0.25, 0.3, 0.15, 0.1, -0.2;
  constexpr double step = 0.01;
  constexpr int steps = 100;
  for (const LatticeModel& model : large_blocks(two)) {
    lattice::Team team(1);
    lattice::InternalForces forces(model, team), plain(model, team);
    RelaxingMemory memory(model);
    VectorField force(model.points());
    /// F⁻¹ P of the block, from the work of its forces along e_i (x) e_j.
    const auto stress = [&](const VectorField& f, const Eigen::Matrix3d& F) {
      Eigen::Matrix3d P;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          Eigen::Matrix3d direction = Eigen::Matrix3d::Zero();
          direction(i, j) = 1.0;
          P(i, j) = work(model, f, direction);
        }
      return Eigen::Matrix3d(F.inverse() * P);
    };
    std::vector<Eigen::Matrix3d> after_long_times{Eigen::Matrix3d::Zero()};
    Eigen::Matrix3d found;
    for (int n = 1; n <= steps; ++n) {
      const Eigen::Matrix3d part = n * step * H, F = part + Eigen::Matrix3d::Identity();
      const State state = deformed(model, part);
      plain.accumulate(state, force);
      after_long_times.push_back(stress(force, F));
      forces.note(state, n * step, memory, force);
      found = stress(force, F);
      // What is only tried changes nothing.
      forces.accumulate(deformed(model, 0.5 * part), (n + 0.5) * step, memory, force);
    }
    Eigen::Matrix3d exact = after_long_times.back();
    for (std::size_t i = 0; i < 2; ++i)
      for (int n = 1; n <= steps; ++n) {
        const double tau = two.branches[i].time, rest = step * (steps - n);
        exact += two.relative_modulus(i) * tau / step *
                 (std::exp(-rest / tau) - std::exp(-(rest + step) / tau)) *
                 (after_long_times[std::size_t(n)] - after_long_times[std::size_t(n - 1)]);
      }
    EXPECT_LT((found - exact).norm(), 1e-11 * exact.norm());
    EXPECT_GT((found - after_long_times.back()).norm(), 0.05 * found.norm());
  }
}

/// Whatever the state, its modes included: at once all forces are those after long times, times
/// G0/G_inf, and they turn with a rubber that turns.
TEST(RelaxingLattice, LargeStrainIsElasticAtOnceAndTurnsAlong) {
  for (const LatticeModel& model : large_blocks(two)) {
    lattice::Team team(1);
    lattice::InternalForces forces(model, team);
    RelaxingMemory memory(model);
    State state = random_state(model, 0.1, 0.0, 11);
    VectorField elastic(model.points()), at_once(model.points()), later(model.points());
    forces.accumulate(state, elastic);
    forces.accumulate(state, 0.0, memory, at_once);
    const double scale = largest(model, elastic);
    for (const std::size_t i : model.particles)
      EXPECT_LT((at_once.at(i) - two.instantaneous_ratio() * elastic.at(i)).norm(), 1e-12 * scale);
    const Eigen::Matrix3d Q = turn(0.7);
    constexpr double first = 5e-4, second = 0.02;
    forces.note(state, first, memory, later);
    forces.note(turned(model, state, Q), second, memory, later);
    forces.accumulate(turned(model, state, Q), elastic);
    double left = 1.0;
    for (std::size_t n = 0; n < 2; ++n) {
      const double tau = two.branches[n].time;
      left += two.relative_modulus(n) * meshes::PronyRecursion(first, tau).gain *
              meshes::PronyRecursion(second - first, tau).decay;
    }
    for (const std::size_t i : model.particles)
      EXPECT_LT((later.at(i) - left * elastic.at(i)).norm(), 1e-11 * scale);
    // Forces and torques balance while it deforms and turns.
    State other = random_state(model, 0.1, 0.0, 12);
    forces.note(other, 0.03, memory, later);
    Vector3 sum = Vector3::Zero(), torque = Vector3::Zero();
    for (const std::size_t i : model.particles) {
      sum += later.at(i);
      torque += (model.rest_position(i) + other.displacement.at(i)).cross(later.at(i));
    }
    EXPECT_LT(sum.norm(), 1e-11 * scale);
    EXPECT_LT(torque.norm(), 1e-11 * scale * 3e-3);
  }
}

/// Undamped but for the branches: what moves is lost, and nothing is made of nothing.
TEST(RelaxingLattice, EnergyNeverGrowsWithoutInput) {
  for (const Relaxation& relaxation :
       {two, Relaxation{{{0.5, 1e-4}, {0.2, 3e-3}, {0.1, 0.1}}, true},
        Relaxation{{{0.6, 1e-7}, {0.2, 1e-5}}, false}}) {
    const LatticeModel model = relaxing_block(ModelKind::hookean, relaxation, 0.0);
    lattice::Team team(1);
    lattice::InternalForces forces(model, team);
    State state = random_state(model, 1e-2, 1e-3, 7);
    RelaxingMemory memory(model);
    VectorField force(model.points());
    const double step = 0.9 * lattice::largest_stable_step(lattice::spectral_estimate(model),
                                                           Integrator::symplectic_euler);
    double time = 0.0, first = 0.0, before = 0.0, window = 0.0;
    constexpr int per_window = 1000;
    for (int n = 0; n < 100000; ++n) {
      forces.note(state, time, memory, force);
      // Where velocities belong to the middle of the steps the energy has no ripple of first order.
      State middle = state;
      for (const std::uint32_t i : model.particles) {
        const Vector3 kick = step * model.inverse_mass[i] * force.at(i);
        middle.velocity.add(i, 0.5 * kick);
        state.velocity.add(i, kick);
        state.displacement.add(i, step * state.velocity.at(i));
      }
      if (n % 10 == 0)
        window += 10.0 / per_window *
                  (lattice::kinetic_energy(model, middle) + lattice::elastic_energy(model, middle) +
                   forces.branch_energy(middle, time, memory).stored);
      time += step;
      if ((n + 1) % per_window != 0) continue;
      if (n + 1 == per_window) {
        first = window;
      } else {
        EXPECT_LE(window, before * (1.0 + 1e-9) + 1e-12 * first) << n;
      }
      before = window;
      window = 0.0;
    }
    EXPECT_LT(before, 0.5 * first);
    EXPECT_TRUE(std::isfinite(first) && first > 0.0);
  }
}

/// At large strain: what moves comes to rest, undamped but for the branches, and no window of a
/// thousand steps has more energy after long times than the first.
TEST(RelaxingLattice, LargeStrainComesToRest) {
  for (const LatticeModel& model : large_blocks({{{0.5, 1e-3}, {0.2, 0.03}}, true}, 0.0)) {
    lattice::Team team(1);
    lattice::InternalForces forces(model, team);
    State state = random_state(model, 0.05, 1e-3, 7);
    RelaxingMemory memory(model);
    VectorField force(model.points());
    const double step = 0.4 * lattice::largest_stable_step(lattice::spectral_estimate(model),
                                                           Integrator::symplectic_euler);
    double first = 0.0, window = 0.0;
    constexpr int per_window = 1000;
    for (int n = 0; n < 100000; ++n) {
      forces.note(state, n * step, memory, force);
      for (const std::uint32_t i : model.particles) {
        state.velocity.add(i, step * model.inverse_mass[i] * force.at(i));
        state.displacement.add(i, step * state.velocity.at(i));
      }
      window = std::max(
          window, lattice::kinetic_energy(model, state) + lattice::elastic_energy(model, state));
      if ((n + 1) % per_window != 0) continue;
      if (n + 1 == per_window) first = window;
      EXPECT_LE(window, first) << n;
      if (n + 1 < 100000) window = 0.0;
    }
    EXPECT_LT(window, 1e-2 * first);
  }
}

namespace {

/// F(t) of a finger pressed to 0.4 mm in 0.1 s and held, every 2 ms.
std::vector<double> pressed(Integrator integrator, const Relaxation& relaxation,
                            std::optional<double> time_step = {}) {
  constexpr double clearance = 1e-4, period = 2e-3, ramp = 0.1, depth = 4e-4;
  FingerSetup setup;
  setup.rubber.relaxation = relaxation;
  setup.lattice = settings_for(ModelKind::hookean, Kinematics::small, 5);
  setup.contact = meshes::ContactMode::frictionless;
  setup.plane = {Vector3(0.0, 0.0, 0.01 + clearance), -Vector3::UnitZ()};
  setup.integrator = integrator;
  setup.time_step = time_step;
  setup.threads = 1;
  setup.prescribed = true;
  lattice::VirtualFinger finger(setup);
  finger.write([&](double t) {
    const double s = std::min(t / ramp, 1.0), turn = 2.0 * std::numbers::pi,
                 way = clearance + depth;
    return lattice::RodMotion{{0.0, 0.0, way * (s - std::sin(turn * s) / turn)},
                              {0.0, 0.0, way / ramp * (1.0 - std::cos(turn * s))}};
  });
  std::vector<double> force;
  for (int n = 0; n < 150; ++n) {
    finger.do_step(period);
    force.push_back(-finger.finger().bond().force.z());
  }
  return force;
}

double apart(const std::vector<double>& a, const std::vector<double>& b) {
  double worst = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, std::abs(a[i] - b[i]));
    largest = std::max(largest, std::abs(b[i]));
  }
  return worst / largest;
}

}  // namespace

TEST(RelaxingLattice, IntegratorsAgree) {
  const Relaxation series{{{0.3, 0.01}, {0.2, 0.2}}, true};
  const std::vector<double> exact = pressed(Integrator::runge_kutta, series),
                            euler = pressed(Integrator::symplectic_euler, series, 5e-6);
  EXPECT_LT(apart(euler, exact), 5e-3);
  EXPECT_LT(apart(pressed(Integrator::symplectic_euler, series), exact), 2e-2);
  EXPECT_LT(apart(pressed(Integrator::energy_controlled, series), exact), 2e-2);
  EXPECT_LT(apart(pressed(Integrator::mass_scaled, series, 250e-6), exact), 3e-2);
  // It relaxes: from near its modulus at once to what is left.
  EXPECT_GT(exact[50], 1.15 * exact[149]);
}

TEST(RelaxingLattice, FastBranchesVanishSlowOnesAreElastic) {
  const std::vector<double> plain = pressed(Integrator::symplectic_euler, {}),
                            fast = pressed(Integrator::symplectic_euler, {{{0.5, 1e-6}}, true}),
                            slow = pressed(Integrator::symplectic_euler, {{{0.5, 1e4}}, true});
  EXPECT_LT(apart(fast, plain), 1e-2);
  EXPECT_NEAR(slow[149] / plain[149], 2.0, 0.2);  // ties and contact stay as they are
}
