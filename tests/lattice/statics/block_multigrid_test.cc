#include "lattice/statics/block_multigrid.h"

#include <gtest/gtest.h>

#include <random>

#include "lattice/statics/cut_lattice.h"
#include "tests/lattice/presses.h"

using namespace fingertip;
using Eigen::VectorXd;
using lattice::BlockMultigrid;
using lattice::ElasticSystem;
using lattice::LatticeBody;
using lattice::ModelKind;
using lattice::Tangent;

namespace {

/// A tip and its tangent at rest, with 1 on the diagonal of what is fixed.
struct Tip {
  explicit Tip(const lattice::PressSetup& setup, int sectors)
      : body(build_cut_tip(setup.geometry, setup.rubber, setup.lattice, sectors)),
        system(body),
        tangent(system.empty_tangent()) {
    VectorXd force;
    system.assemble(VectorXd::Zero(body.unknowns()), force, &tangent);
    const auto fixed = [this](Eigen::Index i) { return body.fixed[std::size_t(i)] != 0; };
    for (Eigen::Index column = 0; column < tangent.outerSize(); ++column)
      for (Tangent::InnerIterator entry(tangent, column); entry; ++entry)
        if (fixed(entry.row()) || fixed(column)) entry.valueRef() = entry.row() == column;
  }
  VectorXd random_force(unsigned seed) const {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    return VectorXd::NullaryExpr(body.unknowns(), [&](Eigen::Index i) {
      return body.fixed[std::size_t(i)] != 0 ? 0.0 : uniform(generator);
    });
  }

  LatticeBody body;
  const ElasticSystem system;
  Tangent tangent;
};

lattice::PressSetup setup_of(ModelKind model, double per_radius, double poissons_ratio = 0.4286) {
  lattice::PressSetup setup = presses::setup_of({.model = model, .per_radius = per_radius});
  setup.rubber.youngs_modulus = 2.0 * setup.rubber.shear_modulus * (1.0 + poissons_ratio);
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  return setup;
}

/// Of conjugate gradients to 1e-8 of the force.
int iterations(const Tip& tip) {
  BlockMultigrid multigrid(tip.system);
  EXPECT_TRUE(multigrid.set(tip.tangent, 0.0));
  const VectorXd force = tip.random_force(3);
  VectorXd residual = force, z = multigrid.solve(residual), direction = z;
  double slope = residual.dot(z);
  for (int i = 1; i < 1000; ++i) {
    const VectorXd product = tip.tangent.selfadjointView<Eigen::Lower>() * direction;
    residual -= slope / direction.dot(product) * product;
    if (residual.norm() < 1e-8 * force.norm()) return i;
    z = multigrid.solve(residual);
    const double next = residual.dot(z);
    direction = z + next / slope * direction;
    slope = next;
  }
  return 1000;
}

}  // namespace

TEST(BlockMultigrid, IsSymmetricAndPositive) {
  for (const int sectors : {1, 2, 4}) {
    const Tip tip(setup_of(ModelKind::hookean, 7.0), sectors);
    BlockMultigrid multigrid(tip.system);
    ASSERT_TRUE(multigrid.set(tip.tangent, 0.0));
    const VectorXd a = tip.random_force(1), b = tip.random_force(2);
    const VectorXd to_a = multigrid.solve(a), to_b = multigrid.solve(b);
    EXPECT_GT(a.dot(to_a), 0.0);
    EXPECT_NEAR(a.dot(to_b), b.dot(to_a), 1e-4 * a.dot(to_a)) << sectors;
    for (std::size_t i = 0; i < tip.body.fixed.size(); ++i)
      if (tip.body.fixed[i] != 0) {
        ASSERT_EQ(to_a[Eigen::Index(i)], 0.0) << i;
      }
  }
}

TEST(BlockMultigrid, NeedsNoMoreIterationsOnFinerGrids) {
  for (const ModelKind model : {ModelKind::central, ModelKind::hookean, ModelKind::network})
    for (const double per_radius : {5.0, 9.0, 16.0})
      EXPECT_LE(iterations(Tip(setup_of(model, per_radius), 4)), 35) << name(model) << per_radius;
  EXPECT_LE(iterations(Tip(setup_of(ModelKind::hookean, 9.0), 1)), 40);
}

TEST(BlockMultigrid, ServesNearlyIncompressibleRubber) {
  for (const double per_radius : {6.0, 12.0})
    EXPECT_LE(iterations(Tip(setup_of(ModelKind::hookean, per_radius, 0.49), 4)), 70) << per_radius;
}

TEST(BlockMultigrid, IsTheInverseWhereParticlesLieOnNoGrid) {
  Tip tip(setup_of(ModelKind::hookean, 5.0), 4);
  tip.body.places.clear();
  BlockMultigrid multigrid(tip.system);
  ASSERT_TRUE(multigrid.set(tip.tangent, 0.5));
  const VectorXd force = tip.random_force(5), u = multigrid.solve(force);
  const VectorXd back = tip.tangent.selfadjointView<Eigen::Lower>() * u + 0.5 * u;
  EXPECT_LT((back - force).norm(), 1e-11 * force.norm());
}

TEST(BlockMultigrid, TellsWhatIsNotPositiveDefinite) {
  Tip tip(setup_of(ModelKind::hookean, 6.0), 4);
  BlockMultigrid multigrid(tip.system);
  const double typical = tip.tangent.diagonal().mean();
  EXPECT_FALSE(multigrid.set(tip.tangent, -10.0 * typical));
  EXPECT_TRUE(multigrid.set(tip.tangent, 0.0));
}
