// Every kernel of the spring engine against the scalar reference, and what must hold whatever the
// kernel: the same bits for every number of threads, conserved momentum.
#include <gtest/gtest.h>

#include <string>
#include <tuple>
#include <vector>

#include "lattice/springs/reference_springs.h"
#include "lattice/springs/spring_lattice.h"
#include "spring_scenes.h"

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
                        {"long box", box(67, 3, 4)}};
  for (int nx = 2; nx <= 10; ++nx) all.push_back({"box " + std::to_string(nx), box(nx, 3, 3)});
  all.push_back({"no masses", sponge(5, 5, 5, 0.0, 1)});
  return all;
}

std::vector<int> widths() {
  std::vector<int> all;
  for (int width = 2; width <= lattice::springs::widest(); width *= 2) all.push_back(width);
  return all;
}

/// Largest error of velocity and of displacement in this step, relative to the largest velocity
/// and displacement.
double step_error(const SpringProblem& problem, const EngineOptions& options) {
  ReferenceSprings reference(problem);
  SpringLattice lattice(problem, options);
  const Motion start = shaken(problem, 3);
  reference.set_motion(start.positions, start.velocities);
  lattice.set_motion(start.positions, start.velocities);
  reference.run(1);
  lattice.run(1);
  const double velocity = largest(lattice.velocities() - reference.velocities()) /
                          std::max(1e-300, largest(reference.velocities()));
  const double position = largest(lattice.positions() - reference.positions()) /
                          std::max(1e-300, largest(reference.positions()));
  return std::max(velocity, position);
}

}  // namespace

TEST(SpringKernels, EqualTheReferenceInDoublePrecision) {
  for (const Body& body : bodies())
    for (const int width : widths())
      EXPECT_LT(step_error(body.problem, {Precision::float64, width, 1}), 1e-12)
          << body.name << ", " << width << " lanes";
}

TEST(SpringKernels, EqualTheReferenceInSinglePrecision) {
  for (const Body& body : bodies())
    for (const int width : widths())
      EXPECT_LT(step_error(body.problem, {Precision::float32, width, 1}), 5e-5)
          << body.name << ", " << width << " lanes";
}
