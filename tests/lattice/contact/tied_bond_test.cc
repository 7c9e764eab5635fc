#include "lattice/contact/tied_bond.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <map>

#include "lattice/kernels/by_width.h"
#include "lattice/kernels/kernel.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::EmbeddedPoint;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::LatticeSettings;
using lattice::ModelKind;
using lattice::RodState;
using lattice::State;
using lattice::TiedBond;
using lattice::VectorField;
using lattice::Wrench;

namespace {

/// A tip on a grid that is aligned with nothing, in a random state, on a rod that has moved.
struct Scene {
  LatticeModel model;
  lattice::Team team{1};
  TiedBond bond;
  State state;
  RodState rod{lattice::rod_body({}, {})};

  explicit Scene(double amplitude = 0.1, Kinematics kinematics = Kinematics::finite)
      : model(lattice::build_cut_model({}, {}, settings(kinematics))),
        bond(model, team),
        state(random_state(model, amplitude, 0.3, 5)) {
    rod.set_velocity({0.1, -0.2, 0.3}, {2.0, -1.0, 3.0});
    rod.drift(0.01);
    rod.set_velocity(Vector3::Zero(), Vector3::Zero());
  }
  static LatticeSettings settings(Kinematics kinematics) {
    LatticeSettings s = settings_for(ModelKind::network, kinematics, 5);
    s.axes = Eigen::AngleAxisd(0.7, Vector3(1.0, -2.0, 0.5).normalized()).matrix();
    s.offset = Vector3(0.3, -0.2, 0.1);
    return s;
  }
  VectorField field(unsigned seed) const {
    return random_state(model, 1.0, 0.0, seed).displacement;
  }
};

/// The rod moved by `shift` and turned by `turn` about its endpoint.
RodState moved(const RodState& rod, const Vector3& shift, const Vector3& turn) {
  RodState result = rod;
  const Vector3 arm = rod.centre() - rod.endpoint();
  result.set_velocity(shift + lattice::rotation_by(turn) * arm - arm, turn);
  result.drift(1.0);
  result.set_velocity(Vector3::Zero(), Vector3::Zero());
  return result;
}

double difference(const LatticeModel& model, const VectorField& a, const VectorField& b) {
  double result = 0.0;
  for (const std::size_t i : model.particles) result = std::max(result, (a.at(i) - b.at(i)).norm());
  return result;
}

/// K of the ties, one scalar per pair of particles, added up point by point.
struct Ties {
  std::vector<std::uint32_t> particles;
  Eigen::MatrixXd matrix;

  explicit Ties(const LatticeModel& model) {
    std::map<std::uint32_t, Eigen::Index> number;
    for (const EmbeddedPoint& tie : model.bond) {
      for (const std::uint32_t corner : tie.corners) number.emplace(corner, 0);
    }
    for (auto& [particle, n] : number) {
      n = Eigen::Index(particles.size());
      particles.push_back(particle);
    }
    matrix = Eigen::MatrixXd::Zero(Eigen::Index(particles.size()), Eigen::Index(particles.size()));
    for (const EmbeddedPoint& tie : model.bond) {
      for (std::size_t a = 0; a < 8; ++a) {
        for (std::size_t b = 0; b < 8; ++b) {
          matrix(number[tie.corners[a]], number[tie.corners[b]]) +=
              tie.stiffness * tie.weights[a] * tie.weights[b];
        }
      }
    }
  }
};

}  // namespace

TEST(TiedBond, EnergyIsThatOfItsTiesOnTheRodsSurface) {
  const Scene s;
  double sum = 0.0;
  for (const EmbeddedPoint& tie : s.model.bond) {
    Vector3 x = tie.rest;
    for (std::size_t c = 0; c < 8; ++c) {
      x += s.model.grid.axes * (tie.weights[c] * s.state.displacement.at(tie.corners[c]));
    }
    sum += 0.5 * tie.stiffness * (x - s.rod.pose() * tie.rest).squaredNorm();
  }
  EXPECT_NEAR(s.bond.energy(s.state, s.rod), sum, 1e-12 * sum);
}

