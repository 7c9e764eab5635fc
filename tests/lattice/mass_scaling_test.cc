#include "lattice/mass_scaling.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "fixtures.h"
#include "lattice/forces.h"
#include "lattice/press.h"
#include "lattice/virtual_finger.h"

using namespace fingertip;
using namespace fixtures;
using Eigen::VectorXd;
using lattice::AccelerationFields;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::MassScaling;
using lattice::ModelKind;
using lattice::State;
using lattice::VectorField;

namespace {

constexpr double step = 1e-3;

LatticeModel coarse(ModelKind kind) {
  lattice::LatticeSettings settings =
      settings_for(kind, kind == ModelKind::network ? Kinematics::finite : Kinematics::small, 4);
  settings.constants = lattice::hookean_constants({}, settings.spacing);
  settings.offset = Vector3(0.3, -0.2, 0.1);  // slivers everywhere
  return lattice::build_tip({}, {}, settings);
}

VectorXd packed(const LatticeModel& model, const VectorField& field) {
  VectorXd result(3 * Eigen::Index(model.particles.size()));
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    result.segment<3>(3 * Eigen::Index(p)) = field.at(model.particles[p]);
  }
  return result;
}

VectorField spread(const LatticeModel& model, const VectorXd& values) {
  VectorField field(model.points());
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    field.set(model.particles[p], values.segment<3>(3 * Eigen::Index(p)));
  }
  return field;
}

/// (dt² K + 2 dt C) q at a state, by central differences of the forces.
VectorXd stepped_stiffness(const LatticeModel& model, const State& at, const VectorXd& q) {
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  const VectorField direction = spread(model, q);
  const auto difference = [&](VectorField State::*moved, double h) {
    VectorXd slope = VectorXd::Zero(q.size());
    for (const double side : {1.0, -1.0}) {
      State state = at;
      for (const std::uint32_t i : model.particles) {
        (state.*moved).add(i, side * h * direction.at(i));
      }
      VectorField force(model.points());
      forces.accumulate(state, force);
      slope -= side * packed(model, force) / (2.0 * h);
    }
    return slope;
  };
  const double unit = 1.0 / q.lpNorm<Eigen::Infinity>();
  return step * step * difference(&State::displacement, 1e-4 * model.spacing() * unit) +
         2.0 * step * difference(&State::velocity, 1e-2 * unit);
}

/// W f: accelerations; by the masses alone without scaling.
VectorXd response(const LatticeModel& model, const MassScaling* scaling, const VectorXd& f) {
  lattice::Team team(1);
  AccelerationFields fields(model);
  VectorField force = spread(model, f);
  if (scaling != nullptr) scaling->accelerate({}, team, fields, force);
  for (const std::uint32_t i : model.particles) force.set(i, model.inverse_mass[i] * force.at(i));
  return packed(model, force);
}

/// Largest eigenvalue of W (dt² K + 2 dt C), from below: W is symmetric, so (dt² K + 2 dt C) W is
/// self-adjoint in the product <f, W g>, and Rayleigh quotients of power iterates rise.
double largest_product(const LatticeModel& model, const State& at, const MassScaling* scaling) {
  VectorXd f = packed(model, random_state(model, 1.0, 0.0, 11).displacement);
  double quotient = 0.0;
  for (int n = 0; n < 150; ++n) {
    const VectorXd a = response(model, scaling, f), next = stepped_stiffness(model, at, a);
    quotient = std::max(quotient, a.dot(next) / f.dot(a));
    f = next / next.norm();
  }
  return quotient;
}

/// Pressed together along z, with noise.
State compressed(const LatticeModel& model, double strain) {
  State state = random_state(model, 0.02, 0.0, 3);
  for (const std::uint32_t i : model.particles) {
    const Vector3 x = model.rest_position(i);
    state.displacement.add(i, {0.3 * strain * x.x(), 0.3 * strain * x.y(), -strain * x.z()});
  }
  return state;
}

