#include "lattice/dynamics/spectrum.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "lattice/dynamics/spectrum_search.h"
#include "lattice/dynamics/time_step.h"
#include "tests/lattice/fixtures.h"

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
  const auto identity = Eigen::Matrix3d::Identity();
  if (integrator == Integrator::explicit_euler) {
    step << identity, dt * identity, -dt * wave.stiffness, identity - dt * wave.damping;
  } else {
    step << identity - dt * dt * wave.stiffness, dt * (identity - dt * wave.damping),
        -dt * wave.stiffness, identity - dt * wave.damping;
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

TEST(SpectralBounds, LieAboveTheExactEigenvalueOfSprings) {
  for (const ModelKind kind : {ModelKind::published, ModelKind::central}) {
    const LatticeModel model = block(kind, Kinematics::small, {4, 3, 5});
    const lattice::State rest(model);
    const SpectralBounds bounds = lattice::spectral_bounds(model, nullptr);
    const double exact = largest_rate(model, tangent(model, rest));
    EXPECT_GE(bounds.stiffness, exact * (1.0 - 1e-9)) << name(kind);
    EXPECT_LT(bounds.stiffness, 2.5 * exact) << name(kind);
    const double exact_damping = largest_rate(model, tangent(model, rest, true));
    EXPECT_GE(bounds.damping, exact_damping * (1.0 - 1e-9)) << name(kind);
    EXPECT_LT(bounds.damping, 2.5 * exact_damping) << name(kind);
  }
}

TEST(SpectralEstimate, ConvergesToTheExactEigenvalueFromBelow) {
  for (const ModelKind kind : all_models) {
    for (const Kinematics kinematics : both_kinematics) {
      const LatticeModel model = block(kind, kinematics, {4, 3, 5});
      const lattice::State rest(model);
      const SpectralBounds estimate = lattice::spectral_estimate(model);
      const double exact = largest_rate(model, tangent(model, rest));
      const double exact_damping = largest_rate(model, tangent(model, rest, true));
      EXPECT_LE(estimate.stiffness, exact * (1.0 + 1e-6)) << label(kind, kinematics);
      EXPECT_GT(estimate.stiffness, 0.99 * exact) << label(kind, kinematics);
      EXPECT_LE(estimate.damping, exact_damping * (1.0 + 1e-6)) << label(kind, kinematics);
      EXPECT_GT(estimate.damping, 0.99 * exact_damping) << label(kind, kinematics);
    }
  }
}

TEST(SpectralEstimate, SeesAStatesOwnStiffnessAndDamping) {
  const LatticeModel model = block(ModelKind::network, Kinematics::finite, {4, 3, 3});
  lattice::State state = random_state(model, 0.05, 0.0, 4);
  Eigen::Matrix3d H = Eigen::Vector3d(0.1, 0.2, -0.45).asDiagonal();
  H(0, 2) = 0.3;
  for (const std::size_t i : model.particles) {
    state.displacement.add(i, H * model.rest_position(i));
  }
  const SpectralBounds estimate = lattice::spectral_estimate(model, state, 30);
  const double exact = largest_rate(model, tangent(model, state));
  const double exact_damping = largest_rate(model, tangent(model, state, true));
  EXPECT_GT(exact, 1.5 * largest_rate(model, tangent(model, lattice::State(model))));
  EXPECT_LE(estimate.stiffness, exact * (1.0 + 1e-5));
  EXPECT_GT(estimate.stiffness, 0.97 * exact);
  EXPECT_LE(estimate.damping, exact_damping * (1.0 + 1e-5));
  EXPECT_GT(estimate.damping, 0.97 * exact_damping);
}

TEST(SpectralEstimate, OfAHookeanCellIsItsBreathing) {
  const meshes::Rubber rubber;
  const double a = 1e-3;
  const LatticeModel model = lattice::build_block(ModelKind::hookean, Kinematics::small,
                                                  lattice::hookean_constants(rubber, a), a,
                                                  {1, 1, 1}, rubber.density, 0.0);
  const double breathing = 12.0 * rubber.bulk_modulus() / (rubber.density * a * a);
  EXPECT_NEAR(lattice::spectral_estimate(model).stiffness, breathing, 1e-6 * breathing);
}

TEST(SpectrumSearch, FollowsATipThatIsSqueezedHereAndThere) {
  // A squeeze that wanders through the tip: the uppermost mode changes its place.
  const auto model = fixtures::tip(fingertip::lattice::ModelKind::network,
                                   fingertip::lattice::Kinematics::finite, 6);
  fingertip::lattice::SpectrumSearch search(model);
  fingertip::lattice::SpectrumSearch::Memory memory;
  search.finish(memory);
  const auto rest = fingertip::lattice::spectral_estimate(model);
  EXPECT_NEAR(memory.found.stiffness, rest.stiffness, 0.01 * rest.stiffness);
  EXPECT_NEAR(memory.found.damping, rest.damping, 0.01 * rest.damping);
  for (int n = 0; n <= 10; ++n) {
    fingertip::lattice::State state(model);
    const fingertip::meshes::Vector3 centre(2e-3 * (n - 5), 1e-3, 5e-3);
    for (const std::size_t i : model.particles) {
      const fingertip::meshes::Vector3 arm = model.rest_position(i) - centre;
      state.displacement.set(i, -0.3 * std::exp(-arm.squaredNorm() / 9e-6) * arm);
    }
    const auto known = fingertip::lattice::spectral_estimate(model, state, 80);
    int portions = 0;
    for (search.begin(memory, state); memory.active; ++portions) search.advance(memory);
    EXPECT_LT(portions, 30);
    EXPECT_LT(memory.found.stiffness, 1.01 * known.stiffness) << n;
    EXPECT_GT(memory.found.stiffness, 0.95 * known.stiffness) << n;
    EXPECT_LT(memory.found.damping, 1.01 * known.damping) << n;
    EXPECT_GT(memory.found.damping, 0.95 * known.damping) << n;
  }
}
