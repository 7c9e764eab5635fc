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
using Eigen::MatrixXd;
using Eigen::VectorXd;
using lattice::AccelerationFields;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::MassScaling;
using lattice::ModelKind;
using lattice::State;
using lattice::VectorField;

namespace {

constexpr double step = 2.5e-4;

LatticeModel coarse(ModelKind kind) {
  lattice::LatticeSettings settings = settings_for(
      kind, kind == ModelKind::network ? Kinematics::finite : Kinematics::small, 4);
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

/// dt² K + 2 dt C at a state, by central differences of the forces.
MatrixXd stepped_stiffness(const LatticeModel& model, const State& at) {
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  const Eigen::Index n = 3 * Eigen::Index(model.particles.size());
  MatrixXd result(n, n);
  const auto difference = [&](VectorField State::*moved, std::size_t p, int c, double h) {
    VectorXd slope = VectorXd::Zero(n);
    for (const double side : {1.0, -1.0}) {
      State state = at;
      (state.*moved).add(model.particles[p], side * h * Vector3::Unit(c));
      VectorField force(model.points());
      forces.accumulate(state, force);
      slope -= side * packed(model, force) / (2.0 * h);
    }
    return slope;
  };
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      result.col(3 * Eigen::Index(p) + c) =
          step * step * difference(&State::displacement, p, c, 1e-4 * model.spacing()) +
          2.0 * step * difference(&State::velocity, p, c, 1e-2);
    }
  }
  return 0.5 * (result + result.transpose());
}

/// W: accelerations per force, column by column.
MatrixXd response(const LatticeModel& model, const MassScaling& scaling) {
  lattice::Team team(1);
  AccelerationFields fields(model);
  const Eigen::Index n = 3 * Eigen::Index(model.particles.size());
  MatrixXd result(n, n);
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    for (int c = 0; c < 3; ++c) {
      VectorField force(model.points());
      force.set(model.particles[p], Vector3::Unit(c));
      scaling.accelerate({}, team, fields, force);
      for (const std::uint32_t i : model.particles) {
        force.set(i, model.inverse_mass[i] * force.at(i));
      }
      result.col(3 * Eigen::Index(p) + c) = packed(model, force);
    }
  }
  return result;
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
  const MatrixXd W = response(model, scaling), B = stepped_stiffness(model, state);
  EXPECT_LT((W - W.transpose()).norm(), 1e-12 * W.norm());
  // W (dt² K + 2 dt C) <= 4, and without scaling it is far beyond.
  const Eigen::SelfAdjointEigenSolver<MatrixXd> spectrum(W);
  EXPECT_GT(spectrum.eigenvalues().minCoeff(), 0.0);
  const MatrixXd root = spectrum.operatorSqrt();
  const auto largest = [](const MatrixXd& m) {
    return Eigen::SelfAdjointEigenSolver<MatrixXd>(m, Eigen::EigenvaluesOnly)
        .eigenvalues()
        .maxCoeff();
  };
  EXPECT_LE(largest(root * B * root), 4.0);
  VectorXd light(B.rows());
  for (std::size_t p = 0; p < model.particles.size(); ++p) {
    light.segment<3>(3 * Eigen::Index(p))
        .setConstant(std::sqrt(model.inverse_mass[model.particles[p]]));
  }
  EXPECT_GT(largest(light.asDiagonal() * B * light.asDiagonal()), 16.0);
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
  ASSERT_EQ(setup.violations().size(), 1u);
  EXPECT_EQ(setup.violations().front().key, "run.integrator");
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
  setup.time_step = 0.5 * step;
  const auto halved = lattice::run_press(setup);
  setup.time_step.reset();
  setup.integrator = lattice::Integrator::symplectic_euler;
  const auto exact = lattice::run_press(setup);
  EXPECT_NEAR(scaled.step.step, step, 1e-9);
  EXPECT_LT(scaled.steps.accepted, exact.steps.accepted / 3);
  EXPECT_LT(scaled.momentum_defect, 1e-12);
  const auto error = [&](const lattice::PressOutcome& outcome) {
    double worst = 0.0;
    for (std::size_t n = 0; n < exact.response.samples().size(); ++n) {
      const auto& sample = exact.response.samples()[n];
      if (sample.indentation < 0.5e-3) continue;
      worst = std::max(worst, std::abs(outcome.response.samples()[n].normal_force /
                                           sample.normal_force -
                                       1.0));
    }
    return worst;
  };
  EXPECT_LT(error(scaled), 0.01);
  EXPECT_LT(error(halved), 0.7 * error(scaled));
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