class LongSteps : public testing::TestWithParam<std::pair<ModelKind, double>> {};

}  // namespace

TEST_P(LongSteps, AreStableForEveryMotion) {
  const LatticeModel model = coarse(GetParam().first);
  const State state = compressed(model, GetParam().second);
  const MassScaling scaling(model, state, step, 1.0);
  EXPECT_LE(largest_product(model, state, &scaling), 4.0);
  EXPECT_GT(largest_product(model, state, &scaling), 0.5);
  EXPECT_GT(largest_product(model, state, nullptr), 16.0);
}

TEST(MassScaling, RespondsSymmetrically) {
  const LatticeModel model = coarse(ModelKind::network);
  const MassScaling scaling(model, compressed(model, 0.2), step);
  const VectorXd f = packed(model, random_state(model, 1.0, 0.0, 1).displacement);
  const VectorXd g = packed(model, random_state(model, 1.0, 0.0, 2).displacement);
  const double one = f.dot(response(model, &scaling, g)),
               other = g.dot(response(model, &scaling, f));
  EXPECT_NEAR(one, other, 1e-11 * std::abs(f.dot(response(model, &scaling, f))));
  EXPECT_GT(f.dot(response(model, &scaling, f)), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Lattices, LongSteps,
                         testing::Values(std::pair(ModelKind::hookean, 0.0),
                                         std::pair(ModelKind::network, 0.0),
                                         std::pair(ModelKind::network, 0.3)));

TEST(MassScaling, WeightAcceleratesAllAlikeAndMomentumIsThatOfTheForces) {
  const LatticeModel model = coarse(ModelKind::network);
  const MassScaling scaling(model, State(model), step);
  EXPECT_GT(scaling.products(), 2);
  lattice::Team team(1);
  AccelerationFields fields(model);
  VectorField weight(model.points());
  for (const std::uint32_t i : model.particles) weight.set(i, model.mass[i] * Vector3(1, -2, 3));
  VectorField force = weight;
  scaling.accelerate({}, team, fields, force);
  for (const std::uint32_t i : model.particles) {
    EXPECT_LT((force.at(i) - weight.at(i)).norm(), 1e-12 * weight.at(i).norm());
  }
  const VectorField random = random_state(model, 1.0, 0.0, 7).displacement;
  force = random;
  scaling.accelerate({}, team, fields, force);
  Vector3 defect = Vector3::Zero();
  double size = 0.0, change = 0.0;
  for (const std::uint32_t i : model.particles) {
    defect += force.at(i) - random.at(i);
    size += random.at(i).norm();
    change += (force.at(i) - random.at(i)).norm();
  }
  EXPECT_LT(defect.norm(), 1e-13 * size);
  EXPECT_GT(change, 0.5 * size);
}

TEST(MassScaling, TiesGetWhatTheParticlesDoNot) {
  const LatticeModel model = coarse(ModelKind::network);
  const MassScaling scaling(model, State(model), step);
  lattice::Team team(1);
  AccelerationFields fields(model);
  const VectorField others = random_state(model, 1.0, 0.0, 7).displacement;
  std::vector<lattice::TieInertia> ties;
  VectorField force = others;
  const Vector3 normal = Vector3(1.0, 2.0, -3.0).normalized();
  for (std::size_t n = 0; n < model.particles.size(); n += 5) {
    const std::uint32_t i = model.particles[n];
    ties.push_back({i, double(n % 3) * model.mass[i],
                    double(n % 2) * 4.0 * model.mass[i] * normal * normal.transpose()});
    const Eigen::Matrix3d inertia =
        (model.mass[i] + ties.back().bond) * Eigen::Matrix3d::Identity() + ties.back().contact;
    force.set(i, model.mass[i] * inertia.inverse() * others.at(i));  // as surfaces leave it
  }
  const VectorField before = force;
  scaling.accelerate(ties, team, fields, force);
  Vector3 defect = Vector3::Zero();
  double size = 0.0;
  for (const std::uint32_t i : model.particles) {
    defect += force.at(i) - before.at(i);
    size += others.at(i).norm();
  }
  for (std::size_t n = 0; n < ties.size(); ++n) {
    defect += ties[n].bond * fields.changes[n] + ties[n].contact * fields.changes[n];
  }
  EXPECT_LT(defect.norm(), 1e-13 * size);
}

TEST(MassScaling, RefusesSpringsAndBlocks) {
  const LatticeModel springs = tip(ModelKind::central, Kinematics::small, 4);
  const LatticeModel free = block(ModelKind::network, Kinematics::finite, {2, 2, 2});
  for (const LatticeModel* model : {&springs, &free}) {
    EXPECT_THROW(MassScaling(*model, State(*model), step), std::invalid_argument);
  }
  lattice::PressSetup setup;
  setup.lattice = settings_for(ModelKind::central, Kinematics::small, 6);
  setup.integrator = lattice::Integrator::mass_scaled;
  std::size_t found = 0;
  for (const meshes::Violation& v : setup.violations()) found += v.key == "run.integrator";
  EXPECT_EQ(found, 1u);
}

namespace {

lattice::PressSetup press(int per_radius) {
  lattice::PressSetup setup;
  setup.lattice = settings_for(ModelKind::network, Kinematics::finite, per_radius);
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.depth = 1.5e-3;
  setup.integrator = lattice::Integrator::mass_scaled;
  setup.threads = 1;
  return setup;
}

}  // namespace

TEST(MassScaledPress, MeetsThatOfShortSteps) {
  lattice::PressSetup setup = press(6);
  const auto scaled = lattice::run_press(setup);
  setup.time_step = 1.25e-4;
  const auto halved = lattice::run_press(setup);
  setup.time_step.reset();
  setup.integrator = lattice::Integrator::symplectic_euler;
  const auto exact = lattice::run_press(setup);
  EXPECT_NEAR(scaled.step.step, 2.5e-4, 1e-9);
  EXPECT_LT(scaled.steps.accepted, exact.steps.accepted / 2);
  EXPECT_LT(scaled.momentum_defect, 1e-12);
  const auto error = [&](const lattice::PressOutcome& outcome) {
    double worst = 0.0;
    for (std::size_t n = 0; n < exact.response.samples().size(); ++n) {
      const auto& sample = exact.response.samples()[n];
      if (sample.indentation < 0.5e-3) continue;
      worst = std::max(
          worst, std::abs(outcome.response.samples()[n].normal_force / sample.normal_force - 1.0));
    }
    return worst;
  };
  EXPECT_LT(error(scaled), 0.015);
  EXPECT_LT(error(halved), 0.75 * error(scaled));
}

TEST(MassScaledPress, GoesOnFromASavedStateWithTheSameBitsOnAnyThreads) {
  lattice::FingerSetup setup;
  setup.lattice = press(6).lattice;
  setup.plane = {.point = {0.0, 0.0, 0.01 + 1e-5}};
  setup.prescribed = true;
  setup.integrator = lattice::Integrator::mass_scaled;
  const auto drive = [](lattice::VirtualFinger& finger, int from, int to) {
    for (int n = from; n < to; ++n) finger.do_step(1e-3);
    return finger.finger().bond().force;
  };
  const auto motion = [](double t) {
    return lattice::RodMotion{{0.0, 0.0, 0.02 * t}, {0.0, 0.0, 0.02}};
  };
  std::vector<Vector3> forces;
  for (const int threads : {1, 2}) {
    setup.threads = threads;
    lattice::VirtualFinger finger(setup);
    finger.write(motion);
    drive(finger, 0, 25);
    const auto saved = finger.save();
    forces.push_back(drive(finger, 25, 50));
    finger.load(saved);
    forces.push_back(drive(finger, 25, 50));
  }
  EXPECT_GT(forces[0].norm(), 1e-3);
  for (const Vector3& force : forces) EXPECT_EQ(force, forces[0]);
}
