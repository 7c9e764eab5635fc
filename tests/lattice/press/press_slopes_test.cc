/// Derivatives of static presses against differences of whole presses and Euler's theorem; their
/// parts against energies of bodies made anew and against the assembled tangent.
#include "lattice/press/press_slopes.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "lattice/press/static_press.h"
#include "lattice/statics/cut_lattice.h"
#include "tests/expectations.h"
#include "tests/lattice/presses.h"
#include "tests/lattice/statics/body_sums.h"

using namespace fingertip;
using body_sums::LatticeBody;
using body_sums::VectorXd;
using Eigen::Index;
using Eigen::MatrixXd;
using lattice::Kinematics;
using lattice::ModelKind;
using lattice::PressParameter;
using lattice::PressSetup;
using meshes::ContactMode;

namespace {

constexpr double cm = 1e-2;

/// k3 takes part, so that every constant counts.
PressSetup press_at(int per_radius, std::vector<double> samples_cm, ContactMode contact,
                    ModelKind model, Kinematics kinematics) {
  for (double& sample : samples_cm) sample *= cm;
  PressSetup setup = presses::setup_of({.model = model,
                                        .per_radius = double(per_radius),
                                        .contact = contact,
                                        .samples = samples_cm,
                                        .kinematics = kinematics});
  setup.lattice.constants =
      lattice::hookean_constants(setup.rubber, setup.lattice.spacing,
                                 0.2 * setup.lattice.spacing * setup.rubber.shear_modulus);
  return setup;
}

/// Two hundredths of the rubber's thickness apart: with stick the ends of every other step.
std::vector<double> depths(double deepest_cm) {
  std::vector<double> samples;
  for (int i = 1; 0.01 * i < deepest_cm + 1e-9; ++i) samples.push_back(0.01 * i);
  return samples;
}

/// A press and how many points touched up to every sample.
struct Path {
  lattice::StaticOutcomeWithSlopes press;
  std::vector<std::size_t> touching;
};

Path path_of(const PressSetup& setup, const std::vector<PressParameter>& parameters) {
  Path path;
  path.press = lattice::run_static_press_with_slopes(
      setup, parameters, [&](const lattice::StaticOutcome& now, double) {
        path.touching.push_back(now.contact.size());
        return true;
      });
  return path;
}

PressSetup changed(const PressSetup& setup, PressParameter parameter, double factor) {
  PressSetup other = setup;
  set_value(parameter, factor * value_of(parameter, setup), other);
  return other;
}

/// Central differences of forces over the normal force, for a relative change of 1e-4: truncated at
/// 1e-8 times a third derivative of order 1 or less, on forces good to 1e-12.
void expect_differences(const PressSetup& setup) {
  constexpr double change = 1e-4, tolerance = 1e-7;
  const auto parameters = press_parameters(setup.lattice);
  const Path path = path_of(setup, parameters);
  for (std::size_t j = 0; j < parameters.size(); ++j) {
    const double p = value_of(parameters[j], setup);
    const Path up = path_of(changed(setup, parameters[j], 1.0 + change), {});
    const Path down = path_of(changed(setup, parameters[j], 1.0 - change), {});
    ASSERT_EQ(up.touching, path.touching) << "another piece of F(p): take another depth";
    ASSERT_EQ(down.touching, path.touching) << "another piece of F(p): take another depth";
    for (std::size_t i = 0; i < setup.protocol.samples.size(); ++i) {
      const auto sample = [i](const Path& of) { return of.press.outcome.response.samples()[i]; };
      const double scale = sample(path).normal_force;
      const auto expect = [&](double slope, double more, double less, const char* what) {
        EXPECT_NEAR(p * slope, (more - less) / (2.0 * change), tolerance * scale)
            << what << " by " << name(parameters[j]) << " at " << setup.protocol.samples[i];
      };
      const lattice::PressSlopes& slopes = path.press.slopes;
      expect(slopes.normal_force(Index(i), Index(j)), sample(up).normal_force,
             sample(down).normal_force, "normal force");
      expect(slopes.lateral_force_x(Index(i), Index(j)), sample(up).lateral_force_x,
             sample(down).lateral_force_x, "lateral force x");
      expect(slopes.lateral_force_y(Index(i), Index(j)), sample(up).lateral_force_y,
             sample(down).lateral_force_y, "lateral force y");
    }
  }
}

bool is_stiffness(PressParameter parameter) {
  return parameter != PressParameter::bond && parameter != PressParameter::contact;
}

/// Largest |sum p dF/dp / F - 1| over the samples, p all stiffnesses.
double homogeneity_error(const PressSetup& setup) {
  const auto parameters = press_parameters(setup.lattice);
  const auto press = lattice::run_static_press_with_slopes(setup, parameters);
  double worst = 0.0;
  for (Index i = 0; i < press.slopes.normal_force.rows(); ++i) {
    double sum = 0.0;
    for (std::size_t j = 0; j < parameters.size(); ++j)
      if (is_stiffness(parameters[j]))
        sum += value_of(parameters[j], setup) * press.slopes.normal_force(i, Index(j));
    const double force = press.outcome.response.samples()[std::size_t(i)].normal_force;
    worst = std::max(worst, std::abs(sum / force - 1.0));
  }
  return worst;
}

/// Of every part; outer points as if tied to where they rest.
double energy(const LatticeBody& body, const VectorXd& u) {
  LatticeBody outer;
  outer.bond = body.outer;
  return body_sums::elastic_energy(body, u) + body_sums::bond_energy(body, u) +
         body_sums::bond_energy(outer, u);
}

VectorXd random_field(Index size, double amplitude) {
  std::mt19937 generator(7);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  return VectorXd::NullaryExpr(size, [&] { return uniform(generator); });
}

}  // namespace

