// LAMMPS marches the lattices that are exported to it; our own march is what it is compared with.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "lattice/forces/energy.h"
#include "studies/exchange/lammps_files.h"
#include "studies/exchange/lammps_import.h"
#include "studies/exchange/lammps_program.h"
#include "studies/exchange/undamped_march.h"
#include "studies/presses/press_setup.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;

namespace {

UndampedBody body_of(std::vector<std::string> sets) {
  sets.emplace_back("lattice.spacing=tip_radius/6");
  ConfigSource source;
  source.sets = std::move(sets);
  return undamped_body(load_config(source));
}

/// Both march so many steps from the same agitated start, and keep five frames.
LammpsImport exchanged(const UndampedBody& body, const TemporaryFolder& folder, int ranks = 1,
                       long steps = 1000) {
  write_lammps(body, {steps, steps / 4}, folder.path());
  const LammpsTiming timing = run_lammps(folder.path(), ranks);
  EXPECT_EQ(timing.steps, steps);
  EXPECT_EQ(timing.ranks, ranks);
  return import_lammps(body, folder.path(), {.compare = true});
}

void expect_same_path(const LammpsImport& run) {
  ASSERT_EQ(run.rows.size(), 5U);
  EXPECT_LT(run.worst_deviation(), 1e-9);
  EXPECT_LT(run.worst_velocity_deviation(), 1e-9);
  EXPECT_FALSE(run.broke_off);
  std::printf("deviation %.3g, of velocities %.3g; %.3g ns per spring and step\n",
              run.worst_deviation(), run.worst_velocity_deviation(),
              run.timing->ns_per_spring_step(run.springs));
}

/// Total energy of all frames within `fraction` of the first's.
void expect_conserved(const LammpsImport& run, double fraction) {
  const auto total = [](const TrajectoryRow& row) {
    return row.kinetic_energy + row.elastic_energy;
  };
  for (const TrajectoryRow& row : run.rows) {
    EXPECT_NEAR(total(row), total(run.rows.front()), fraction * total(run.rows.front()));
  }
}

TEST(LammpsMarch, AFreeCubeOfFullSprings) {
  const TemporaryFolder folder;
  UndampedBody body = body_of({"lattice.model=published", "exchange.body=cube"});
  body.step *= 0.25;
  ASSERT_EQ(body.model.particles.size(), 729U);
  const LammpsImport run = exchanged(body, folder);
  expect_same_path(run);
  // Velocity Verlet keeps H - (w dt)²/4 of the elastic energy of every mode, and w dt is 0.4 here
  // for the fastest.
  expect_conserved(run, 0.25 * 0.4 * 0.4);
  // Nothing holds it: its momentum stays.
  EXPECT_LT((run.rows.back().momentum - run.rows.front().momentum).norm(),
            1e-12 * body.model.total_mass() * body.model.spacing() / body.step);
}

TEST(LammpsMarch, ACubeWhoseMassesAndSpringsDiffer) {
  // Whole cells: corners, edges, faces and the inside differ in mass and weight.
  const UndampedBody body =
      body_of({"lattice.model=central", "lattice.kinematics=finite", "exchange.body=cube",
               "exchange.cells=6", "exchange.agitation=0.05"});
  const TemporaryFolder folder;
  expect_same_path(exchanged(body, folder));
}

TEST(LammpsMarch, AFreeTip) {
  const TemporaryFolder folder;
  expect_same_path(exchanged(body_of({"lattice.model=published", "exchange.hold=free"}), folder));
}

TEST(LammpsMarch, ACubeSharedByTwoRanks) {
  // Few steps: ranks that wait for each other spin, which is slow where cores are shared.
  const TemporaryFolder folder;
  expect_same_path(
      exchanged(body_of({"lattice.model=published", "exchange.body=cube"}), folder, 2, 100));
}

TEST(LammpsMarch, AFreeTipOfCutCells) {
  // Every cut cell has weights of its own.
  const UndampedBody body = body_of({"lattice.model=central", "lattice.kinematics=finite",
                                     "exchange.hold=free", "exchange.agitation=0.001"});
  const TemporaryFolder folder;
  expect_same_path(exchanged(body, folder));
}

TEST(LammpsMarch, TheTipOnItsRodUnderGravity) {
  const UndampedBody body = body_of({"lattice.model=published", "press.gravity=\"9.81 m/s^2\""});
  const TemporaryFolder folder;
  const LammpsImport run = exchanged(body, folder);
  expect_same_path(run);
  // The rod carries the tip: on average over its vibrations, and at the start not at all.
  EXPECT_LT(run.rows.front().rod_force.z(), run.rows.back().rod_force.z());
}

TEST(LammpsMarch, TheTipAgainstAWall) {
  const UndampedBody body =
      body_of({"lattice.model=published", "press.contact=frictionless", "exchange.plane=wall",
               "press.speed=\"1 cm/s\"", "press.clearance=\"0.01 cm\"", "exchange.agitation=0"});
  const TemporaryFolder folder;
  const LammpsImport run = exchanged(body, folder);
  expect_same_path(run);
  EXPECT_GT(run.rows.back().wall_force, 1e-3);
  EXPECT_EQ(run.rows.front().wall_force, 0.0);
}

/// Why LAMMPS and we may part: so do two of our own marches that start one rounding apart, where
/// very light masses of cut cells are shaken hard; their rounding grows as exp(t).
TEST(UndampedMarch, LightMassesThatAreShakenHardMoveChaotically) {
  const auto parted = [](const char* agitation, int steps) {
    const UndampedBody body =
        body_of({"lattice.model=central", "lattice.kinematics=finite", "exchange.hold=free",
                 std::string("exchange.agitation=") + agitation});
    UndampedBody twin = body;
    const std::uint32_t moved = body.model.particles.front();
    twin.start.displacement.set(moved, (1.0 + 0x1p-52) * body.start.displacement.at(moved));
    UndampedMarch march(body), other(twin);
    for (int step = 0; step < steps; ++step) march.advance(), other.advance();
    const lattice::State ours = march.synchronised(), theirs = other.synchronised();
    std::pair<double, double> most{0.0, 0.0};  // deviation, mass
    for (const std::uint32_t i : body.model.particles)
      most = std::max(most, {(ours.displacement.at(i) - theirs.displacement.at(i)).norm() /
                                 body.model.spacing(),
                             body.model.mass[i]});
    const double whole = *std::ranges::max_element(body.model.mass);
    return std::pair(most.first, most.second / whole);
  };
  EXPECT_LT(parted("0.0001", 400).first, 1e-11);
  const auto [early, first] = parted("0.01", 200);
  EXPECT_GT(early, 1e-9);
  const auto [late, lightest] = parted("0.01", 400);
  EXPECT_GT(late, 0.1);
  EXPECT_LT(first, 0.01);
}

TEST(UndampedMarch, AHalfKickMakesEulersVelocitiesVerlets) {
  // By hand: velocity Verlet on our own forces from the synchronised start.
  const UndampedBody body = body_of(
      {"lattice.model=published", "exchange.body=cube", "exchange.cells=3", "exchange.hold=free"});
  UndampedMarch march(body);
  lattice::State verlet = march.synchronised();
  lattice::Team team(1);
  lattice::InternalForces forces(body.model, team);
  lattice::VectorField force(body.model.points());
  const auto kick = [&] {
    forces.accumulate(verlet, force);
    for (const std::uint32_t i : body.model.particles)
      verlet.velocity.add(i, 0.5 * body.step * body.model.inverse_mass[i] * force.at(i));
  };
  for (int step = 0; step < 50; ++step) {
    march.advance();
    kick();
    for (const std::uint32_t i : body.model.particles)
      verlet.displacement.add(i, body.step * verlet.velocity.at(i));
    kick();
  }
  const lattice::State ours = march.synchronised();
  for (const std::uint32_t i : body.model.particles) {
    EXPECT_LT((ours.displacement.at(i) - verlet.displacement.at(i)).norm(),
              1e-12 * body.model.spacing());
    EXPECT_LT((ours.velocity.at(i) - verlet.velocity.at(i)).norm(),
              1e-12 * body.model.spacing() / body.step);
  }
}

TEST(UndampedMarch, AWallPushesAsItsEnergyFalls) {
  SoftWall wall;
  wall.plane.point = {0.0, 0.0, 0.01};
  wall.plane.normal = meshes::Vector3(-0.6, 0.0, -0.8);
  wall.plane.velocity = {0.0, 0.0, -0.1};
  wall.stiffness = 3.0;
  const meshes::Vector3 place(0.0, 0.001, 0.012);
  constexpr double h = 1e-7, time = 0.02;
  for (int axis = 0; axis < 3; ++axis) {
    const meshes::Vector3 step = h * meshes::Vector3::Unit(axis);
    const double slope =
        (wall.energy(place + step, time) - wall.energy(place - step, time)) / (2 * h);
    EXPECT_NEAR(wall.force(place, time)[axis], -slope, 1e-8);
  }
  EXPECT_TRUE(wall.force({0.0, 0.0, 0.0}, time).isZero(0.0));
}

TEST(LammpsFiles, WhatLammpsCannotExpressIsRefusedWithARemedy) {
  const auto refused = [](std::vector<std::string> sets, const std::string& key,
                          const std::string& remedy) {
    const auto found = beyond_lammps(body_of(std::move(sets)).model);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].key, key);
    EXPECT_NE(found[0].remedy.find(remedy), std::string::npos) << found[0].remedy;
  };
  refused({"lattice.model=hookean", "exchange.hold=free"}, "lattice.model", "published");
  refused({"lattice.model=hookean", "lattice.kinematics=finite", "exchange.hold=free"},
          "lattice.model", "central");
  refused({"lattice.model=network", "exchange.hold=free"}, "lattice.model", "published");
  refused({"lattice.model=central", "exchange.hold=free"}, "lattice.kinematics", "finite");
  refused({"lattice.model=central", "lattice.kinematics=finite"}, "exchange.hold", "free");
  const TemporaryFolder folder;
  EXPECT_THROW(write_lammps(body_of({"lattice.model=network"}), {}, folder.path()),
               meshes::InvalidInput);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_THROW(body_of({"lattice.model=published", "exchange.plane=wall"}), ConfigError);
}