TEST(TiedBond, ForcesAreMinusTheGradientWithRespectToParticlesAndRod) {
  Scene s;
  VectorField force(s.model.points());
  const Wrench wrench = s.bond.add(s.state, s.rod, 0.0, force);
  const VectorField motion = s.field(3);
  const double h = 1e-4;
  double power = 0.0, size = 0.0;
  State above = s.state, below = s.state;
  for (const std::size_t i : s.model.particles) {
    power += force.at(i).dot(motion.at(i));
    size += force.at(i).norm() * motion.at(i).norm();
    above.displacement.add(i, h * motion.at(i));
    below.displacement.add(i, -h * motion.at(i));
  }
  EXPECT_NEAR(power, -(s.bond.energy(above, s.rod) - s.bond.energy(below, s.rod)) / (2.0 * h),
              1e-8 * size);
  const auto energy = [&](const Vector3& shift, const Vector3& turn) {
    return s.bond.energy(s.state, moved(s.rod, shift, turn));
  };
  for (int c = 0; c < 3; ++c) {
    const Vector3 d = 1e-6 * Vector3::Unit(c), t = 1e-5 * Vector3::Unit(c), o = Vector3::Zero();
    EXPECT_NEAR(wrench.force[c], -(energy(d, o) - energy(-d, o)) / 2e-6,
                1e-6 * wrench.force.norm());
    EXPECT_NEAR(wrench.torque[c], -(energy(o, t) - energy(o, -t)) / 2e-5,
                1e-6 * wrench.torque.norm());
  }
}

TEST(TiedBond, TheRodReceivesWhatTheParticlesLoseInForceAndTorque) {
  for (const double step : {0.0, 1e-4, 1.0}) {
    Scene s;
    const VectorField others = s.field(4);
    VectorField force = others;
    const Wrench wrench = s.bond.add(s.state, s.rod, step, force);
    Vector3 sum = wrench.force, moment = wrench.torque;
    double magnitude = 0.0;
    for (const std::size_t i : s.model.particles) {
      const Vector3 change = s.model.grid.axes * (force.at(i) - others.at(i));
      sum += change;
      moment += (lattice::position(s.model, s.state, i) - s.rod.endpoint()).cross(change);
      magnitude += change.norm();
    }
    EXPECT_GT(wrench.force.norm(), 1e-4 * magnitude);
    EXPECT_LT(sum.norm(), 1e-13 * magnitude) << step;
    EXPECT_LT(moment.norm(), 1e-13 * magnitude * 0.1) << step;
  }
}

TEST(TiedBond, RigidMotionOfRodAndTipIsFree) {
  Scene s;
  s.rod.set_velocity({0.3, 0.2, -0.1}, {-4.0, 2.0, 5.0});
  const Eigen::Matrix3d to_grid = s.model.grid.axes.transpose();
  for (const std::size_t i : s.model.particles) {
    const Vector3 rest = s.model.rest_position(i), x = s.rod.pose() * rest;
    s.state.displacement.set(i, to_grid * (x - rest));
    s.state.velocity.set(i, to_grid * s.rod.velocity_at(x));
  }
  const double unit = Ties(s.model).matrix.diagonal().maxCoeff() * s.model.spacing();
  for (const double step : {0.0, 1e-4}) {
    VectorField force(s.model.points());
    const Wrench wrench = s.bond.add(s.state, s.rod, step, force);
    EXPECT_LT(largest(s.model, force), 1e-12 * unit);
    EXPECT_LT(wrench.force.norm() + wrench.torque.norm(), 1e-11 * unit);
  }
  EXPECT_LT(s.bond.energy(s.state, s.rod), 1e-24 * unit);
}

TEST(TiedBond, ParticlesGainTheMassThatBoundsTheTies) {
  // At rest only the share of other forces is seen: m/(m + step² d). The d found in this way must
  // bound K, and no looser than by Gershgorin's rows.
  Scene s;
  s.state = State(s.model);
  const RodState rod(lattice::rod_body({}, {}));
  const Ties ties(s.model);
  const double step = 3e-4;
  VectorField force(s.model.points());
  for (const std::size_t i : s.model.particles) force.set(i, {1.0, -2.0, 3.0});
  s.bond.add(s.state, rod, step, force);
  Eigen::VectorXd d(ties.matrix.rows());
  for (std::size_t p = 0; p < ties.particles.size(); ++p) {
    const std::size_t i = ties.particles[p];
    const double share = force.at(i).x();
    EXPECT_NEAR((force.at(i) - share * Vector3(1.0, -2.0, 3.0)).norm(), 0.0, 1e-15);
    d[Eigen::Index(p)] = (1.0 / share - 1.0) * s.model.mass[i] / (step * step);
  }
  const Eigen::VectorXd rows = ties.matrix.cwiseAbs().rowwise().sum();
  EXPECT_LT((d - rows).cwiseAbs().maxCoeff(), 1e-9 * rows.maxCoeff());
  const Eigen::VectorXd scale = d.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * ties.matrix * scale.asDiagonal();
  const Eigen::VectorXd values =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_LE(values.maxCoeff(), 1.0 + 1e-12);
  EXPECT_GE(values.minCoeff(), -1e-12);
  // Particles away from the bond do not feel it.
  std::size_t free = 0;
  for (const std::size_t i : s.model.particles) free += force.at(i) == Vector3(1.0, -2.0, 3.0);
  EXPECT_EQ(free, s.model.particles.size() - ties.particles.size());
}