TEST(PressSlopes, AgreeWithDifferencesHookean) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick})
    expect_differences(press_at(6, depths(0.1), contact, ModelKind::hookean, Kinematics::small));
}

TEST(PressSlopes, AgreeWithDifferencesNetwork) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick})
    expect_differences(press_at(6, depths(0.1), contact, ModelKind::network, Kinematics::finite));
  expect_differences(
      press_at(6, {0.1}, ContactMode::frictionless, ModelKind::network, Kinematics::small));
}

TEST(PressSlopes, AgreeWithDifferencesCentralSprings) {
  expect_differences(
      press_at(6, depths(0.1), ContactMode::stick, ModelKind::central, Kinematics::small));
  expect_differences(
      press_at(6, {0.1}, ContactMode::frictionless, ModelKind::hookean, Kinematics::finite));
}

/// At first touch the elastic energy is far below the round-off of what the cells store; forces are
/// balanced all the same, and grow with depth, whatever the last bits of a factorisation.
TEST(PressSlopes, FirstTouchesHaveEquilibria) {
  double last = 0.0;
  for (int i = 1; i <= 40; ++i) {
    const double first = 1.75e-3 + 2e-5 * i;  // the first point touches at 1.74e-3 cm
    const PressSetup setup =
        press_at(4, {first, 0.005}, ContactMode::stick, ModelKind::network, Kinematics::finite);
    const auto press =
        lattice::run_static_press_with_slopes(setup, press_parameters(setup.lattice));
    const double force = press.outcome.response.samples().front().normal_force;
    EXPECT_GT(force, last) << first << " cm";
    last = force;
  }
}

/// Tilted and dragged, so that lateral forces count and anchors move with the plane.
TEST(PressSlopes, AgreeWithDifferencesTilted) {
  PressSetup setup =
      press_at(6, depths(0.06), ContactMode::stick, ModelKind::hookean, Kinematics::small);
  setup.protocol.tilt = 10.0 * std::numbers::pi / 180.0;
  setup.protocol.lateral = 1e-4;
  expect_differences(setup);
}

