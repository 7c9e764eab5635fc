#include "lattice/spectrum.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <complex>
#include <numbers>

#include "fixtures.h"
#include "lattice/forces.h"
#include "lattice/stiffness.h"
#include "lattice/time_step.h"
#include "meshes/errors.h"

using namespace fingertip;
using namespace fixtures;
using lattice::Integrator;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::SpectralBounds;

namespace {

/// The infinite published lattice with m = k1 = 1, Bloch wave of wave vector q (per spacing):
/// stiffness and damping are real symmetric 3 x 3.
struct Bloch {
  Eigen::Matrix3d stiffness = Eigen::Matrix3d::Zero(), damping = Eigen::Matrix3d::Zero();
  explicit Bloch(const Vector3& q) {
    for (const auto& s : lattice::half_stencil) {
      const Vector3 step(s.dx, s.dy, s.dz);
      const Vector3 d = step.normalized();
      const double k = 1.0 / step.norm(), mu = 2.0 * std::sqrt(0.5 * k);
      const double wave = 2.0 * (1.0 - std::cos(q.dot(step)));
      stiffness += k * wave * d * d.transpose();
      damping += mu * wave * d * d.transpose();
    }
  }
};

/// Largest growth factor of a Bloch wave in one step.
double growth(const Bloch& wave, Integrator integrator, double dt) {
  Eigen::Matrix<double, 6, 6> step;
  const auto one = Eigen::Matrix3d::Identity();
  if (integrator == Integrator::explicit_euler) {
    step << one, dt * one, -dt * wave.stiffness, one - dt * wave.damping;
  } else {
    step << one - dt * dt * wave.stiffness, dt * (one - dt * wave.damping), -dt * wave.stiffness,
        one - dt * wave.damping;
  }
  return step.eigenvalues().cwiseAbs().maxCoeff();
}

double worst_growth(Integrator integrator, double dt) {
  double worst = 0.0;
  const int n = 8;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= i; ++j) {
      for (int k = 0; k <= j; ++k) {
        if (i == 0) continue;
        const Vector3 q = std::numbers::pi / n * Vector3(i, j, k);
        worst = std::max(worst, growth(Bloch(q), integrator, dt));
      }
    }
  }
  return worst;
}

SpectralBounds infinite_published_bounds() {
  const LatticeModel model = block(ModelKind::published, Kinematics::small, {6, 6, 6});
  SpectralBounds bounds = lattice::spectral_bounds(model, nullptr);
  const double rate = std::sqrt(model.stiffness[0] / model.mass[model.particles[0]]);
  bounds.stiffness /= rate * rate;
  bounds.damping /= rate;
  bounds.shortest_retardation *= rate;
  bounds.longest_retardation *= rate;
  return bounds;
}

/// Largest eigenvalue of M⁻¹K of a free block, by a dense solver.
double exact_stiffness(const LatticeModel& model) {
  const Eigen::VectorXd scale = lattice::mass_vector(model).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd k(lattice::small_strain_stiffness(model));
  const Eigen::MatrixXd scaled = scale.asDiagonal() * k * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .maxCoeff();
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

}  // namespace

TEST(InfinitePublishedLattice, BoundsAreTheKnownNumbers) {
  const SpectralBounds bounds = infinite_published_bounds();
  EXPECT_NEAR(bounds.stiffness, 12.74, 0.01);
  EXPECT_NEAR(bounds.damping, 20.9, 0.05);
  EXPECT_NEAR(lattice::largest_stable_step(bounds, Integrator::explicit_euler), 0.0982, 2e-4);
  EXPECT_NEAR(lattice::largest_stable_step(bounds, Integrator::symplectic_euler), 0.0930, 2e-4);
}

TEST(InfinitePublishedLattice, BlochWavesConfirmTheLimits) {
  // The exact explicit limit is 0.0987 sqrt(m/k1); the bound may lie below it, never above.
  EXPECT_LE(worst_growth(Integrator::explicit_euler, 0.0985), 1.0 + 1e-12);
  EXPECT_GT(worst_growth(Integrator::explicit_euler, 0.0990), 1.0 + 1e-4);
  EXPECT_LE(worst_growth(Integrator::symplectic_euler, 0.0929), 1.0 + 1e-12);
  EXPECT_GT(worst_growth(Integrator::symplectic_euler, 0.0935), 1.0 + 1e-4);
}

