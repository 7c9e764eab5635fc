#include "fem_reference/plane_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "fem_reference/growing_cholesky.h"
#include "meshes/errors.h"

using namespace fingertip;
using fem_reference::ContactUnknowns;
using fem_reference::GrowingCholesky;
using fem_reference::HeldSolution;
using fem_reference::PlaneContact;

namespace {

Eigen::MatrixXd random_positive_definite(int n, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd root =
      Eigen::MatrixXd::NullaryExpr(n, n, [&](auto, auto) { return normal(generator); });
  return root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
}

/// A body given by its compliance at the contact unknowns.
class DenseBody : public fem_reference::ContactSolver {
 public:
  explicit DenseBody(Eigen::MatrixXd compliance) : compliance_(std::move(compliance)) {}

  HeldSolution hold(const std::vector<char>& held, const Eigen::VectorXd& values) override {
    std::vector<int> indices;
    for (std::size_t i = 0; i < held.size(); ++i)
      if (held[i]) indices.push_back(int(i));
    HeldSolution solution;
    solution.reaction = Eigen::VectorXd::Zero(values.size());
    if (!indices.empty()) {
      const Eigen::MatrixXd block = compliance_(indices, indices);
      const Eigen::VectorXd wanted = values(indices);
      const Eigen::VectorXd forces = block.llt().solve(wanted);
      solution.reaction(indices) = forces;
    }
    solution.displacement = compliance_ * solution.reaction;
    return solution;
  }
  Eigen::VectorXd field() override { return {}; }
  double noise() const override { return 1e-10; }

 private:
  Eigen::MatrixXd compliance_;
};

/// Nodes at the given heights, with one unknown (z) or three.
ContactUnknowns nodes_at(const std::vector<double>& heights, bool lateral) {
  ContactUnknowns unknowns;
  for (const double height : heights) {
    fem_reference::SurfaceNode node;
    node.position = {0, 0, height};
    std::array<int, 3> positions{-1, -1, -1};
    for (std::size_t c = lateral ? 0 : 2; c < 3; ++c) {
      positions[c] = int(unknowns.unknowns.size());
      unknowns.unknowns.push_back(positions[c]);
    }
    unknowns.nodes.push_back(node);
    unknowns.of_node.push_back(positions);
  }
  return unknowns;
}

TEST(GrowingCholesky, FollowsAnyChangeOfTheIndexSet) {
  const int n = 90;
  const Eigen::MatrixXd matrix = random_positive_definite(n, 1);
  GrowingCholesky factor(matrix);
  std::mt19937 generator(2);
  std::vector<char> chosen(n, 0);
  for (int round = 0; round < 30; ++round) {
    for (int flips = 0; flips < 12; ++flips) {
      char& flag = chosen[generator() % n];
      flag = !flag;
    }
    factor.choose(chosen);
    const std::vector<int>& indices = factor.indices();
    EXPECT_EQ(std::ranges::count(chosen, 1), std::ptrdiff_t(indices.size()));
    for (const int i : indices) EXPECT_TRUE(chosen[std::size_t(i)]);
    const Eigen::VectorXd b = Eigen::VectorXd::Ones(Eigen::Index(indices.size()));
    const Eigen::MatrixXd block = matrix(indices, indices);
    EXPECT_LT((block * factor.solve(b) - b).norm(), 1e-9 * b.norm());
  }
}

TEST(GrowingCholesky, RefusesAnIndefiniteMatrix) {
  const Eigen::MatrixXd matrix = Eigen::Vector2d(1.0, -1.0).asDiagonal();
  GrowingCholesky factor(matrix);
  EXPECT_THROW(factor.choose({1, 1}), meshes::NotConverged);
}

/// Frictionless contact of a body whose stiffness is no M-matrix, against trying out all 2^n sets.
TEST(PlaneContact, FrictionlessFindsTheOnlyAdmissibleSet) {
  const int n = 9;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Eigen::MatrixXd compliance = random_positive_definite(n, seed);
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(0.5, 1.0);
    std::vector<double> heights(n);
    for (double& height : heights) height = uniform(generator);
    DenseBody body(compliance);
    PlaneContact contact(nodes_at(heights, false), 1.0, body);
    contact.advance(0.35);

    int admissible = 0;
    for (unsigned set = 0; set < (1u << n); ++set) {
      std::vector<char> held(n, 0);
      Eigen::VectorXd values(n);
      for (int i = 0; i < n; ++i) {
        held[std::size_t(i)] = char((set >> i) & 1u);
        values[i] = 0.65 - heights[std::size_t(i)];
      }
      const HeldSolution trial = body.hold(held, values);
      bool good = true;
      for (int i = 0; i < n; ++i)
        good = good &&
               (held[std::size_t(i)] ? trial.reaction[i] <= 0 : trial.displacement[i] <= values[i]);
      if (!good) continue;
      ++admissible;
      EXPECT_EQ(held, contact.active()) << "seed " << seed;
    }
    EXPECT_EQ(admissible, 1);
  }
}