/// Beside the axis of a ball, so that the normal differs from point to point at finite strain.
TEST(PressSlopes, AgreeWithDifferencesOnABall) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    for (const auto& [model, kinematics] : {std::pair(ModelKind::hookean, Kinematics::small),
                                            std::pair(ModelKind::network, Kinematics::finite)}) {
      PressSetup setup = press_at(6, depths(0.05), contact, model, kinematics);
      setup.protocol.obstacle = {
          .shape = meshes::ObstacleShape::sphere, .radius = 6e-3, .offset = 1e-3};
      expect_differences(setup);
    }
  }
}

/// Springs of a constant that is zero are not in the body; its force still has a derivative.
/// One-sided, by extrapolation from steps of which the second is twice the first.
TEST(PressSlopes, AgreesWithDifferencesFromZero) {
  PressSetup setup =
      press_at(6, {0.1}, ContactMode::frictionless, ModelKind::central, Kinematics::small);
  setup.lattice.constants.k3 = 0.0;
  const auto base = lattice::run_static_press_with_slopes(setup, {{PressParameter::k3}});
  const auto force = [](const lattice::StaticOutcomeWithSlopes& press) {
    return press.outcome.response.samples().back().normal_force;
  };
  const double step = 1e-4 * setup.lattice.constants.k1;
  const auto rise = [&](double k3) {
    set_value(PressParameter::k3, k3, setup);
    return force(lattice::run_static_press_with_slopes(setup, {})) - force(base);
  };
  const double difference = (4.0 * rise(step) - rise(2.0 * step)) / (2.0 * step);
  EXPECT_GT(difference, 0.0);
  EXPECT_NEAR(base.slopes.normal_force(0, 0) / difference, 1.0, 1e-6);
}

/// All stiffnesses times c: the same motion, forces times c, so F = sum p dF/dp (Euler).
TEST(PressSlopes, ForceIsHomogeneousInTheStiffnesses) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    const auto at = [contact](ModelKind model, Kinematics kinematics) {
      return homogeneity_error(press_at(8, {0.05, 0.1}, contact, model, kinematics));
    };
    EXPECT_LT(at(ModelKind::hookean, Kinematics::small), 1e-8);
    EXPECT_LT(at(ModelKind::central, Kinematics::small), 1e-8);
    EXPECT_LT(at(ModelKind::network, Kinematics::finite), 1e-8);
    EXPECT_LT(at(ModelKind::hookean, Kinematics::finite), 1e-8);
  }
}

/// The path is the plain one, closer to equilibrium, and its slopes cost one preparation per
/// response.
TEST(PressSlopes, LeaveThePressAsItIs) {
  for (const ContactMode contact : {ContactMode::frictionless, ContactMode::stick}) {
    const PressSetup setup =
        press_at(6, {0.05, 0.1}, contact, ModelKind::hookean, Kinematics::small);
    const auto plain = lattice::run_static_press(setup);
    const auto sloped =
        lattice::run_static_press_with_slopes(setup, press_parameters(setup.lattice));
    const auto none = lattice::run_static_press_with_slopes(setup, {});
    EXPECT_EQ(sloped.outcome.steps, plain.steps);
    // States in closer balance take some steps more.
    EXPECT_LE(none.outcome.factorisations, 2 * plain.factorisations);
    if (contact == ContactMode::frictionless) {
      EXPECT_LE(sloped.outcome.factorisations, none.outcome.factorisations + 2);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const double force = plain.response.samples()[i].normal_force;
      EXPECT_NEAR(sloped.outcome.response.samples()[i].normal_force, force, 1e-6 * force);
      EXPECT_NEAR(none.outcome.response.samples()[i].normal_force,
                  sloped.outcome.response.samples()[i].normal_force, 1e-10 * force);
    }
    EXPECT_EQ(none.slopes.normal_force.rows(), 2);
    EXPECT_EQ(none.slopes.normal_force.cols(), 0);
  }
}

