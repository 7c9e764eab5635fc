// Every kernel of the spring engine against the scalar reference, and the reference against the
// closed solution of two masses.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "spring_scenes.h"
#include "tests/benchmarks/springs/engine/reference_springs.h"
#include "tests/benchmarks/springs/engine/spring_lattice.h"

using namespace fingertip;
using namespace scenes;
using lattice::springs::EngineOptions;
using lattice::springs::Precision;
using lattice::springs::ReferenceSprings;
using lattice::springs::SpringLattice;

namespace {

struct Body {
  std::string name;
  SpringProblem problem;
};

std::vector<Body> bodies() {
  std::vector<Body> all{{"cube", box(16, 16, 16)},
                        {"odd box", box(11, 7, 5)},
                        {"ball", ball(13)},
                        {"fingertip", fingertip_body(6)},
                        {"sponge", sponge(21, 10, 9, 0.6, 7)},
                        {"loose masses", sponge(19, 8, 7, 0.1, 8)},
                        {"row along x", box(37, 1, 1)},
                        {"row along y", box(1, 17, 1)},
                        {"row along z", box(1, 1, 23)},
                        {"plate", box(18, 1, 19)},
                        {"one mass", box(1, 1, 1)},
                        {"two masses", box(1, 2, 1)},
                        {"long box", box(67, 3, 4)},
                        {"no masses", sponge(5, 5, 5, 0.0, 1)}};
  for (int nx = 2; nx <= 10; ++nx) all.push_back({"box " + std::to_string(nx), box(nx, 3, 3)});
  return all;
}

double relative(const Eigen::Matrix3Xd& values, const Eigen::Matrix3Xd& truth) {
  return largest(values - truth) / std::max(1e-300, largest(truth));
}

/// Largest error of velocities and positions after some steps, relative to the largest of each.
double error_after(int steps, const SpringProblem& problem, const EngineOptions& options) {
  ReferenceSprings reference(problem);
  SpringLattice lattice(problem, options);
  const Motion start = shaken(problem, 3);
  reference.set_motion(start.positions, start.velocities);
  lattice.set_motion(start.positions, start.velocities);
  reference.run(steps);
  lattice.run(steps);
  EXPECT_EQ(lattice.springs(), reference.springs());
  return std::max(relative(lattice.velocities(), reference.velocities()),
                  relative(lattice.positions(), reference.positions()));
}

/// Undamped, damped in one class only, damped in all.
std::vector<std::array<double, 3>> dampings() {
  return {{0.0, 0.0, 0.0}, {0.0, 0.006, 0.0}, {0.010, 0.006, 0.003}};
}

}  // namespace

TEST(SpringKernels, EqualTheReferenceInDoublePrecision) {
  for (Body& body : bodies()) {
    for (const auto& damping : dampings()) {
      body.problem.damping = damping;
      for (const int width : widths())
        EXPECT_LT(error_after(1, body.problem, {Precision::float64, width, 1}), 1e-14)
            << body.name << ", " << width << " lanes, mu1 = " << damping[0];
    }
  }
}

// A position of some 10 to 70 spacings has 24 bits, so a spring of length a has four to six fewer.
TEST(SpringKernels, EqualTheReferenceInSinglePrecision) {
  for (Body& body : bodies()) {
    for (const auto& damping : dampings()) {
      body.problem.damping = damping;
      for (const int width : widths())
        EXPECT_LT(error_after(1, body.problem, {Precision::float32, width, 1}), 3e-5)
            << body.name << ", " << 2 * width << " lanes, mu1 = " << damping[0];
    }
  }
}

TEST(SpringKernels, StayWithTheReferenceForManySteps) {
  for (const int width : widths()) {
    EXPECT_LT(error_after(200, fingertip_body(6), {Precision::float64, width, 1}), 1e-12);
    EXPECT_LT(error_after(200, fingertip_body(6), {Precision::float32, width, 1}), 2e-4);
  }
}

// u'' = -(2 k/m) u - (2 mu/m) u' for the stretch u of one spring between two masses; one step of
// symplectic Euler multiplies eigenvectors by z with z² + z (dt² lambda + dt c - 2) + 1 - dt c = 0.
TEST(SpringReference, TwoMassesOscillateAsTheClosedSolution) {
  SpringProblem problem = floating(box(2, 1, 1));
  const double dt = problem.step, amplitude = 0.1 * problem.spacing;
  const double lambda = 2.0 * problem.stiffness[0] / problem.mass;
  const double c = 2.0 * problem.damping[0] / problem.mass;
  const double half = 1.0 - 0.5 * (dt * dt * lambda + dt * c);
  const std::complex<double> root = std::sqrt(std::complex<double>(half * half - 1.0 + dt * c));
  const std::complex<double> z1 = half + root, z2 = half - root;
  const double first = amplitude * (1.0 - dt * dt * lambda);  // after one step from rest
  const std::complex<double> a = (first - amplitude * z2) / (z1 - z2);

  ReferenceSprings reference(problem);
  Eigen::Matrix3Xd start = reference.positions();
  start(0, 1) += amplitude;
  reference.set_motion(start, Eigen::Matrix3Xd::Zero(3, 2));
  for (int n = 1; n <= 300; ++n) {
    reference.run(1);
    const Eigen::Vector3d d = reference.positions().col(1) - reference.positions().col(0);
    const double expected = (a * std::pow(z1, n) + (amplitude - a) * std::pow(z2, n)).real();
    EXPECT_NEAR(d.x() - problem.spacing, expected, 1e-11 * amplitude) << "step " << n;
    EXPECT_EQ(d.tail<2>().norm(), 0.0);
  }
}

// A mass at rest on the plane sinks in by m g/k_p; one that flies away is not held by the damper.
TEST(SpringReference, PlaneCarriesAndDoesNotPull) {
  SpringProblem problem = box(1, 1, 1);
  problem.gravity = -9.81 * problem.plane.normal;
  problem.plane.height = 0.0;
  const double depth = problem.mass * 9.81 / problem.plane.stiffness;
  ReferenceSprings reference(problem);
  const Eigen::Matrix3Xd start = -depth * problem.plane.normal;
  reference.set_motion(start, Eigen::Matrix3Xd::Zero(3, 1));
  reference.run(100);
  EXPECT_LT(largest(reference.positions() - start), 1e-12 * depth);

  const Eigen::Matrix3Xd away = problem.plane.normal;
  reference.set_motion(start, away);
  reference.run(1);
  const double slower = 1.0 - problem.plane.normal.dot(reference.velocities().col(0));
  EXPECT_NEAR(slower, 9.81 * problem.step, 1e-12);
}
