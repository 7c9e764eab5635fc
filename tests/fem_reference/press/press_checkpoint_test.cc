/// A press saved and restored goes on as if nothing had happened.
#include <gtest/gtest.h>

#include "meshes/base/errors.h"
#include "tests/fem_reference/press/pressing.h"

using namespace fingertip;
using fem_reference::LinearSolver;
using fem_reference::PressState;
using fem_reference::ReferenceJob;
using fem_reference::Strain;
using meshes::ContactMode;

namespace {

void expect_same(const PressState& first, const PressState& second, double tolerance) {
  const auto near = [&](double a, double b, const char* what) {
    EXPECT_NEAR(a, b, tolerance * std::abs(a)) << what;
  };
  near(first.normal_force, second.normal_force, "force");
  near(first.max_pressure, second.max_pressure, "pressure");
  near(first.contact_radius, second.contact_radius, "radius");
  near(first.energy, second.energy, "energy");
  EXPECT_NEAR(first.lateral_force_x, second.lateral_force_x, tolerance * first.normal_force);
  EXPECT_NEAR(first.torque_y, second.torque_y, tolerance * first.normal_force);
  EXPECT_EQ(first.active_nodes, second.active_nodes);
  EXPECT_EQ(first.sliding_nodes, second.sliding_nodes);
  EXPECT_EQ(first.steps, second.steps);
}

/// Presses to a third, saves; presses on; restores into a new press of the same job and presses on.
void check(const ReferenceJob& job, bool refined, double tolerance) {
  const double depth = job.protocol.depth;
  Pressing first(job);
  const auto press_on = [&](Pressing& pressing) {
    pressing.press.set_longest_step(0.04);
    return pressing.press.advance(depth);
  };
  if (refined) {
    first.press.advance(depth / 2);
    first.press.refine(0.5);
  }
  first.press.set_longest_step(0.04);
  first.press.advance(depth / 3);
  first.press.save(first.folder().path());
  MPI_Barrier(MPI_COMM_WORLD);
  const PressState expected = press_on(first);

  Pressing second(job);
  second.press.load(first.folder().path());
  EXPECT_EQ(second.press.mesh().unknowns, first.press.mesh().unknowns);
  expect_same(expected, press_on(second), tolerance);
  // The marks for the next mesh came along.
  first.press.refine(0.5);
  second.press.refine(0.5);
  EXPECT_EQ(second.press.mesh().cells, first.press.mesh().cells);
}

TEST(PressCheckpoint, StickOnARefinedMesh) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::stick;
  job.press_to({3e-4, 1e-3});
  check(job, true, 1e-10);
}

TEST(PressCheckpoint, CoulombUnderTiltAndLateralMotion) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::coulomb;
  job.protocol.friction = 0.3;
  job.protocol.tilt = 0.2;
  job.protocol.lateral = 2e-4;
  check(job, false, 1e-8);
}

TEST(PressCheckpoint, LargeStrainByMultigrid) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::stick;
  job.strain = Strain::finite;
  job.solver = LinearSolver::multigrid;
  job.press_to({3e-4});
  job.degree = 1;
  check(job, true, 1e-7);
}

TEST(PressCheckpoint, OnAKnownWay) {
  ReferenceJob job = small_press();
  job.protocol.contact = ContactMode::stick;
  job.strain = Strain::finite;
  job.estimate_error = true;
  job.tolerance = 0.02;
  job.refinement = 0.25;
  job.press_to({3e-4, 6e-4});
  check(job, true, 1e-12);
}

TEST(PressCheckpoint, OfAnotherJobIsRefused) {
  ReferenceJob job = small_press();
  Pressing first(job);
  first.press.advance(2e-4);
  first.press.save(first.folder().path());
  MPI_Barrier(MPI_COMM_WORLD);
  job.protocol.contact = ContactMode::stick;  // has more contact unknowns
  Pressing second(job);
  EXPECT_THROW(second.press.load(first.folder().path()), meshes::InvalidInput);
}

}  // namespace
