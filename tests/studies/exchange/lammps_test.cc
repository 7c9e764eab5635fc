// LAMMPS marches the lattices that are exported to it; our own march is what it is compared with.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lattice/forces/energy.h"
#include "studies/exchange/lammps/lammps_files.h"
#include "studies/exchange/lammps/lammps_program.h"
#include "studies/presses/press_setup.h"
#include "tests/studies/exchange/undamped_march.h"
#include "tests/temporary_folder.h"

using namespace fingertip;
using namespace fingertip::studies;
using meshes::Vector3;

namespace {

UndampedBody body_of(std::vector<std::string> sets) {
  sets.emplace_back("lattice.spacing=tip_radius/6");
  ConfigSource source;
  source.sets = std::move(sets);
  return undamped_body(load_config(source));
}

/// LAMMPS's masses at one time, and how far they are from where our own march has them.
struct Frame {
  double energy = 0.0;              ///< kinetic and elastic [J]
  Vector3 momentum, rod_force;      ///< [N s]; of the ligaments on the rod [N]
  double wall_force = 0.0;          ///< along its normal [N]
  double deviation = 0.0;           ///< largest, over the spacing
  double velocity_deviation = 0.0;  ///< largest, over the spacing times an axis spring's frequency
};

/// The next frame of a dump: its step, and the state.
std::optional<long> read_frame(std::istream& dump, const lattice::LatticeModel& model,
                               lattice::State& state) {
  long step = -1;
  for (std::string line; std::getline(dump, line);) {
    if (line == "ITEM: TIMESTEP") dump >> step;
    if (!line.starts_with("ITEM: ATOMS")) continue;
    EXPECT_TRUE(line.starts_with("ITEM: ATOMS id x y z vx vy vz")) << line;
    const auto to_grid = model.grid.axes.transpose();
    std::size_t place_in_frame = 0;
    for (const std::uint32_t i : model.particles) {
      std::size_t atom = 0;
      Vector3 place, velocity;
      dump >> atom >> place.x() >> place.y() >> place.z() >> velocity.x() >> velocity.y() >>
          velocity.z();
      EXPECT_EQ(atom, ++place_in_frame);
      state.displacement.set(i, to_grid * (place - model.rest_position(i)));
      state.velocity.set(i, to_grid * velocity);
    }
    EXPECT_TRUE(dump.good());
    return step;
  }
  return {};
}

double largest_difference(const lattice::VectorField& a, const lattice::VectorField& b,
                          const lattice::LatticeModel& model) {
  double largest = 0.0;
  for (const std::uint32_t i : model.particles) {
    const double difference = (a.at(i) - b.at(i)).norm();
    if (!(difference <= largest)) largest = difference;  // keeps a NaN visible
  }
  return largest;
}

/// Both march so many steps from the same agitated start, and keep five frames.
std::vector<Frame> exchanged(const UndampedBody& body, const TemporaryFolder& folder, int ranks = 1,
                             long steps = 1000) {
  write_lammps(body, {steps, steps / 4}, folder.path());
  const LammpsTiming timing = run_lammps(folder.path(), ranks);
  EXPECT_EQ(timing.steps, steps);
  EXPECT_EQ(timing.ranks, ranks);
  const lattice::LatticeModel& model = body.model;
  const double frequency =
      std::sqrt(model.stiffness[0] * model.inverse_mass[model.particles.front()]);
  std::ifstream dump(folder / lammps_dump);
  std::vector<Frame> frames;
  UndampedMarch march(body);
  lattice::State theirs(model);
  while (const std::optional<long> step = read_frame(dump, model, theirs)) {
    EXPECT_TRUE(frames.empty() || march.steps() < *step) << *step;
    while (march.steps() < *step) march.advance();
    const lattice::State ours = march.now();
    const Energies energy = energies(body, theirs, march.time());
    const OuterForces outer = outer_forces(body, theirs, march.time());
    frames.push_back(
        {energy.kinetic + energy.elastic, lattice::linear_momentum(model, theirs), outer.rod,
         body.wall ? -outer.wall.dot(body.wall->plane.normal) : 0.0,
         largest_difference(theirs.displacement, ours.displacement, model) / model.spacing(),
         largest_difference(theirs.velocity, ours.velocity, model) /
             (model.spacing() * frequency)});
  }
  return frames;
}

void expect_same_path(const std::vector<Frame>& run) {
  ASSERT_EQ(run.size(), 5U);
  for (const Frame& frame : run) {
    EXPECT_LT(frame.deviation, 1e-9);
    EXPECT_LT(frame.velocity_deviation, 1e-9);
  }
  std::printf("deviation %.3g, of velocities %.3g\n", run.back().deviation,
              run.back().velocity_deviation);
}

/// Total energy of all frames within `fraction` of the first's.
void expect_conserved(const std::vector<Frame>& run, double fraction) {
  for (const Frame& frame : run)
    EXPECT_NEAR(frame.energy, run.front().energy, fraction * run.front().energy);
}

TEST(LammpsMarch, AFreeCubeOfFullSprings) {
  const TemporaryFolder folder;
  UndampedBody body = body_of({"lattice.model=published", "exchange.body=cube"});
  body.step *= 0.25;
  ASSERT_EQ(body.model.particles.size(), 729U);
  const std::vector<Frame> run = exchanged(body, folder);
  expect_same_path(run);
  // Velocity Verlet keeps H - (w dt)²/4 of the elastic energy of every mode, and w dt is 0.4 here
  // for the fastest.
  expect_conserved(run, 0.25 * 0.4 * 0.4);
  // Nothing holds it: its momentum stays.
  EXPECT_LT((run.back().momentum - run.front().momentum).norm(),
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
  const std::vector<Frame> run = exchanged(body, folder);
  expect_same_path(run);
  // The rod carries the tip: on average over its vibrations, and at the start not at all.
  EXPECT_LT(run.front().rod_force.z(), run.back().rod_force.z());
}

TEST(LammpsMarch, TheTipAgainstAWall) {
  const UndampedBody body =
      body_of({"lattice.model=published", "press.contact=frictionless", "exchange.plane=wall",
               "press.speed=\"1 cm/s\"", "press.clearance=\"0.01 cm\"", "exchange.agitation=0"});
  const TemporaryFolder folder;
  const std::vector<Frame> run = exchanged(body, folder);
  expect_same_path(run);
  EXPECT_GT(run.back().wall_force, 1e-3);
  EXPECT_EQ(run.front().wall_force, 0.0);
}

/// Why LAMMPS and we may part: so do two of our own marches that start one rounding apart, where
/// very light masses of cut cells are shaken hard; their rounding grows as exp(t).
TEST(UndampedMarch, LightMassesThatAreShakenHardMoveChaotically) {
  const auto parted = [](const char* agitation, int steps) {
    const UndampedBody body =
        body_of({"lattice.model=central", "lattice.kinematics=finite", "exchange.hold=free",
                 std::string("exchange.agitation=") + agitation});
    UndampedBody twin = body;
    // All of them: a single rounding may be rounded away before it grows.
    for (const std::uint32_t i : body.model.particles)
      twin.start.displacement.set(i, (1.0 + 0x1p-52) * body.start.displacement.at(i));
    UndampedMarch march(body), other(twin);
    for (int step = 0; step < steps; ++step) march.advance(), other.advance();
    const lattice::State ours = march.now(), theirs = other.now();
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
  lattice::State verlet = march.now();
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
  const lattice::State ours = march.now();
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

TEST(LammpsProgram, ALogTellsItsLastRun) {
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

}  // namespace