/// Two springs of which the first also drags the second sideways: the anchor's place is known.
TEST(PlaneContact, StickAnchorsAtTheInterpolatedFirstTouch) {
  // Unknowns x1 y1 z1 x2 y2 z2. Pushing node 1 down by d moves node 2 by d/2 along x.
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Identity(6, 6);
  compliance(3, 2) = compliance(2, 3) = -0.5;
  DenseBody body(compliance);
  PlaneContact contact(nodes_at({1.0, 0.9}, true), 1.0, body);
  // One step to 0.25: in the trial state node 2 has moved by 0.5 * 0.25 and it touched at 0.1.
  contact.advance(0.25);
  // Held there, its lateral reaction pulls it back to 0.5 * 0.1.
  const double r1 = contact.reaction(0).z(), r2 = contact.reaction(1).x();
  EXPECT_NEAR(-0.5 * r1 + r2, 0.5 * 0.1, 1e-12);
  EXPECT_NEAR(r1 - 0.5 * r2, -0.25, 1e-12);
  EXPECT_EQ(contact.active_nodes(), 2);
  EXPECT_NEAR(contact.gap(1), 0.0, 1e-12);
}

TEST(PlaneContact, AnchorsDoNotDependOnTheSteps) {
  // With a body that answers linearly until touch, interpolation is exact whatever the step.
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Identity(6, 6);
  compliance(3, 2) = compliance(2, 3) = -0.5;
  DenseBody one(compliance), many(compliance);
  PlaneContact coarse(nodes_at({1.0, 0.9}, true), 1.0, one);
  PlaneContact fine(nodes_at({1.0, 0.9}, true), 1.0, many);
  coarse.advance(0.3);
  for (int i = 1; i <= 7; ++i) fine.advance(0.3 * i / 7.0);
  EXPECT_NEAR((coarse.reaction(0) - fine.reaction(0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((coarse.reaction(1) - fine.reaction(1)).norm(), 0.0, 1e-12);
}

TEST(PlaneContact, KeepsItsStateWhenTheSolverFails) {
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Identity(2, 2);
  class Failing : public DenseBody {
   public:
    using DenseBody::DenseBody;
    HeldSolution hold(const std::vector<char>& held, const Eigen::VectorXd& values) override {
      if (fail) throw meshes::NotConverged("as told");
      return DenseBody::hold(held, values);
    }
    bool fail = false;
  } body(compliance);
  PlaneContact contact(nodes_at({1.0, 0.9}, false), 1.0, body);
  contact.advance(0.05);
  const meshes::Vector3 before = contact.reaction(0);
  body.fail = true;
  EXPECT_THROW(contact.advance(0.2), meshes::NotConverged);
  EXPECT_EQ(contact.indentation(), 0.05);
  EXPECT_EQ(contact.reaction(0), before);
}

}  // namespace
