#include "lattice/dynamics/scaling/mass_scaling.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "lattice/control/virtual_finger.h"
#include "lattice/forces/energy.h"
#include "lattice/forces/forces.h"
#include "lattice/press/press.h"
#include "tests/lattice/finger_scenes.h"
#include "tests/lattice/fixtures.h"

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

LatticeModel coarse(ModelKind kind, int sectors = 1) {
  lattice::LatticeSettings settings =
      settings_for(kind, kind == ModelKind::network ? Kinematics::finite : Kinematics::small, 4);
  settings.constants = lattice::hookean_constants({}, settings.spacing);
  settings.offset = Vector3(0.3, -0.2, 0.1);  // slivers everywhere
  if (sectors > 1) settings.offset = Vector3(0.0, 0.0, 0.1);
  return lattice::build_tip({}, {}, settings, sectors);
}

MassScaling scaling_of(const LatticeModel& model, const State& state, double margin = 1.1,
                       std::span<const lattice::BondInertia> bond = {}) {
  MassScaling scaling(std::make_shared<lattice::ScalingGround>(model));
  lattice::Team team(1);
  scaling.make(state, bond, step, team, margin);
  return scaling;
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
      slope -= side * packed(model, held(model, force)) / (2.0 * h);
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
  VectorField force = spread(model, f);
  if (scaling == nullptr) {
    for (const std::uint32_t i : model.particles) force.set(i, model.inverse_mass[i] * force.at(i));
    return packed(model, force);
  }
  AccelerationFields fields = scaling->fields();
  State state(model);
  const lattice::Reactions reactions = scaling->accelerate(state, {}, force, team, fields);
  scaling->move(state, {}, reactions, team, fields);
  return packed(model, state.velocity) / scaling->step();
}

/// Largest eigenvalue of W (dt² K + 2 dt C), from below: W is symmetric, so (dt² K + 2 dt C) W is
/// self-adjoint in the product <f, W g>, and Rayleigh quotients of power iterates rise.
double largest_product(const LatticeModel& model, const State& at, const MassScaling* scaling) {
  VectorXd f = packed(model, held(model, random_state(model, 1.0, 0.0, 11).displacement));
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
    const Vector3 u = strain * Vector3(0.3 * x.x(), 0.3 * x.y(), -x.z());
    state.displacement.add(i, model.grid.axes.transpose() * u);
  }
  state.displacement = held(model, state.displacement);
  return state;
}

/// By an angle [rad].
State turned(const LatticeModel& model, State state, const Vector3& angle) {
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle.norm(), angle.normalized()).toRotationMatrix();
  for (const std::uint32_t i : model.particles) {
    const Vector3 rest = model.grid.axes.transpose() * model.rest_position(i);
    state.displacement.set(i, turn * (rest + state.displacement.at(i)) - rest);
  }
  return state;
}

class LongSteps : public testing::TestWithParam<std::tuple<ModelKind, double, int>> {};

}  // namespace

TEST_P(LongSteps, AreStableForEveryMotion) {
  const auto [kind, strain, sectors] = GetParam();
  const LatticeModel model = coarse(kind, sectors);
  const State state = compressed(model, strain);
  const MassScaling scaling = scaling_of(model, state, 1.0);
  const double largest = largest_product(model, state, &scaling);
  EXPECT_LE(largest, 4.0);
  EXPECT_GT(largest, 0.5);
  EXPECT_GT(largest_product(model, state, nullptr), 16.0);
}

/// A scaling is made anew when a cell has strained or turned by a fifth.
TEST(MassScaling, BearsWhatCellsStrainAndTurnUntilItIsMadeAnew) {
  const LatticeModel model = coarse(ModelKind::network);
  for (const double strain : {0.0, 0.2}) {
    const MassScaling scaling = scaling_of(model, compressed(model, strain));
    EXPECT_LE(largest_product(model, compressed(model, strain + 0.2), &scaling), 3.5) << strain;
    for (const Vector3& axis : {Vector3(0.0, 0.0, 1.0), Vector3(1.0, -1.0, 1.0).normalized()})
      EXPECT_LE(
          largest_product(model, turned(model, compressed(model, strain), 0.2 * axis), &scaling),
          3.5)
          << strain << " " << axis.transpose();
  }
}

