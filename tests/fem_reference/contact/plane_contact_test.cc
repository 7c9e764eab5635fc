#include "fem_reference/contact/plane_contact.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "meshes/base/errors.h"

using namespace fingertip;
using fem_reference::ConstrainedSolution;
using fem_reference::ContactUnknowns;
using fem_reference::NodeStatus;
using fem_reference::PlaneContact;
using fem_reference::PlanePose;
using meshes::ContactMode;

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

  ConstrainedSolution solve_constrained(const std::vector<char>& held,
                                        const Eigen::VectorXd& values,
                                        const Eigen::VectorXd& loads) override {
    if (fail) throw meshes::NotConverged("as told");
    std::vector<int> indices;
    ConstrainedSolution solution;
    solution.reaction = loads;
    for (std::size_t i = 0; i < held.size(); ++i)
      if (held[i]) {
        indices.push_back(int(i));
        solution.reaction[Eigen::Index(i)] = 0.0;
      }
    if (!indices.empty()) {
      const Eigen::MatrixXd block = compliance_(indices, indices);
      const Eigen::VectorXd free = compliance_ * solution.reaction;
      const Eigen::VectorXd missing = values(indices) - free(indices);
      solution.reaction(indices) = block.llt().solve(missing).eval();
    }
    solution.displacement = compliance_ * solution.reaction;
    return solution;
  }
  double noise() const override { return 1e-10; }

  bool fail = false;

 private:
  Eigen::MatrixXd compliance_;
};