TEST(InfinitePublishedLattice, ThePapersFrequencyIsNotConservative) {
  // dt = 1/omega0 = sqrt(m/(2k)), "much shorter" than which the paper wants the step to be.
  EXPECT_GT(worst_growth(Integrator::explicit_euler, 0.2 * std::sqrt(0.5)), 1.0);
}

TEST(SpectralBounds, LieAboveTheExactEigenvalue) {
  for (const ModelKind kind : all_models) {
    const LatticeModel model = block(kind, Kinematics::small, {4, 3, 5});
    const double exact = exact_stiffness(model);
    const double bound = lattice::spectral_bounds(model, nullptr).stiffness;
    const double estimate = lattice::spectral_estimate(model).stiffness;
    EXPECT_GE(bound, exact * (1.0 - 1e-12)) << name(kind);
    EXPECT_LT(bound, 2.5 * exact) << name(kind);
    EXPECT_LE(estimate, exact * (1.0 + 1e-10)) << name(kind);
    EXPECT_GT(estimate, 0.99 * exact) << name(kind);
  }
}

TEST(SpectralBounds, OfAHookeanCellIncludeItsBreathing) {
  const meshes::Rubber rubber;
  const double a = 1e-3;
  const LatticeModel model = lattice::build_block(ModelKind::hookean, Kinematics::small,
                                                  lattice::hookean_constants(rubber, a), a,
                                                  {1, 1, 1}, rubber.density, 0.0);
  EXPECT_NEAR(exact_stiffness(model), 12.0 * rubber.bulk_modulus() / (rubber.density * a * a),
              1e-6 * exact_stiffness(model));
}

TEST(StableStep, SeparatesBoundedFromGrowingMotionWithoutDamping) {
  const LatticeModel model = block(ModelKind::hookean, Kinematics::small, {4, 4, 4}, 0.0);
  const double limit = 2.0 / std::sqrt(exact_stiffness(model));
  EXPECT_NEAR(lattice::largest_stable_step({exact_stiffness(model), 0.0, 0.0, 0.0},
                                           Integrator::symplectic_euler),
              limit, 1e-12 * limit);
  EXPECT_LT(free_growth(model, 0.99 * limit, 5000), 100.0);
  EXPECT_GT(free_growth(model, 1.005 * limit, 5000), 1e5);
}

TEST(StableStep, SeparatesBoundedFromGrowingMotionWithDamping) {
  const double tau = 3e-4;
  const LatticeModel model = block(ModelKind::hookean, Kinematics::small, {4, 4, 4}, tau);
  const double lambda = exact_stiffness(model);
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

TEST(ChooseStep, RefusesAnUnstableStepWithTheReason) {
  const LatticeModel model = tip(ModelKind::hookean, Kinematics::small, 5);
  const auto rod = lattice::rod_body({}, {});
  const auto report =
      lattice::choose_step(model, &rod, Integrator::symplectic_euler, std::nullopt, 1e-3);
  EXPECT_LT(report.step, report.spectral_bound);
  EXPECT_NEAR(1e-3 / report.step, std::round(1e-3 / report.step), 1e-9);
  EXPECT_NEAR(report.paper_bound * report.omega0, 1.0, 1e-12);
  EXPECT_NE(report.explanation.find("rules"), std::string::npos);
  try {
    lattice::choose_step(model, &rod, Integrator::symplectic_euler, 1.01 * report.spectral_bound,
                         1e-3);
    FAIL() << "an unstable step was accepted";
  } catch (const meshes::InvalidInput& refusal) {
    EXPECT_EQ(refusal.violations().at(0).key, "run.time_step");
    EXPECT_FALSE(refusal.violations().at(0).remedy.empty());
  }
  EXPECT_THROW(lattice::choose_step(model, &rod, Integrator::symplectic_euler, -1.0, 1e-3),
               meshes::InvalidInput);
}