TEST(MassScaling, RespondsSymmetrically) {
  const LatticeModel model = coarse(ModelKind::network);
  const MassScaling scaling = scaling_of(model, compressed(model, 0.2));
  const VectorXd f = packed(model, random_state(model, 1.0, 0.0, 1).displacement);
  const VectorXd g = packed(model, random_state(model, 1.0, 0.0, 2).displacement);
  const VectorXd of_f = response(model, &scaling, f);
  const double own = f.dot(of_f);
  EXPECT_NEAR(f.dot(response(model, &scaling, g)), g.dot(of_f), 1e-5 * own);
  EXPECT_GT(own, 0.0);
}

INSTANTIATE_TEST_SUITE_P(Lattices, LongSteps,
                         testing::Values(std::tuple(ModelKind::hookean, 0.0, 1),
                                         std::tuple(ModelKind::network, 0.0, 1),
                                         std::tuple(ModelKind::network, 0.3, 1),
                                         std::tuple(ModelKind::network, 0.0, 4),
                                         std::tuple(ModelKind::network, 0.3, 2),
                                         std::tuple(ModelKind::network, 0.3, 4)));

TEST(MassScaling, TendsToPlainMassesWithTheStep) {
  const LatticeModel model = coarse(ModelKind::network);
  const VectorXd f = packed(model, random_state(model, 1.0, 0.0, 1).displacement),
                 plain = response(model, nullptr, f);
  double before = 1e300;
  for (const double shorter : {1e-5, 1e-6, 1e-7}) {
    MassScaling scaling = scaling_of(model, State(model));
    lattice::Team team(1);
    scaling.make(State(model), {}, shorter, team);
    const double error = (response(model, &scaling, f) - plain).norm() / plain.norm();
    EXPECT_LT(error, 0.3 * before);
    before = error;
  }
  EXPECT_LT(before, 1e-2);
}

namespace {

lattice::FingerSetup free_finger() {
  lattice::FingerSetup setup;
  setup.lattice = settings_for(ModelKind::network, Kinematics::finite, 6);
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.plane = {.point = {0.0, 0.0, 1.0}};
  setup.integrator = lattice::Integrator::mass_scaled;
  setup.time_step = 5e-4;
  setup.threads = 1;
  return setup;
}

}  // namespace

TEST(ScaledFinger, MovesAsOneBodyWhereNothingHoldsIt) {
  lattice::VirtualFinger finger(free_finger());
  const double mass = finger.finger().rod().body().mass + finger.model().total_mass();
  const Vector3 force(0.003, -0.002, 0.01);
  const Vector3 torque(2e-6, 0.0, -1e-6);
  finger.write(lattice::Wrench{force, torque});
  Vector3 turned = Vector3::Zero();
  for (int n = 0; n < 100; ++n) {
    turned += 5e-4 * (torque + finger.finger().rod().endpoint().cross(force));
    finger.do_step(5e-4);
  }
  const Vector3 momentum = lattice::linear_momentum(finger.model(), finger.finger().state()) +
                           finger.finger().rod().momentum();
  EXPECT_LT((momentum - 0.05 * force).norm(), 1e-10 * momentum.norm());
  EXPECT_LT((angular_momentum(finger) - turned).norm(), 1e-9 * turned.norm());
  const Vector3 rubber = lattice::linear_momentum(finger.model(), finger.finger().state());
  EXPECT_NEAR(rubber.norm() / momentum.norm(), finger.model().total_mass() / mass, 0.05);
}

/// The plane is told what is missing in the balance of momentum; its moment has to be the right
/// one, too, with particles that follow the rod in part.
TEST(ScaledFinger, BalancesAngularMomentumOnThePlane) {
  using meshes::ContactMode;
  for (const auto contact : {ContactMode::stick, ContactMode::frictionless, ContactMode::coulomb}) {
    lattice::FingerSetup setup = pushed_finger(
        {ModelKind::network, Kinematics::finite, contact, lattice::Integrator::mass_scaled}, 1);
    setup.time_step = 1e-3;
    lattice::VirtualFinger finger(setup);
    const lattice::Wrench push{Vector3(4e-3, -2e-3, 0.04), Vector3(1e-5, 2e-5, 1e-5)};
    finger.write(push);
    double worst = 0.0, largest = 0.0;
    Vector3 before = angular_momentum(finger), endpoint = finger.finger().rod().endpoint();
    for (int n = 0; n < 60; ++n) {
      finger.do_step(1e-3, [&] {
        const lattice::Finger& now = finger.finger();
        const Vector3 given =
            now.step() * (push.torque + endpoint.cross(push.force)) + now.plane_impulse().torque;
        const Vector3 after = angular_momentum(finger);
        worst = std::max(worst, (after - before - given).norm());
        largest = std::max(largest, now.plane_impulse().torque.norm());
        before = after;
        endpoint = now.rod().endpoint();
        return true;
      });
    }
    EXPECT_GT(finger.finger().touching(), 0);
    EXPECT_GT(largest, 1e-8);
    EXPECT_LT(worst, 1e-9 * largest) << int(contact);
    EXPECT_LT(finger.finger().momentum_defect(), 1e-12 * finger.finger().largest_impulse());
  }
}

