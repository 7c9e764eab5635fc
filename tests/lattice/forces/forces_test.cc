#include "lattice/forces/forces.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lattice/contact/bond.h"
#include "lattice/forces/energy.h"
#include "lattice/kernels/by_width.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::State;
using lattice::VectorField;

namespace {

VectorField kernel_forces(const LatticeModel& model, const State& state, int threads = 1,
                          int width = 0) {
  lattice::Team team(threads);
  lattice::InternalForces forces(model, team, width);
  VectorField result(model.points());
  forces.accumulate(state, result);
  return result;
}

double difference(const LatticeModel& model, const VectorField& a, const VectorField& b) {
  double result = 0.0;
  for (const std::size_t i : model.particles) result = std::max(result, (a.at(i) - b.at(i)).norm());
  return result;
}

/// Runs `check(model, label)` for every model and both kinematics on a block with odd row lengths.
template <typename Check>
void for_all_variants(const Check& check) {
  for (const ModelKind kind : all_models) {
    for (const Kinematics kinematics : both_kinematics) {
      const LatticeModel model = block(kind, kinematics, {10, 3, 2});
      check(model, fixtures::label(kind, kinematics));
    }
  }
}

}  // namespace

TEST(Forces, OneSpringObeysEquationOne) {
  // Two particles of a two-cell-free row would need cells; so stretch one edge of a single cell
  // whose other springs are switched off.
  LatticeModel model = block(ModelKind::published, Kinematics::finite, {1, 1, 1});
  const std::size_t i = model.particles[0], j = model.particles[1];
  for (auto& w : model.weight) std::fill(w.begin(), w.end(), 0.0);
  model.weight[0][i] = 1.0;
  State state(model);
  const double a = model.spacing();
  state.displacement.set(j, {-a, 2.0 * a, 0.0});  // d = (0, 2a, 0): length 2a, turned to y
  state.velocity.set(j, {0.3, 0.5, -0.2});        // only 0.5 along d
  const VectorField f = kernel_forces(model, state);
  const double pull = model.stiffness[0] * a + model.damping[0] * 0.5;
  EXPECT_NEAR((f.at(i) - Vector3(0.0, pull, 0.0)).norm(), 0.0, 1e-12 * pull);
  EXPECT_NEAR((f.at(j) + Vector3(0.0, pull, 0.0)).norm(), 0.0, 1e-12 * pull);
}

TEST(Forces, KernelMatchesTheEdgeListForEveryInstructionSet) {
  for_all_variants([](const LatticeModel& model, const std::string& label) {
    const State state = random_state(model, 0.2, 0.5, 7);
    const VectorField expected = reference::forces(model, state);
    const double scale = largest(model, expected);
    VectorField first;
    for (int width = 2; width <= lattice::kernel::supported_width(); width *= 2) {
      const VectorField computed = kernel_forces(model, state, 1, width);
      EXPECT_LT(difference(model, computed, expected), 1e-13 * scale) << label << width;
      if (width == 2) first = computed;
      EXPECT_EQ(difference(model, computed, first), 0.0) << "not the same bits: " << label << width;
    }
  });
}

TEST(Forces, TheTipsKernelMatchesTheEdgeListOnAnyNumberOfThreads) {
  for (const ModelKind kind : all_models) {
    const LatticeModel model = tip(kind, Kinematics::finite, 6);
    // Little enough that no sliver is turned inside out.
    const State state = random_state(model, 0.1, 0.5, 3);
    const VectorField expected = reference::forces(model, state);
    const VectorField serial = kernel_forces(model, state, 1);
    EXPECT_LT(difference(model, serial, expected), 1e-13 * largest(model, expected));
    // 25: portions that begin within a plane and are shorter than what leads to them.
    for (const int threads : {2, 3, 25})
      EXPECT_EQ(difference(model, serial, kernel_forces(model, state, threads)), 0.0) << threads;
  }
}

TEST(Forces, AreZeroAtRest) {
  for_all_variants([](const LatticeModel& model, const std::string& label) {
    // |d| - l0 leaves round-off of order k l0 1e-16.
    EXPECT_LT(largest(model, kernel_forces(model, State(model))), 1e-13 * 4.0 * 0.001) << label;
  });
}

TEST(Forces, AreMinusTheGradientOfTheEnergy) {
  for_all_variants([](const LatticeModel& model, const std::string& label) {
    State state = random_state(model, 0.2, 0.0, 11);
    const VectorField force = kernel_forces(model, state);
    const double h = 1e-5 * model.spacing();
    for (std::size_t p = 0; p < model.particles.size(); p += 17) {
      for (int c = 0; c < 3; ++c) {
        const std::size_t i = model.particles[p];
        double& u = state.displacement.component[std::size_t(c)][i];
        const double at = u;
        u = at + h;
        const double above = lattice::elastic_energy(model, state);
        u = at - h;
        const double below = lattice::elastic_energy(model, state);
        u = at;
        EXPECT_NEAR(force.at(i)[c], -(above - below) / (2.0 * h), 2e-7 * largest(model, force))
            << label;
      }
    }
  });
}

