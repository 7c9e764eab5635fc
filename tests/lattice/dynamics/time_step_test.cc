#include "lattice/dynamics/time_step.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>

#include "lattice/forces/forces.h"
#include "meshes/base/errors.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;
using lattice::CellExtremes;
using lattice::Integrator;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::SpectralBounds;
using lattice::State;
using lattice::StepController;

namespace {

/// Largest eigenvalue of M⁻¹K at rest, by a dense solver.
double stiffest(const LatticeModel& model) {
  return largest_rate(model, tangent(model, State(model)));
}

/// Growth of a random free motion over `steps` steps of symplectic Euler.
double free_growth(const LatticeModel& model, double dt, int steps) {
  lattice::State state = random_state(model, 1e-3, 0.0, 1);
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  lattice::VectorField force(model.points());
  const double start = largest(model, state.displacement);
  double peak = 0.0;
  for (int n = 0; n < steps; ++n) {
    forces.accumulate(state, force);
    for (const std::size_t i : model.particles) {
      state.velocity.add(i, dt * model.inverse_mass[i] * force.at(i));
      state.displacement.add(i, dt * state.velocity.at(i));
    }
    peak = std::max(peak, largest(model, state.displacement));
    if (!(peak < 1e6 * start)) break;
  }
  return peak / start;
}

/// Whether some motion about the state overshoots: a step of length `dt` turns its sign and does
/// not shrink it. Motion that grows without turning its sign is physical (squeezed cells buckle).
bool overshoots(const LatticeModel& model, const State& state, double dt) {
  const Eigen::MatrixXd K = tangent(model, state), C = tangent(model, state, true);
  const Eigen::VectorXd kick = dt * mass_vector(model).cwiseInverse();
  const Eigen::Index n = K.rows();
  Eigen::MatrixXd step(2 * n, 2 * n);  // of displacement, velocity
  step.bottomLeftCorner(n, n) = -(kick.asDiagonal() * K);
  step.bottomRightCorner(n, n) = -(kick.asDiagonal() * C);
  step.bottomRightCorner(n, n).diagonal().array() += 1.0;
  step.topRows(n) = dt * step.bottomRows(n);
  step.topLeftCorner(n, n).diagonal().array() += 1.0;
  const Eigen::VectorXcd values = step.eigenvalues();
  return std::any_of(values.begin(), values.end(), [](const std::complex<double>& z) {
    return z.real() < 0.0 && std::abs(z) > 1.0 + 1e-6;
  });
}

CellExtremes extremes(const LatticeModel& model, const State& state) {
  lattice::Team team(1);
  lattice::InternalForces forces(model, team);
  lattice::VectorField force(model.points());
  return forces.accumulate(state, force);
}

/// The block squeezed along z to `stretch`, sheared a little so that nothing is symmetric.
State squeezed(const LatticeModel& model, double stretch) {
  State state(model);
  for (const std::size_t i : model.particles) {
    const Vector3 x = model.rest_position(i);
    state.displacement.set(i, Vector3(0.1 * (1.0 - stretch) * x.z(), 0.0, (stretch - 1.0) * x.z()));
  }
  return state;
}

}  // namespace

TEST(StableStep, SeparatesBoundedFromGrowingMotionWithoutDamping) {
  const LatticeModel model = block(ModelKind::hookean, Kinematics::small, {4, 4, 4}, 0.0);
  const double limit = 2.0 / std::sqrt(stiffest(model));
  EXPECT_NEAR(
      lattice::largest_stable_step({stiffest(model), 0.0, 0.0, 0.0}, Integrator::symplectic_euler),
      limit, 1e-12 * limit);
  EXPECT_LT(free_growth(model, 0.99 * limit, 5000), 100.0);
  EXPECT_GT(free_growth(model, 1.005 * limit, 5000), 1e5);
}