TEST(ScaledFinger, NotesEnergiesOfTheStepsStart) {
  lattice::FingerSetup setup = free_finger();
  setup.plane = {.point = {0.0, 0.0, 0.01 + 1e-5}};
  setup.contact = {meshes::ContactMode::stick};
  lattice::VirtualFinger pressed(setup);
  lattice::Finger& finger = pressed.finger();
  const auto of_rubber = [&] {
    return lattice::elastic_energy(pressed.model(), finger.state()) + finger.bond_energy();
  };
  pressed.write(lattice::Wrench{Vector3(0.0, 0.0, 5e-2), Vector3::Zero()});
  double contact = 0.0;
  for (int n = 0; n < 40; ++n) {
    const double rubber = of_rubber(), kinetic = finger.kinetic_energy();
    finger.note_energy();
    pressed.do_step(finger.step());
    contact = finger.elastic_energy() - of_rubber();  // of this step's start
    EXPECT_NEAR(finger.noted_energy().elastic, rubber + contact, 1e-9 * (rubber + contact));
    EXPECT_NEAR(finger.noted_energy().kinetic, kinetic, 1e-13 * kinetic);
  }
  EXPECT_GT(finger.touching(), 0);
  EXPECT_GT(contact, 0.0);
}

TEST(ScaledFinger, ComesToRestOnARodMuchLighterThanItsRubber) {
  lattice::FingerSetup setup = free_finger();
  setup.rod.density *= 0.02;
  lattice::VirtualFinger finger(setup);
  ASSERT_LT(finger.finger().rod().body().mass, 0.1 * finger.model().total_mass());
  const Vector3 centre = finger.finger().rod().centre();
  const auto energy = [&] { return finger.finger().elastic_energy(); };
  finger.write(lattice::Wrench{Vector3(5e-3, 2e-3, 5e-3), Vector3(1e-5, 1e-5, 0.0)});
  finger.do_step(2e-3);
  const double struck = energy();
  EXPECT_GT(struck, 0.0);
  finger.write(lattice::Wrench{});
  finger.do_step(0.3);
  EXPECT_LT(energy(), 0.01 * struck);
  EXPECT_LT((finger.finger().rod().centre() - centre).norm(), 0.1);
}

namespace {

/// What makes the plane's share of the rod's inertia large, against the usual finger.
struct HeavyHold {
  double moduli, retardation_time, rod_density;
};

void PrintTo(const HeavyHold& hold, std::ostream* out) {
  *out << "moduli " << hold.moduli << ", tau " << hold.retardation_time << " s, rod "
       << hold.rod_density;
}

class FreeRodOnATipThatSticks : public testing::TestWithParam<HeavyHold> {};

}  // namespace