TEST(Forces, ObeyNewtonsThirdLaw) {
  for_all_variants([](const LatticeModel& model, const std::string& label) {
    const State state = random_state(model, 0.2, 1.0, 5);
    const VectorField force = kernel_forces(model, state);
    Vector3 sum = Vector3::Zero(), moment = Vector3::Zero();
    double magnitude = 0.0;
    for (const std::size_t i : model.particles) {
      // Small kinematics exert their forces where the particles rest.
      const Vector3 at = model.kinematics == Kinematics::small
                             ? model.rest_position(i)
                             : Vector3(lattice::position(model, state, i));
      sum += force.at(i);
      moment += at.cross(force.at(i));
      magnitude += force.at(i).norm();
    }
    EXPECT_LT(sum.norm(), 1e-14 * magnitude) << label;
    EXPECT_LT(moment.norm(), 1e-14 * magnitude * 0.01) << label;
  });
}

TEST(Forces, RigidMotionCostsNothingAndIsNotDamped) {
  for_all_variants([](const LatticeModel& model, const std::string& label) {
    const Eigen::AngleAxisd turn(0.7, Vector3(1.0, 2.0, -0.5).normalized());
    const Vector3 spin(3.0, -1.0, 2.0), shift(0.01, -0.02, 0.03);
    State state(model);
    for (const std::size_t i : model.particles) {
      const Vector3 rest = model.rest_position(i);
      // Linearised kinematics know only infinitesimal rotations.
      const Vector3 u = model.kinematics == Kinematics::small
                            ? Vector3(shift + 0.1 * spin.cross(rest))
                            : Vector3(turn * rest + shift - rest);
      const Vector3 x = model.kinematics == Kinematics::small ? rest : Vector3(rest + u);
      state.displacement.set(i, u);
      state.velocity.set(i, Vector3(0.1, 0.2, -0.3) + spin.cross(x));
    }
    const double a = model.spacing(), unit = meshes::Rubber{}.shear_modulus * a * a;
    EXPECT_LT(largest(model, kernel_forces(model, state)), 1e-12 * unit) << label;
    // What the network stores is the difference of terms that a rotation does not keep small.
    const bool cancels = model.kind == ModelKind::network && model.kinematics == Kinematics::finite;
    EXPECT_LT(lattice::elastic_energy(model, state), (cancels ? 1e-12 * a : 1e-24) * unit) << label;
  });
}

TEST(Ligaments, ForcesAreMinusTheGradientWithRespectToParticlesAndRod) {
  const LatticeModel model = tip(ModelKind::published, Kinematics::small, 4);
  const State state = random_state(model, 0.3, 0.0, 2);
  lattice::RodState rod(lattice::rod_body({}, {}));
  rod.set_velocity({0.1, -0.2, 0.3}, {2.0, -1.0, 3.0});
  rod.drift(0.05);
  rod.set_velocity(Vector3::Zero(), Vector3::Zero());
  VectorField force(model.points());
  const lattice::Wrench wrench = lattice::add_ligament_forces(model, state, rod, force);
  const Vector3 pivot = rod.endpoint();
  const auto energy = [&](const Vector3& shift, const Vector3& turn) {
    lattice::Pose pose = rod.pose();
    const Eigen::Quaterniond rotation = lattice::rotation_by(turn);
    pose.position = pivot + shift + rotation * (pose.position - pivot);
    pose.orientation = rotation * pose.orientation;
    return lattice::ligament_energy(model, state, pose);
  };
  for (int c = 0; c < 3; ++c) {
    const Vector3 h = 1e-7 * Vector3::Unit(c), t = 1e-5 * Vector3::Unit(c), o = Vector3::Zero();
    EXPECT_NEAR(wrench.force[c], -(energy(h, o) - energy(-h, o)) / 2e-7,
                1e-6 * wrench.force.norm());
    EXPECT_NEAR(wrench.torque[c], -(energy(o, t) - energy(o, -t)) / 2e-5,
                1e-6 * wrench.torque.norm());
  }
  Vector3 sum = wrench.force, moment = wrench.torque;
  for (const std::size_t i : model.particles) {
    const Vector3 on_particle = model.grid.axes * force.at(i);
    sum += on_particle;
    moment += (lattice::position(model, state, i) - pivot).cross(on_particle);
  }
  EXPECT_LT(sum.norm(), 1e-13 * wrench.force.norm());
  EXPECT_LT(moment.norm(), 1e-13 * wrench.torque.norm());
}

TEST(Ligaments, RigidMotionOfRodAndTipIsFreeOfForce) {
  const LatticeModel model = tip(ModelKind::published, Kinematics::finite, 4);
  lattice::RodState rod(lattice::rod_body({}, {}));
  rod.set_velocity({0.1, -0.2, 0.3}, {2.0, -1.0, 3.0});
  rod.drift(0.1);
  State state(model);
  for (const std::size_t i : model.particles) {
    const Vector3 x = rod.pose() * model.rest_position(i);
    const Eigen::Matrix3d to_grid = model.grid.axes.transpose();
    state.displacement.set(i, to_grid * (x - model.rest_position(i)));
    state.velocity.set(i, to_grid * rod.velocity_at(x));
  }
  VectorField force(model.points());
  lattice::add_ligament_forces(model, state, rod, force);
  EXPECT_LT(largest(model, force), 1e-12 * model.ligaments.front().stiffness * model.spacing());
}