TEST(StableStep, SeparatesBoundedFromGrowingMotionWithDamping) {
  const double tau = 3e-4;
  const LatticeModel model = block(ModelKind::hookean, Kinematics::small, {4, 4, 4}, tau);
  const double lambda = stiffest(model);
  const double limit =
      lattice::largest_stable_step({lambda, tau * lambda, tau, tau}, Integrator::symplectic_euler);
  EXPECT_LT(free_growth(model, 0.99 * limit, 3000), 10.0);
  EXPECT_GT(free_growth(model, 1.01 * limit, 3000), 1e5);
}

TEST(StableStep, ExplicitEulerIsLimitedByTheRetardationTime) {
  // One underdamped oscillator: growth of |z| for z² + z (dt c - 2) + 1 - dt c + dt² lambda.
  const double lambda = 1e4, tau = 1e-3;
  const SpectralBounds bounds{lambda, tau * lambda, tau, tau};
  EXPECT_DOUBLE_EQ(lattice::largest_stable_step(bounds, Integrator::explicit_euler), tau);
  const auto modulus = [&](double dt) {
    const double b = dt * tau * lambda - 2.0, c = 1.0 - dt * tau * lambda + dt * dt * lambda;
    const std::complex<double> root = std::sqrt(std::complex<double>(b * b - 4.0 * c, 0.0));
    return std::max(std::abs((-b + root) / 2.0), std::abs((-b - root) / 2.0));
  };
  EXPECT_LT(modulus(0.99 * tau), 1.0);
  EXPECT_GT(modulus(1.01 * tau), 1.0);
  EXPECT_EQ(lattice::largest_stable_step({lambda, 0.0, 0.0, 0.0}, Integrator::explicit_euler), 0.0);
}

TEST(StepController, RefusesAnUnstableStepWithTheReason) {
  const auto rod = lattice::rod_body({}, {});
  for (const ModelKind kind : all_models) {
    const LatticeModel model = tip(kind, Kinematics::small, 5);
    const StepController steps(model, &rod, Integrator::symplectic_euler, std::nullopt);
    const lattice::StepReport report = steps.report(steps.limit({}));
    EXPECT_NEAR(report.step, 0.95 * report.spectral_bound, 1e-12 * report.step) << name(kind);
    EXPECT_NE(report.explanation.find("rules"), std::string::npos);
    for (const double wanted : {1.01 * report.spectral_bound, 0.0, -1.0}) {
      try {
        StepController(model, &rod, Integrator::symplectic_euler, wanted);
        FAIL() << "an unstable step was accepted";
      } catch (const meshes::InvalidInput& refusal) {
        EXPECT_EQ(refusal.violations().at(0).key, "run.time_step");
        EXPECT_FALSE(refusal.violations().at(0).remedy.empty());
      }
    }
    const double wanted = 0.3 * report.spectral_bound;
    EXPECT_EQ(StepController(model, &rod, Integrator::symplectic_euler, wanted).limit({}), wanted);
  }
}

/// A report speaks of the integrator that steps, of the paper's bound for the paper's model alone,
/// and of no spectrum where masses are scaled to have none that matters.
TEST(StepController, ReportsTheIntegratorThatStepsAndTheModelsOwnBounds) {
  const auto says = [](const lattice::StepReport& report, const char* words) {
    return report.explanation.find(words) != std::string::npos;
  };
  for (const ModelKind kind : all_models) {
    const LatticeModel model = tip(kind, Kinematics::small, 5);
    const StepController steps(model, nullptr, Integrator::symplectic_euler, std::nullopt);
    const lattice::StepReport report = steps.report(steps.limit({}));
    EXPECT_TRUE(report.explanation.starts_with("symplectic-euler with steps of "));
    EXPECT_TRUE(says(report, "of the spectral bound")) << report.explanation;
    const bool papers = kind == ModelKind::published;
    EXPECT_EQ(says(report, "omega0"), papers) << report.explanation;
    EXPECT_EQ(std::isnan(report.omega0), !papers);
    EXPECT_TRUE(!papers || std::abs(report.paper_bound * report.omega0 - 1.0) < 1e-12);
  }
  const LatticeModel model = tip(ModelKind::hookean, Kinematics::small, 5);
  const StepController scaled(model, nullptr, Integrator::mass_scaled, 2.5e-4);
  const lattice::StepReport report = scaled.report(2.5e-4);
  EXPECT_TRUE(report.explanation.starts_with("mass-scaled with steps of 250 us; "))
      << report.explanation;
  EXPECT_TRUE(std::isnan(report.spectral_bound));
}