/// A free rod pushed into the plane by a force that grows, kept upright by a soft hand, pushed
/// laterally for a moment, and left to come to rest.
TEST_P(FreeRodOnATipThatSticks, ComesToRest) {
  lattice::FingerSetup setup = free_finger();
  setup.plane = {.point = {0.0, 0.0, 0.01 + 1e-5}};
  setup.contact = {meshes::ContactMode::stick};
  setup.time_step = 1e-3;
  setup.rubber.youngs_modulus *= GetParam().moduli;
  setup.rubber.shear_modulus *= GetParam().moduli;
  setup.rubber.retardation_time = GetParam().retardation_time;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.rod.density *= GetParam().rod_density;
  lattice::VirtualFinger finger(setup);
  const double weight = 0.05 * GetParam().moduli;     // [N], some 0.12 cm deep
  const double stiffness = 0.02 * GetParam().moduli;  // of the hand [N m]
  // Turned about its own axis a rod is light: a hand as stiff as across it, asked once in a
  // millisecond, sways whatever the rubber does.
  const Eigen::Matrix3d inertia = finger.rod_body().inertia_at_endpoint().bottomRightCorner<3, 3>();
  const double frequency = std::sqrt(stiffness / inertia(0, 0));
  double fastest = 0.0;
  for (int n = 0; n < 1500; ++n) {
    const double share = std::min(1.0, n / 300.0);
    const double tangential = n >= 400 && n < 410 ? 0.1 * weight : 0.0;
    const lattice::RodState& rod = finger.finger().rod();
    const Vector3 drag = -70.0 * rod.body().mass * rod.velocity_at(rod.endpoint());
    const Vector3 upright =
        -frequency * inertia *
        (frequency * lattice::rotation_vector(rod.pose().orientation) + rod.angular_velocity());
    finger.write(lattice::Wrench{Vector3(tangential, 0.0, share * weight) + drag, upright});
    finger.do_step(1e-3);
    if (n >= 1400) fastest = std::max(fastest, rod.velocity().norm());
  }
  EXPECT_GT(finger.finger().touching(), 0);
  EXPECT_LT(fastest, 1e-4);
  EXPECT_NEAR(finger.finger().plane_impulse().force.z() / finger.finger().step(), -weight,
              1e-3 * weight);
  EXPECT_LT(finger.finger().momentum_defect(), 1e-12 * finger.finger().largest_impulse());
}

INSTANTIATE_TEST_SUITE_P(Holds, FreeRodOnATipThatSticks,
                         testing::Values(HeavyHold{1.0, 3e-4, 1.0}, HeavyHold{2.0, 3e-4, 1.0},
                                         HeavyHold{1.0, 1e-2, 1.0}, HeavyHold{1.0, 3e-4, 0.25}));

TEST(Restraint, IsLargeOnThePatchNothingAtTheBondAndBoundsWhatTheRodFeels) {
  const LatticeModel model = lattice::build_tip({}, {}, free_finger().lattice);
  lattice::Team team(1);
  MassScaling scaling(std::make_shared<lattice::ScalingGround>(model));
  const double held = 1e3 * model.total_mass();
  std::vector<lattice::BondInertia> bond;
  for (const lattice::EmbeddedPoint& tie : model.bond) bond.push_back({tie.corners[0], held});
  scaling.make(State(model), bond, step, team);
  std::vector<lattice::ContactInertia> ties;
  const Vector3 normal = model.grid.axes.transpose() * -Vector3::UnitZ();
  for (const std::uint32_t i : model.particles)
    if (model.rest_position(i).z() > 0.0095)
      ties.push_back({i, held * normal * normal.transpose(),
                      model.grid.axes.transpose() * model.rest_position(i)});
  lattice::PlaneHold plane;
  plane.ties = ties;
  plane.normal = normal;
  AccelerationFields fields = scaling.fields();
  lattice::Restraint restraint = scaling.restraint();
  EXPECT_FALSE(restraint.holds);
  scaling.restrain(State(model), plane, team, fields, restraint);
  ASSERT_TRUE(restraint.holds);
  for (const lattice::ContactInertia& tie : ties)
    EXPECT_GT(restraint.share[0][tie.particle], 0.45);  // one cycle: not quite 1
  for (const lattice::BondInertia& tie : bond) EXPECT_LT(restraint.share[0][tie.particle], 0.01);
  // Frictionless: nothing is kept across.
  for (const std::uint32_t i : model.particles)
    EXPECT_EQ(restraint.share[1][i] + restraint.share[2][i], 0.0F);
  lattice::Vector6 press = lattice::Vector6::Zero(), slide = press;
  press.head<3>() = normal;
  slide.head<3>() = normal.unitOrthogonal();
  const double felt = press.dot(restraint.inertia * press);
  EXPECT_GT(felt, 0.0);
  EXPECT_LT(felt, double(ties.size()) * held);
  EXPECT_LT(std::abs(slide.dot(restraint.inertia * slide)), 1e-12 * felt);
  // Found anew when the plane has turned, and not before.
  const auto shares = restraint.share[0];
  for (lattice::ContactInertia& tie : ties) tie.inertia *= 1.05;
  scaling.restrain(State(model), plane, team, fields, restraint);
  EXPECT_EQ(restraint.share[0], shares);
  plane.normal = (normal + 0.3 * normal.unitOrthogonal()).normalized();
  for (lattice::ContactInertia& tie : ties)
    tie.inertia = held * plane.normal * plane.normal.transpose();
  scaling.restrain(State(model), plane, team, fields, restraint);
  EXPECT_NE(restraint.share[0], shares);
  for (const std::uint32_t i : model.particles)
    EXPECT_EQ(restraint.share[1][i] + restraint.share[2][i], 0.0F);
  plane.ties = {};
  scaling.restrain(State(model), plane, team, fields, restraint);
  EXPECT_FALSE(restraint.holds);
}