/// Energies are linear in every parameter, so the difference of those of two bodies made anew is
/// exact however far they are apart.
TEST(BodySlope, IsTheDerivativeOfTheEnergy) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::central, ModelKind::network}) {
    for (const Kinematics kinematics : {Kinematics::small, Kinematics::finite}) {
      PressSetup setup = press_at(6, {0.1}, ContactMode::stick, model, kinematics);
      setup.lattice.axes =
          Eigen::AngleAxisd(0.4, meshes::Vector3(1, 2, 3).normalized()).toRotationMatrix();
      setup.lattice.ligament_stiffness = 0.7;
      setup.lattice.contact_stiffness = 1.3;
      const LatticeBody body = static_body(setup, 1);
      const VectorXd u = random_field(body.unknowns(), 0.02 * setup.lattice.spacing);
      for (const PressParameter p : press_parameters(setup.lattice)) {
        const double more = energy(static_body(changed(setup, p, 1.4), 1), u);
        const double less = energy(static_body(changed(setup, p, 0.6), 1), u);
        const LatticeBody slope = body_slope(body, setup, {{p}});
        ASSERT_EQ(slope.outer.size(), body.outer.size());
        EXPECT_NEAR(value_of(p, setup) * energy(slope, u), (more - less) / 0.8,
                    1e-11 * energy(body, u))
            << name(model) << ' ' << name(kinematics) << ' ' << name(p);
        EXPECT_GT(std::abs(more - less), 1e-6 * energy(body, u)) << name(p);
      }
    }
  }
}

/// Against central differences, by E at held Poisson's ratio and by Poisson's ratio at held E.
TEST(PressSlopes, ByTheRubbersModuliStandInTheResponse) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::network}) {
    for (const ContactMode contact : {ContactMode::stick, ContactMode::frictionless}) {
      const auto pressed = [&](double ratio, double stiffer = 1.0) {
        PressSetup setup =
            press_at(5, depths(0.08), contact, model,
                     model == ModelKind::network ? Kinematics::finite : Kinematics::small);
        setup.protocol.mode = meshes::DriveMode::equilibrium;
        setup.slopes = true;
        setup.rubber.youngs_modulus *= stiffer;
        setup.rubber.shear_modulus = setup.rubber.youngs_modulus / (2.0 * (1.0 + ratio));
        setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
        return std::pair(run_static_press(setup).response.back(), setup.rubber.youngs_modulus);
      };
      constexpr double ratio = 0.42, change = 1e-5;
      const auto [sample, modulus] = pressed(ratio);
      const auto difference = [](const auto& more, const auto& less) {
        return (more.first.normal_force - less.first.normal_force) / (2.0 * change);
      };
      EXPECT_NEAR(sample.slope_youngs_modulus * modulus /
                      difference(pressed(ratio, 1.0 + change), pressed(ratio, 1.0 - change)),
                  1.0, 1e-5);
      EXPECT_NEAR(sample.slope_poissons_ratio /
                      difference(pressed(ratio + change), pressed(ratio - change)),
                  1.0, 1e-5);
    }
  }
}

TEST(PressParameters, ChangeOneByOne) {
  for (const ModelKind model : {ModelKind::hookean, ModelKind::central, ModelKind::network}) {
    const PressSetup setup = press_at(6, {0.1}, ContactMode::stick, model, Kinematics::small);
    for (const PressParameter p : press_parameters(setup.lattice)) {
      const PressSetup other = changed(setup, p, 1.1);
      for (const PressParameter q : press_parameters(setup.lattice)) {
        EXPECT_NEAR(value_of(q, other) / value_of(q, setup), p == q ? 1.1 : 1.0, 1e-12)
            << name(p) << ' ' << name(q);
      }
    }
  }
}