TEST(StepController, DividesASpanEvenly) {
  const LatticeModel model = tip(ModelKind::hookean, Kinematics::small, 5);
  const StepController steps(model, nullptr, Integrator::symplectic_euler, std::nullopt);
  const double limit = steps.limit({});
  for (const double span : {1e-3, 0.1 * limit, limit, 1.001 * limit, 7.0 * limit}) {
    const double step = steps.divide(span, {}), count = span / step;
    EXPECT_NEAR(count, std::round(count), 1e-9 * count);
    EXPECT_LE(step, limit * (1.0 + 1e-9));
    EXPECT_LT((std::round(count) - 1.0) * limit, span);  // fewer would be too few
  }
  EXPECT_NEAR(steps.divide(7.0 * limit, {}), limit, 1e-9 * limit);
}

TEST(StepController, ExplicitEulerWithoutDampingHasNoStep) {
  const LatticeModel model = block(ModelKind::central, Kinematics::small, {2, 2, 2}, 0.0);
  EXPECT_THROW(StepController(model, nullptr, Integrator::explicit_euler, std::nullopt),
               meshes::InvalidInput);
}

TEST(StepController, FollowsCellsThatAreSqueezedAndLetGo) {
  for (const double tau : {0.0, 3e-4}) {
    SCOPED_TRACE(tau);
    const LatticeModel model = block(ModelKind::network, Kinematics::finite, {2, 2, 3}, tau);
    StepController steps(model, nullptr, Integrator::symplectic_euler, std::nullopt);
    const double at_rest = steps.limit({});
    int updates = 0;
    double smallest = at_rest;
    const auto visit = [&](double stretch) {
      const State state = squeezed(model, stretch);
      const CellExtremes now = extremes(model, state);
      if (steps.outdated(now)) {
        steps.update(state, now);
        EXPECT_FALSE(steps.outdated(now));
        ++updates;
      }
      const double limit = steps.limit(now);
      EXPECT_FALSE(overshoots(model, state, limit)) << stretch;
      EXPECT_TRUE(overshoots(model, state, 10.0 * limit)) << stretch;
      smallest = std::min(smallest, limit);
    };
    for (int percent = 100; percent >= 40; percent -= 5) visit(0.01 * percent);
    EXPECT_LT(smallest, 0.7 * at_rest);
    EXPECT_LT(updates, 13);  // not at every look
    for (int percent = 40; percent <= 100; percent += 20) visit(0.01 * percent);
    EXPECT_GT(steps.limit(extremes(model, State(model))), 0.8 * at_rest);
    EXPECT_LE(steps.limit(extremes(model, State(model))), at_rest);
  }
}

TEST(StepController, NoCellChangesItsVolumeByMoreThanATenth) {
  const LatticeModel model = block(ModelKind::network, Kinematics::finite, {2, 2, 3});
  const StepController steps(model, nullptr, Integrator::symplectic_euler, std::nullopt);
  State state(model);
  const double rate = 1e4;  // of the stretch along z [1/s]
  for (const std::size_t i : model.particles) {
    state.velocity.set(i, {0.0, 0.0, -rate * model.rest_position(i).z()});
  }
  EXPECT_NEAR(steps.limit(extremes(model, state)), 0.1 / rate, 1e-9 / rate);
}