TEST(ScaledFinger, RefusesAScalingOfAnotherStep) {
  const lattice::FingerSetup setup = free_finger();
  const LatticeModel model = lattice::build_tip({}, {}, setup.lattice);
  lattice::Finger finger(model, lattice::rod_body({}, {}), setup.plane, {}, setup.integrator, 5e-4,
                         1);
  finger.scale_masses(
      std::make_shared<MassScaling>(std::make_shared<lattice::ScalingGround>(model)));
  finger.advance(lattice::Wrench{});
  finger.set_step(2.5e-4);
  EXPECT_THROW(finger.advance(lattice::Wrench{}), std::logic_error);
}

TEST(MassScaling, RefusesSpringsAndBlocks) {
  const LatticeModel springs = tip(ModelKind::central, Kinematics::small, 4);
  const LatticeModel free = block(ModelKind::network, Kinematics::finite, {2, 2, 2});
  for (const LatticeModel* model : {&springs, &free}) {
    EXPECT_THROW(scaling_of(*model, State(*model)), std::invalid_argument);
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
  setup.time_step = 2.5e-4;  // or so coarse a lattice would be pressed with plain masses
  setup.threads = 1;
  return setup;
}

}  // namespace

TEST(MassScaledPress, MeetsThatOfShortSteps) {
  lattice::PressSetup setup = press(6);
  const auto scaled = lattice::run_press(setup);
  setup.time_step = 6.25e-5;
  const auto quarter = lattice::run_press(setup);
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
      if (sample.indentation < 0.8e-3) continue;
      worst = std::max(
          worst, std::abs(outcome.response.samples()[n].normal_force / sample.normal_force - 1.0));
    }
    return worst;
  };
  EXPECT_LT(error(scaled), 0.01);
  EXPECT_LT(error(quarter), 0.5 * error(scaled));
}

TEST(MassScaledPress, StepsOfAControlPeriodStayUprightAndNearShorterOnes) {
  lattice::PressSetup setup = press(8);
  setup.protocol.depth = 2.5e-3;
  const auto quarter = lattice::run_press(setup);
  setup.time_step = 1e-3;
  const auto whole = lattice::run_press(setup);
  const double periods = std::round(whole.simulated_time / 1e-3);
  EXPECT_NEAR(double(whole.steps.accepted), periods, 2.0);
  double tilt = 0.0;
  for (const lattice::TraceRow& row : whole.trace) tilt = std::max(tilt, row.tilt);
  EXPECT_LT(tilt, 1e-5);
  for (const meshes::PressSample& sample : quarter.response.samples()) {
    if (sample.indentation < 1e-3) continue;
    EXPECT_NEAR(whole.response.normal_force_at(sample.indentation) / sample.normal_force, 1.0, 0.01)
        << sample.indentation;
  }
}

TEST(MassScaledPress, AFreeRodGoesOnFromASavedState) {
  const lattice::FingerSetup setup =
      pushed_finger({ModelKind::network, Kinematics::finite, meshes::ContactMode::stick,
                     lattice::Integrator::mass_scaled},
                    1);
  const auto push = [](lattice::VirtualFinger& finger) {
    finger.write(lattice::Wrench{Vector3(1e-3, 0.0, 0.03), Vector3::Zero()});
    for (int n = 0; n < 30; ++n) finger.do_step(1e-3);
  };
  lattice::VirtualFinger finger(setup), straight(setup);
  push(finger);
  push(straight);
  ASSERT_GT(finger.finger().touching(), 0);
  const auto saved = finger.save();
  push(finger);
  finger.load(saved);
  EXPECT_TRUE(same_bits(finger, straight));
  push(finger);
  push(straight);
  EXPECT_TRUE(same_bits(finger, straight));
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