TEST(LammpsOutput, ALogTellsItsLastRun) {
  const TemporaryFolder folder;
  write_text(folder / "log",
             "Loop time of 9.5 on 1 procs for 10 steps with 4 atoms\nother words\n"
             "Loop time of 0.5 on 2 procs for 1000 steps with 729 atoms\n");
  const LammpsTiming timing = read_lammps_log(folder / "log");
  EXPECT_EQ(timing.loop_time, 0.5);
  EXPECT_EQ(timing.ranks, 2);
  EXPECT_EQ(timing.atoms, 729U);
  EXPECT_DOUBLE_EQ(timing.ns_per_spring_step(5000), 100.0);
  write_text(folder / "log", "ERROR: Lost atoms: original 729 current 700\n");
  EXPECT_THROW(read_lammps_log(folder / "log"), meshes::InvalidInput);
  EXPECT_THROW(read_lammps_log(folder / "none"), meshes::InvalidInput);
}

TEST(LammpsOutput, ADumpMayHaveItsRowsAndColumnsInAnyOrder) {
  const TemporaryFolder folder;
  const std::string rest = "ITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS ss ss ss\n0 1\n0 1\n0 1\n";
  const std::string head = "ITEM: TIMESTEP\n20\n" + rest, later = "ITEM: TIMESTEP\n40\n" + rest;
  write_text(folder / "dump", head +
                                  "ITEM: ATOMS z y x id type vx vy vz\n3 2 1 2 1 4 5 6\n"
                                  "30 20 10 1 1 40 50 60 \n" +
                                  later + "ITEM: ATOMS id x y z vx vy vz\n1 1 1 1 0 0 0\n");
  LammpsDump dump(folder / "dump", 2);
  const auto frame = dump.next();
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->step, 20);
  EXPECT_EQ(frame->position[1], meshes::Vector3(1, 2, 3));
  EXPECT_EQ(frame->velocity[0], meshes::Vector3(40, 50, 60));
  EXPECT_FALSE(dump.next().has_value());  // the second frame breaks off
  EXPECT_TRUE(dump.broke_off());
  LammpsDump other(folder / "dump", 3);
  EXPECT_THROW(other.next(), meshes::InvalidInput);
  write_text(folder / "twice",
             head + "ITEM: ATOMS id x y z vx vy vz\n1 1 1 1 0 0 0\n1 1 1 1 0 0 0\n");
  LammpsDump twice(folder / "twice", 2);
  EXPECT_THROW(twice.next(), meshes::InvalidInput);
}

}  // namespace