TEST(TiedBond, DoesNotLimitTheStep) {
  // Particles on their ties alone, at steps a hundred and more times what the ties would allow.
  Scene s(1e-3);
  const RodState rod(lattice::rod_body({}, {}));
  const Ties ties(s.model);
  double fastest = 0.0;
  for (std::size_t p = 0; p < ties.particles.size(); ++p) {
    fastest = std::max(fastest, ties.matrix(Eigen::Index(p), Eigen::Index(p)) *
                                    s.model.inverse_mass[ties.particles[p]]);
  }
  for (const double ratio : {1.0, 10.0, 1000.0}) {
    State state = s.state;
    const double step = ratio * 2.0 / std::sqrt(fastest);
    for (const std::size_t i : s.model.particles) state.velocity.set(i, Vector3::Zero());
    const double start = s.bond.energy(state, rod);
    double peak = 0.0;
    for (int n = 0; n < 1000; ++n) {
      VectorField force(s.model.points());
      s.bond.add(state, rod, step, force);
      for (const std::uint32_t i : ties.particles) {
        state.velocity.add(i, step * s.model.inverse_mass[i] * force.at(i));
        state.displacement.add(i, step * state.velocity.at(i));
      }
      peak = std::max(peak, s.bond.energy(state, rod));
    }
    EXPECT_LT(peak, 4.0 * start) << ratio;
  }
}

TEST(TiedBond, ActsAsItWillBeAtTheEndOfTheStep) {
  Scene s;
  const RodState rod(lattice::rod_body({}, {}));
  const double step = 1e-3;
  State ahead(s.model);
  for (const std::size_t i : s.model.particles) {
    ahead.displacement.set(i, s.state.displacement.at(i) + step * s.state.velocity.at(i));
  }
  VectorField now(s.model.points()), then = now;
  const Wrench a = s.bond.add(s.state, rod, step, now), b = s.bond.add(ahead, rod, step, then);
  EXPECT_LT(difference(s.model, now, then), 1e-12 * largest(s.model, now));
  EXPECT_LT((a.force - b.force).norm(), 1e-12 * a.force.norm());
}

TEST(TiedBond, TwoThreadsGiveTheSameBits) {
  Scene s;
  lattice::Team two_threads(2);
  TiedBond shared(s.model, two_threads);
  VectorField by_one = s.field(6), by_two = by_one;
  const Wrench a = s.bond.add(s.state, s.rod, 1e-4, by_one);
  const Wrench b = shared.add(s.state, s.rod, 1e-4, by_two);
  EXPECT_EQ(difference(s.model, by_one, by_two), 0.0);
  EXPECT_EQ(a.force, b.force);
  EXPECT_EQ(a.torque, b.torque);
}

TEST(TiedBond, EveryRegisterWidthGivesTheSameBits) {
  Scene s;
  const VectorField others = s.field(6);
  VectorField expected = others;
  const Wrench wrench = TiedBond(s.model, s.team, 2).add(s.state, s.rod, 1e-4, expected);
  for (int width = 4; width <= lattice::kernel::supported_width(); width *= 2) {
    VectorField force = others;
    const Wrench same = TiedBond(s.model, s.team, width).add(s.state, s.rod, 1e-4, force);
    EXPECT_EQ(difference(s.model, force, expected), 0.0) << width;
    EXPECT_EQ(same.force, wrench.force) << width;
    EXPECT_EQ(same.torque, wrench.torque) << width;
  }
}
