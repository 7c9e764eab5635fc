// What must hold of the spring engine whatever the kernel: the same bits for every number of
// threads, conserved momenta, no allocation while it runs, refusal of what it cannot do.
#include "tests/benchmarks/springs/engine/spring_lattice.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <atomic>
#include <cmath>
#include <cstdlib>
#include <new>
#include <vector>

#include "spring_scenes.h"

namespace {
std::atomic<long> allocations{0};
}

void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

using namespace fingertip;
using namespace scenes;
using lattice::springs::EngineOptions;
using lattice::springs::PenaltyPlane;
using lattice::springs::Precision;
using lattice::springs::SpringLattice;

namespace {

/// The motion after `calls` runs of the given steps.
Motion after(const SpringProblem& problem, const EngineOptions& options,
             const std::vector<int>& calls) {
  SpringLattice lattice(problem, options);
  const Motion start = shaken(problem, 5);
  lattice.set_motion(start.positions, start.velocities);
  for (const int steps : calls) lattice.run(steps);
  return {lattice.positions(), lattice.velocities()};
}

std::vector<SpringProblem> bodies() {
  return {box(20, 9, 12), fingertip_body(6), sponge(21, 10, 9, 0.5, 2), box(9, 4, 1), box(9, 4, 2)};
}

/// Σ x_i × v_i, the angular momentum over m.
Eigen::Vector3d turning(const Motion& m) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (Eigen::Index i = 0; i < m.positions.cols(); ++i)
    sum += Eigen::Vector3d(m.positions.col(i)).cross(Eigen::Vector3d(m.velocities.col(i)));
  return sum;
}

}  // namespace

TEST(SpringLattice, GivesTheSameBitsForEveryNumberOfThreads) {
  for (const SpringProblem& problem : bodies()) {
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      for (const int width : widths()) {
        const Motion serial = after(problem, {precision, width, 1}, {37});
        for (const int threads : {2, 3}) {
          const Motion several = after(problem, {precision, width, threads}, {20, 1, 0, 16});
          EXPECT_EQ(serial.positions, several.positions) << threads << " threads";
          EXPECT_EQ(serial.velocities, several.velocities) << threads << " threads";
        }
      }
    }
  }
}

TEST(SpringLattice, RunsOnFewerThreadsThanMadeReady) {
  const SpringProblem problem = ball(11);
  SpringLattice lattice(problem, {Precision::float64, 0, 3});
  const Motion start = shaken(problem, 5);
  lattice.set_motion(start.positions, start.velocities);
  lattice.run(5, 1);
  lattice.run(5, 3);
  lattice.run(5, 2);
  EXPECT_EQ(lattice.positions(), after(problem, {}, {15}).positions);
}

// Every spring's force acts on both ends along the line between them.
TEST(SpringLattice, ConservesMomentumAndAngularMomentum) {
  for (const SpringProblem& touching : bodies()) {
    const SpringProblem problem = floating(touching);
    for (const int width : widths()) {
      const Motion start = shaken(problem, 5);
      const Motion end = after(problem, {Precision::float64, width, 1}, {300});
      const double speeds = start.velocities.cwiseAbs().sum();
      EXPECT_LT((end.velocities - start.velocities).rowwise().sum().norm(), 1e-14 * speeds);
      EXPECT_LT((turning(end) - turning(start)).norm(), 1e-14 * speeds * largest(start.positions));
      EXPECT_GT(largest(end.velocities - start.velocities), 0.01);
    }
  }
}

TEST(SpringLattice, AllocatesNothingWhileItRuns) {
  SpringLattice lattice(fingertip_body(6), {Precision::float64, 0, 2});
  lattice.run(1);
  const long before = allocations;
  lattice.run(50);
  lattice.run(50, 1);
  EXPECT_EQ(allocations, before);
}

TEST(SpringLattice, RestsWhereItWasBuilt) {
  const SpringProblem problem = floating(ball(9));
  const Eigen::Matrix3Xd rest = lattice::springs::rest_positions(problem);
  const SpringLattice lattice(problem);
  EXPECT_EQ(lattice.positions(), rest);
  EXPECT_EQ(largest(lattice.velocities()), 0.0);
  EXPECT_EQ(lattice.masses(), std::size_t(rest.cols()));
}

TEST(SpringLattice, LanesAreFullOnBoxesAsWideAsRegisters) {
  for (const int width : widths()) {
    const SpringLattice lattice(floating(box(4 * width, 24, 24)), {Precision::float64, width, 1});
    EXPECT_GT(lattice.lane_efficiency(), 0.9);
  }
}

TEST(SpringLattice, RefusesWhatItCannotDo) {
  SpringProblem problem = box(4, 4, 4);
  EXPECT_THROW(SpringLattice(problem, {Precision::float64, 3, 1}), std::invalid_argument);
  EXPECT_THROW(SpringLattice(problem, {Precision::float64, 0, 0}), std::invalid_argument);
  SpringLattice lattice(problem, {Precision::float64, 0, 1});
  EXPECT_THROW(lattice.run(1, 2), std::invalid_argument);
  EXPECT_THROW(lattice.run(-1), std::invalid_argument);
  EXPECT_THROW(lattice.set_motion(Eigen::Matrix3Xd(3, 1), Eigen::Matrix3Xd(3, 1)),
               std::invalid_argument);
  const auto broken = [&](auto change) {
    SpringProblem bad = problem;
    change(bad);
    EXPECT_THROW(SpringLattice{bad}, meshes::InvalidInput);
    EXPECT_EQ(bad.violations().size(), 1u);
  };
  broken([](SpringProblem& p) { p.size[1] = 0; });
  broken([](SpringProblem& p) { p.mask.assign(3, 1); });
  broken([](SpringProblem& p) { p.spacing = 0.0; });
  broken([](SpringProblem& p) { p.stiffness[2] = -1.0; });
  broken([](SpringProblem& p) { p.damping[0] = -1.0; });
  broken([](SpringProblem& p) { p.mass = 0.0; });
  broken([](SpringProblem& p) { p.step = std::nan(""); });
  broken([](SpringProblem& p) { p.plane.normal *= 2.0; });
}