/// Nodes at the given heights, with one unknown (z) or three, of unit area.
ContactUnknowns nodes_at(const std::vector<double>& heights, bool lateral) {
  ContactUnknowns unknowns;
  for (const double height : heights) {
    fem_reference::SurfaceNode node;
    node.position = {0, 0, height};
    node.area = node.extent = 1.0;
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

constexpr PlanePose start{1.0, 0.0};

/// Settles under the plane `indentation` below its start, moved by `shift`, and makes it the state.
void press(PlaneContact& contact, DenseBody& body, double indentation, double shift = 0.0) {
  contact.solve(body, {1.0 - indentation, shift});
  contact.commit();
}

PlaneContact frictionless(ContactUnknowns unknowns) {
  return {std::move(unknowns), ContactMode::frictionless, start, 0.0, 1.0};
}

PlaneContact sticking(ContactUnknowns unknowns) {
  return {std::move(unknowns), ContactMode::stick, start, 0.0, 1.0};
}

TEST(ContactUnknowns, TakesNodesAboveTheLowestAndWhatIsFree) {
  std::vector<fem_reference::SurfaceNode> nodes(3);
  for (std::size_t i = 0; i < 3; ++i) {
    nodes[i].position = {0.1 * double(i), 0, 1.0 - 0.2 * double(i)};
    nodes[i].unknown = {long(10 * i), long(10 * i + 1), long(10 * i + 2)};
    nodes[i].free = {i != 0, true, true};
  }
  const ContactUnknowns normal = contact_unknowns(within_reach(nodes, {}, 0.9, 0.2), false);
  EXPECT_EQ(normal.unknowns, (std::vector<long>{2, 12}));
  EXPECT_EQ(normal.of_node[1], (std::array{-1, -1, 1}));
  const ContactUnknowns all = contact_unknowns(within_reach(nodes, {}, 0.9, 0.2), true);
  EXPECT_EQ(all.unknowns, (std::vector<long>{1, 2, 10, 11, 12}));
  EXPECT_EQ(all.of_node[0], (std::array{-1, 0, 1}));
  EXPECT_EQ(all.nodes.size(), 2u);
}

/// Frictionless contact of a body whose stiffness is no M-matrix, against trying out all 2^n sets.
TEST(PlaneContact, FrictionlessFindsTheOnlyAdmissibleSet) {
  const int n = 9;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(0.5, 1.0);
    std::vector<double> heights(n);
    for (double& height : heights) height = uniform(generator);
    DenseBody body(random_positive_definite(n, seed));
    PlaneContact contact = frictionless(nodes_at(heights, false));
    press(contact, body, 0.35);

    int admissible = 0;
    for (unsigned set = 0; set < (1u << n); ++set) {
      std::vector<char> held(n, 0);
      Eigen::VectorXd values(n);
      for (int i = 0; i < n; ++i) {
        held[std::size_t(i)] = char((set >> i) & 1u);
        values[i] = 0.65 - heights[std::size_t(i)];
      }
      const ConstrainedSolution trial =
          body.solve_constrained(held, values, Eigen::VectorXd::Zero(n));
      bool good = true;
      for (int i = 0; i < n; ++i)
        good = good &&
               (held[std::size_t(i)] ? trial.reaction[i] <= 0 : trial.displacement[i] <= values[i]);
      if (!good) continue;
      ++admissible;
      EXPECT_EQ(held, contact.held()) << "seed " << seed;
      EXPECT_EQ(contact.active_nodes(), std::ranges::count(held, 1));
    }
    EXPECT_EQ(admissible, 1);
  }
}

/// Two springs of which the first also drags the second sideways: the anchor's place is known.
Eigen::MatrixXd dragging_springs() {
  // Unknowns x1 y1 z1 x2 y2 z2. Pushing node 1 down by d moves node 2 by d/2 along x.
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Identity(6, 6);
  compliance(3, 2) = compliance(2, 3) = -0.5;
  return compliance;
}

TEST(PlaneContact, StickAnchorsAtTheInterpolatedFirstTouch) {
  DenseBody body(dragging_springs());
  PlaneContact contact = sticking(nodes_at({1.0, 0.9}, true));
  // One step to 0.25: in the trial state node 2 has moved by 0.5 * 0.25 and it touched at 0.1.
  press(contact, body, 0.25);
  // Held there, its lateral reaction pulls it back to 0.5 * 0.1.
  const double r1 = contact.reaction(0).z(), r2 = contact.reaction(1).x();
  EXPECT_NEAR(-0.5 * r1 + r2, 0.5 * 0.1, 1e-12);
  EXPECT_NEAR(r1 - 0.5 * r2, -0.25, 1e-12);
  EXPECT_EQ(contact.active_nodes(), 2);
  EXPECT_NEAR(contact.gap(1), 0.0, 1e-12);
}

TEST(PlaneContact, AnchorsDoNotDependOnTheSteps) {
  // With a body that answers linearly until touch, interpolation is exact whatever the step.
  DenseBody body(dragging_springs());
  PlaneContact coarse = sticking(nodes_at({1.0, 0.9}, true));
  PlaneContact fine = sticking(nodes_at({1.0, 0.9}, true));
  press(coarse, body, 0.3, 0.06);
  for (int i = 1; i <= 7; ++i) press(fine, body, 0.3 * i / 7.0, 0.06 * i / 7.0);
  EXPECT_NEAR((coarse.reaction(0) - fine.reaction(0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((coarse.reaction(1) - fine.reaction(1)).norm(), 0.0, 1e-12);
}

/// The way there bends by 0.03 at half time: at 0.4, where node 2 touches, by 0.024.
TEST(PlaneContact, AForeknownWayAnchorsWhereItTouchesFirst) {
  DenseBody body(dragging_springs());
  PlaneContact contact = sticking(nodes_at({1.0, 0.9}, true));
  const Eigen::VectorXd end = Eigen::VectorXd{{0.0, 0.0, -0.25, 0.125, 0.0, 0.0}},
                        bend = Eigen::VectorXd{{0.0, 0.0, 0.0, 0.03, 0.0, 0.0}};
  contact.foresee({end, {0.5}, {bend}}, {start.height - 0.25, 0.0});
  EXPECT_EQ(contact.active_nodes(), 2);
  press(contact, body, 0.25);
  const double r1 = contact.reaction(0).z(), r2 = contact.reaction(1).x();
  EXPECT_NEAR(-0.5 * r1 + r2, 0.5 * 0.1 + 0.024, 1e-12);
  // What is foreknown serves one step.
  press(contact, body, 0.3);
  EXPECT_NEAR(-0.5 * contact.reaction(0).z() + contact.reaction(1).x(), 0.5 * 0.1 + 0.024, 1e-12);
}

/// Where the way bends into the plane and out again, the first of both counts.
TEST(PlaneContact, AForeknownWayMayTouchBetween) {
  DenseBody body(dragging_springs());
  PlaneContact contact = sticking(nodes_at({1.0, 0.9}, true));
  const Eigen::VectorXd end = Eigen::VectorXd{{0.0, 0.0, -0.25, 0.125, 0.0, 0.0}},
                        bend = Eigen::VectorXd{{0.0, 0.0, 0.0, 0.0, 0.0, 0.1}};
  contact.foresee({end, {0.4}, {bend}}, {start.height - 0.25, 0.0});
  press(contact, body, 0.25);
  // It rises by 0.1 until 0.4, the plane falls by 0.1: they meet half way.
  EXPECT_NEAR(-0.5 * contact.reaction(0).z() + contact.reaction(1).x(), 0.5 * 0.05, 1e-12);
}

TEST(PlaneContact, WhatIsForeseenInVainLeavesNoTrace) {
  DenseBody body(dragging_springs());
  const auto pressed = [&](const Eigen::VectorXd& end, bool abandoned) {
    PlaneContact contact = sticking(nodes_at({1.0, 0.9}, true));
    contact.foresee({end, {}, {}}, {start.height - 0.05, 0.0});
    if (abandoned) contact.abandon();
    EXPECT_EQ(contact.active_nodes(), abandoned ? 0 : 2);
    press(contact, body, 0.05);
    EXPECT_EQ(contact.active_nodes(), 1);
    return contact.reaction(0);
  };
  const Eigen::VectorXd wrong = Eigen::VectorXd{{0.0, 0.0, -0.05, 0.0, 0.0, 0.2}};
  const meshes::Vector3 expected = pressed(wrong, true);
  EXPECT_GT(expected.norm(), 0.0);
  EXPECT_NEAR((pressed(wrong, false) - expected).norm(), 0.0, 1e-12);
}

TEST(PlaneContact, AnchorsMoveWithThePlane) {
  DenseBody body(Eigen::Vector3d(2.0, 3.0, 4.0).asDiagonal());
  PlaneContact contact = sticking(nodes_at({1.0}, true));
  press(contact, body, 0.1);
  press(contact, body, 0.1, 0.05);
  EXPECT_NEAR(contact.reaction(0).x(), 0.05 / 2.0, 1e-14);
  EXPECT_NEAR(contact.reaction(0).y(), 0.0, 1e-14);
  EXPECT_NEAR(contact.reaction(0).z(), -0.1 / 4.0, 1e-14);
}

/// At small strain a ball of radius 2 lowers the gap by 2 - sqrt(4 - r²), r from where it is.
TEST(PlaneContact, AnObstacleMovesWithThePlane) {
  const meshes::Obstacle ball{.shape = meshes::ObstacleShape::sphere, .radius = 2.0};
  const PlaneContact contact(nodes_at({1.0}, true), ContactMode::frictionless, start, 0.0, 1.0,
                             ball);
  for (const double shift : {-0.4, 0.0, 0.7}) {
    const double r = std::hypot(0.5 - shift, 0.3);
    EXPECT_NEAR(contact.gap({0.5, 0.3, 0.8}, meshes::Vector3::Zero(), {1.0, shift}),
                0.2 + 2.0 - std::sqrt(4.0 - r * r), 1e-14)
        << shift;
  }
}

/// A push, never a pull: drawn back, the plane lets go and the body is at rest again.
TEST(PlaneContact, LetsGoWhenPulled) {
  for (const ContactMode mode :
       {ContactMode::frictionless, ContactMode::stick, ContactMode::coulomb}) {
    DenseBody body(dragging_springs());
    PlaneContact contact(nodes_at({1.0, 0.9}, true), mode, start, 0.5, 0.2);
    press(contact, body, 0.2);
    EXPECT_EQ(contact.active_nodes(), 2);
    press(contact, body, -0.1);
    EXPECT_EQ(contact.active_nodes(), 0);
    EXPECT_NEAR(contact.gap(0), 0.1, 1e-12);
    EXPECT_EQ(contact.reactions().norm(), 0.0);
  }
}

/// A pole has no area. Its reaction pulls here, and it stays with its neighbour all the same; alone
/// it comes on when it penetrates, and goes when both are let go.
TEST(PlaneContact, NodeWithoutAreaFollowsItsNeighbour) {
  Eigen::MatrixXd compliance = Eigen::MatrixXd::Identity(2, 2);
  compliance(0, 1) = compliance(1, 0) = 0.9;  // the neighbour presses the pole down with itself
  DenseBody body(compliance);
  ContactUnknowns unknowns = nodes_at({0.88, 1.0}, false);
  unknowns.nodes[0].area = 0.0;
  PlaneContact contact = frictionless(unknowns);
  press(contact, body, 0.2);
  EXPECT_EQ(contact.active_nodes(), 2);
  EXPECT_GT(contact.reaction(0).z(), 0.0);
  EXPECT_NEAR(contact.gap(0), 0.0, 1e-12);
  EXPECT_EQ(contact.leader(0), 1u);
  EXPECT_EQ(contact.leader(1), 1u);
  press(contact, body, -0.1);
  EXPECT_EQ(contact.active_nodes(), 0);

  unknowns.nodes[0].position.z() = 1.0;
  unknowns.nodes[1].position.z() = 0.5;
  PlaneContact alone = frictionless(unknowns);
  press(alone, body, 0.2);
  EXPECT_EQ(alone.active_nodes(), 1);
  EXPECT_NEAR(alone.reaction(0).z(), -0.2, 1e-12);
}

TEST(PlaneContact, AbandonedTrialsLeaveNoTrace) {
  DenseBody body(dragging_springs());
  PlaneContact contact = sticking(nodes_at({1.0, 0.9}, true));
  press(contact, body, 0.05);
  const meshes::Vector3 before = contact.reaction(0);
  contact.solve(body, {0.7, 0.1});
  EXPECT_EQ(contact.active_nodes(), 2);
  contact.abandon();
  EXPECT_EQ(contact.reaction(0), before);
  EXPECT_EQ(contact.active_nodes(), 1);

  body.fail = true;
  EXPECT_THROW(contact.solve(body, {0.7, 0.1}), meshes::NotConverged);
  contact.abandon();
  EXPECT_EQ(contact.reaction(0), before);
  EXPECT_EQ(contact.committed().pose.height, 0.95);

  // As if nothing had happened.
  body.fail = false;
  press(contact, body, 0.25);
  PlaneContact straight = sticking(nodes_at({1.0, 0.9}, true));
  press(straight, body, 0.05);
  press(straight, body, 0.25);
  EXPECT_EQ(contact.reactions(), straight.reactions());
}

TEST(PlaneContact, GoesOnFromARestoredState) {
  for (const ContactMode mode : {ContactMode::stick, ContactMode::coulomb}) {
    DenseBody body(dragging_springs());
    const ContactUnknowns unknowns = nodes_at({1.0, 0.9}, true);
    PlaneContact pressed(unknowns, mode, start, 0.2, 0.2),
        restored(unknowns, mode, start, 0.2, 0.2);
    press(pressed, body, 0.2, 0.02);
    restored.restore(pressed.committed());
    EXPECT_EQ(restored.reactions(), pressed.reactions());
    press(pressed, body, 0.3, 0.2);
    press(restored, body, 0.3, 0.2);
    EXPECT_EQ(restored.reactions(), pressed.reactions());
    EXPECT_EQ(restored.status(), pressed.status());
  }
}

/// A block on three springs, pressed with N = 0.25 and dragged along x: sticks under t = s/2 until
/// t = mu N = 0.1, slides under that, and sticks again when the plane turns back.
TEST(Coulomb, OneNodeSticksSlidesAndSticksAgain) {
  const double mu = 0.4, compliance = 2.0, push = 0.25, limit = mu * push;
  DenseBody body(Eigen::Vector3d(compliance, compliance, 0.4).asDiagonal());
  PlaneContact contact(nodes_at({1.0}, true), ContactMode::coulomb, start, mu, 0.3);
  press(contact, body, 0.1);
  const auto expect = [&](double shift, double force, NodeStatus status) {
    SCOPED_TRACE(shift);
    press(contact, body, 0.1, shift);
    EXPECT_NEAR(contact.reaction(0).z(), -push, 1e-12);
    EXPECT_NEAR(contact.reaction(0).x(), force, 1e-9);
    EXPECT_NEAR(contact.reaction(0).y(), 0.0, 1e-12);
    EXPECT_EQ(contact.status()[0], status);
  };
  expect(0.1, 0.1 / compliance, NodeStatus::stick);
  expect(0.19, 0.19 / compliance, NodeStatus::stick);
  expect(0.21, limit, NodeStatus::slide);
  expect(0.5, limit, NodeStatus::slide);
  // Turning back by 0.1 takes 0.1/2 off; by 0.4 = 2 limit * compliance slides the other way.
  expect(0.4, limit - 0.1 / compliance, NodeStatus::stick);
  expect(0.11, limit - 0.39 / compliance, NodeStatus::stick);
  expect(0.0, -limit, NodeStatus::slide);
}

/// At Coulomb's limit a node stays what it is: under a plane that waits one that slides goes on
/// sliding.
TEST(Coulomb, AtTheLimitANodeStaysWhatItIs) {
  DenseBody body(Eigen::Vector3d(2.0, 2.0, 0.4).asDiagonal());
  PlaneContact contact(nodes_at({1.0}, true), ContactMode::coulomb, start, 0.4, 0.3);
  press(contact, body, 0.1, 0.5);
  const Eigen::VectorXd before = contact.reactions();
  for (int wait = 0; wait < 3; ++wait) {
    press(contact, body, 0.1, 0.5);
    EXPECT_EQ(contact.status()[0], NodeStatus::slide);
    EXPECT_TRUE(contact.reactions().isApprox(before, 1e-12));
  }
}

/// Friction follows the push at once, in the same step.
TEST(Coulomb, SlidingForceFollowsThePush) {
  DenseBody body(Eigen::Vector3d(2.0, 2.0, 0.4).asDiagonal());
  PlaneContact contact(nodes_at({1.0}, true), ContactMode::coulomb, start, 0.4, 0.3);
  press(contact, body, 0.1, 1.0);
  EXPECT_NEAR(contact.reaction(0).x(), 0.4 * 0.1 / 0.4, 1e-9);
  press(contact, body, 0.2, 2.0);
  EXPECT_NEAR(contact.reaction(0).x(), 0.4 * 0.2 / 0.4, 1e-9);
  press(contact, body, 0.05, 3.0);
  EXPECT_NEAR(contact.reaction(0).x(), 0.4 * 0.05 / 0.4, 1e-9);
}

/// Springs that answer a force along x along y, too: friction opposes the slip, not the shift.
TEST(Coulomb, ForceOpposesTheSlip) {
  Eigen::Matrix3d compliance;
  compliance << 2.0, 1.2, 0, 1.2, 2.0, 0, 0, 0, 0.4;
  const double mu = 0.4, limit = mu * 0.25;
  DenseBody body(compliance);
  PlaneContact contact(nodes_at({1.0}, true), ContactMode::coulomb, start, mu, 0.3);
  press(contact, body, 0.1);
  press(contact, body, 0.1, 0.3);
  ASSERT_EQ(contact.status()[0], NodeStatus::slide);
  const Eigen::Vector2d force = contact.reaction(0).head<2>();
  const Eigen::Vector2d slip = compliance.topLeftCorner<2, 2>() * force - Eigen::Vector2d(0.3, 0.0);
  EXPECT_NEAR(force.norm(), limit, 1e-9);
  EXPECT_NEAR((force + limit * slip.normalized()).norm(), 0.0, 1e-7);
  EXPECT_LT(force.y(), -0.05 * limit);
}

/// Six nodes on random springs, scaled so that the fixed point is reached.
struct Crowd {
  static constexpr int nodes = 6;
  Eigen::MatrixXd compliance;
  DenseBody body;
  ContactUnknowns unknowns;
  double stiffness;

  explicit Crowd(unsigned seed)
      : compliance(springs(seed)),
        body(compliance),
        unknowns(nodes_at({1.0, 0.97, 0.99, 0.93, 0.9, 0.95}, true)),
        stiffness(1.0 / compliance.norm()) {}

  /// Stiff against tangential forces among themselves, as neighbours in rubber are.
  static Eigen::MatrixXd springs(unsigned seed) {
    return random_positive_definite(3 * nodes, seed) / 40.0 +
           Eigen::MatrixXd::Identity(3 * nodes, 3 * nodes);
  }

  PlaneContact contact(ContactMode mode, double friction) const {
    return {unknowns, mode, start, friction, stiffness};
  }
};

/// The law at every node: within the cone; no slip where it sticks; against the slip where it
/// slides, of nodes that touched before the step already.
void expect_law(const PlaneContact& contact, const PlaneContact::State& before, double mu) {
  const PlaneContact::State& after = contact.committed();
  const double shift = after.pose.shift - before.pose.shift;
  for (std::size_t i = 0; i < after.status.size(); ++i) {
    const meshes::Vector3 r = contact.reaction(i);
    const double limit = mu * std::max(0.0, -r.z());
    if (after.status[i] == NodeStatus::open) {
      EXPECT_EQ(r.norm(), 0.0);
      EXPECT_GE(contact.gap(i), -1e-10);
      continue;
    }
    EXPECT_LE(r.z(), 1e-9);
    EXPECT_NEAR(contact.gap(i), 0.0, 1e-12);
    EXPECT_LE(r.head<2>().norm(), limit * (1 + 1e-6) + 1e-9);
    if (before.status[i] == NodeStatus::open) continue;
    const auto& of = contact.unknowns().of_node[i];
    const Eigen::Vector2d slip(after.displacement[of[0]] - before.displacement[of[0]] - shift,
                               after.displacement[of[1]] - before.displacement[of[1]]);
    if (after.status[i] == NodeStatus::stick) {
      EXPECT_NEAR(slip.norm(), 0.0, 1e-12);
    } else {
      EXPECT_NEAR((r.head<2>() * slip.norm() + limit * slip).norm(), 0.0, 1e-6 * slip.norm());
    }
  }
}

TEST(Coulomb, LawHoldsAtEveryNodeAlongAnyPath) {
  int sliding = 0, sticking_nodes = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Crowd crowd(seed);
    const double mu = 0.3;
    PlaneContact contact = crowd.contact(ContactMode::coulomb, mu);
    const double path[][2] = {{0.05, 0.0}, {0.15, 0.0}, {0.2, 0.03},
                              {0.2, 0.1},  {0.2, 0.05}, {0.1, 0.0}};
    for (const auto& [indentation, shift] : path) {
      const PlaneContact::State before = contact.committed();
      press(contact, crowd.body, indentation, shift);
      expect_law(contact, before, mu);
      sliding += int(std::ranges::count(contact.status(), NodeStatus::slide));
      sticking_nodes += int(std::ranges::count(contact.status(), NodeStatus::stick));
    }
  }
  EXPECT_GT(sliding, 100);
  EXPECT_GT(sticking_nodes, 100);
}

TEST(Coulomb, LiesBetweenFrictionlessAndStick) {
  Crowd crowd(3);
  const auto reactions = [&](ContactMode mode, double friction) {
    PlaneContact contact = crowd.contact(mode, friction);
    for (const double indentation : {0.05, 0.1, 0.15, 0.2})
      press(contact, crowd.body, indentation, 0.2 * indentation);
    return contact.reactions();
  };
  const Eigen::VectorXd none = reactions(ContactMode::frictionless, 0.0),
                        stuck = reactions(ContactMode::stick, 0.0);
  EXPECT_GT((none - stuck).norm(), 0.05 * stuck.norm());
  EXPECT_LT((reactions(ContactMode::coulomb, 1e6) - stuck).norm(), 1e-9 * stuck.norm());
  const double small = (reactions(ContactMode::coulomb, 1e-3) - none).norm() / none.norm();
  const double smaller = (reactions(ContactMode::coulomb, 1e-5) - none).norm() / none.norm();
  EXPECT_LT(small, 1e-2);
  EXPECT_NEAR(smaller / small, 1e-2, 1e-3);  // linear in mu
}

/// Dragged far, all nodes slide along x: the plane pulls with exactly mu times the push.
TEST(Coulomb, GrossSlidingPullsWithFrictionTimesPush) {
  const double mu = 0.35;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Crowd crowd(seed);
    PlaneContact contact = crowd.contact(ContactMode::coulomb, mu);
    press(contact, crowd.body, 0.2);
    const auto resultant = [&] {
      meshes::Vector3 sum = meshes::Vector3::Zero();
      for (std::size_t i = 0; i < Crowd::nodes; ++i) sum += contact.reaction(i);
      return sum;
    };
    for (int step = 1; step <= 12; ++step) {
      press(contact, crowd.body, 0.2, 0.5 * step);
      EXPECT_LE(resultant().head<2>().norm(), mu * -resultant().z() * (1 + 1e-8));
    }
    EXPECT_EQ(std::ranges::count(contact.status(), NodeStatus::slide), contact.active_nodes());
    EXPECT_NEAR(resultant().x() / (mu * -resultant().z()), 1.0, 1e-6);
    EXPECT_NEAR(resultant().y(), 0.0, 1e-6);
  }
}

}  // namespace