TEST(PressParameters, RefusesWhatTheModelDoesNotHave) {
  PressSetup setup = press_at(6, {0.1}, ContactMode::stick, ModelKind::central, Kinematics::small);
  const auto refused = [&](PressParameter p) {
    EXPECT_TRUE(refuses<meshes::InvalidInput>(
        [&] { lattice::run_static_press_with_slopes(setup, {{p}}); }, std::string(name(p))));
  };
  refused(PressParameter::kappa);
  refused(PressParameter::lambda);
  setup.lattice.model = ModelKind::network;
  refused(PressParameter::k1);
  setup.lattice.model = ModelKind::published;
  EXPECT_TRUE(press_parameters(setup.lattice).empty());
  refused(PressParameter::k1);
}

/// K x = f with K of the system and the contact, from a guess however bad.
TEST(EquilibriumSolver, RespondsToSmallForces) {
  const PressSetup setup =
      press_at(6, {0.1}, ContactMode::frictionless, ModelKind::network, Kinematics::finite);
  const LatticeBody body = static_body(setup, 4);
  const lattice::ElasticSystem system(body);
  lattice::StaticContact contact(body, lattice::press_plane(setup.protocol, setup.geometry),
                                 setup.protocol.contact);
  lattice::EquilibriumSolver solver(system);
  VectorXd u = VectorXd::Zero(body.unknowns());
  contact.begin_step(5e-4, u);
  ASSERT_TRUE(solver.solve(contact, u));
  MatrixXd forces = MatrixXd::Zero(u.size(), 3), responses = forces;
  forces.col(0) = random_field(u.size(), 1e-3);
  responses.col(2) = random_field(u.size(), 1e-3);  // where zero is the answer
  for (Index i = 0; i < u.size(); ++i) {
    if (!body.fixed[std::size_t(i)]) continue;
    forces.row(i).setZero();
    responses.row(i).setZero();
  }
  forces.col(1) = 1e5 * forces.col(0);
  ASSERT_TRUE(solver.respond(contact, u, forces, responses));
  lattice::Tangent tangent = system.empty_tangent();
  VectorXd unbalanced;
  system.assemble(u, unbalanced, &tangent);
  contact.add(u, system, unbalanced, &tangent);
  VectorXd left = tangent.selfadjointView<Eigen::Lower>() * responses.col(0) - forces.col(0);
  for (Index i = 0; i < u.size(); ++i)
    if (body.fixed[std::size_t(i)]) left[i] = 0.0;
  EXPECT_LT(left.norm(), 1e-10 * forces.col(0).norm());
  EXPECT_LT((responses.col(1) - 1e5 * responses.col(0)).norm(), 1e-9 * responses.col(1).norm());
  EXPECT_EQ(responses.col(2).norm(), 0.0);
}

/// A compressed bar that may go sideways has a tangent that is not positive definite.
TEST(EquilibriumSolver, DoesNotRespondWhereEquilibriumIsUnstable) {
  LatticeBody body;
  body.finite = true;
  body.rest = {{0.0, 0.0, 0.0}, {1e-3, 0.0, 0.0}};
  body.springs = {{{0, 1}, 1.0}};
  body.fixed = {1, 1, 1, 1, 0, 1};
  const lattice::ElasticSystem system(body);
  const lattice::StaticContact contact(body, {}, ContactMode::frictionless);
  lattice::EquilibriumSolver solver(system);
  MatrixXd force = MatrixXd::Zero(6, 1), response = force;
  force(4, 0) = 1e-6;
  VectorXd u = VectorXd::Zero(6);
  u[3] = 1e-4;
  ASSERT_TRUE(solver.respond(contact, u, force, response));
  EXPECT_NEAR(response(4, 0), 1e-6 * 1.1e-3 / 1e-4, 1e-14);  // over tension/length
  u[3] = -1e-4;
  EXPECT_FALSE(solver.respond(contact, u, force, response));
}
