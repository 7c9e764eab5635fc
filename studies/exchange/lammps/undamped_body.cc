#include "studies/exchange/lammps/undamped_body.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "lattice/contact/bond.h"
#include "lattice/dynamics/time_step.h"
#include "lattice/forces/forces.h"
#include "lattice/model/cut_model.h"
#include "studies/presses/press_setup.h"

namespace fingertip::studies::inline exchange::inline lammps {

using lattice::LatticeModel;
using lattice::ModelKind;
using meshes::Vector3;

namespace {

/// Of the largest stable step, for springs that stiffen as they are stretched and turned.
constexpr double safety = 0.8;

/// Uniform in [-1, 1) from a counter (Steele, Lea & Flood, OOPSLA 2014: SplitMix64).
double noise(std::uint64_t counter) {
  std::uint64_t z = (counter + 1) * 0x9E3779B97F4A7C15U;
  z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9U;
  z = (z ^ (z >> 27U)) * 0x94D049BB133111EBU;
  z ^= z >> 31U;
  return double(z >> 11U) * 0x1p-52 - 1.0;
}

LatticeModel cube(const lattice::PressSetup& setup, int cells) {
  return lattice::build_block(setup.lattice.model, setup.lattice.kinematics,
                              setup.lattice.constants, setup.lattice.spacing, {cells, cells, cells},
                              setup.rubber.density, 0.0);
}

LatticeModel tip(lattice::PressSetup setup, bool is_free) {
  setup.rubber.retardation_time = 0.0;
  LatticeModel model = lattice::build_tip(setup.geometry, setup.rubber, setup.lattice);
  model.boundary.clear();
  model.outer.clear();
  if (is_free) {
    model.ligaments.clear();
    model.bond.clear();
  }
  return model;
}

void take_dampers_out(LatticeModel& model) {
  model.damping = {};
  model.retardation_time = 0.0;
  for (lattice::Ligament& ligament : model.ligaments) ligament.damping = 0.0;
}

/// The wall of a press seen from the rod: it starts a clearance away and comes at once at full
/// speed.
SoftWall wall_of(const lattice::PressSetup& setup, double stiffness) {
  const lattice::PressPlane press = lattice::press_plane(setup.protocol, setup.geometry);
  SoftWall wall;
  wall.plane.point = press.point(-setup.protocol.clearance);
  wall.plane.normal = press.normal;
  wall.plane.velocity = setup.protocol.speed * press.normal;
  wall.stiffness = stiffness;
  return wall;
}

void check_wall(const LoadedConfig& loaded) {
  std::vector<meshes::Violation> broken;
  const meshes::ContactMode contact = loaded.config.press.protocol.contact;
  if (contact != meshes::ContactMode::frictionless) {
    broken.push_back(
        {"press.contact", std::string(meshes::name(contact)),
         "an elastic wall holds nothing in its plane, and no command of LAMMPS anchors "
         "a mass where it crossed a plane",
         "choose frictionless, or exchange.plane = \"none\""});
  }
  const meshes::Obstacle& obstacle = loaded.config.press.protocol.obstacle;
  if (!obstacle.is_plane()) {
    broken.push_back({"obstacle.shape", std::string(name(obstacle.shape)),
                      "a wall for another program is a plane",
                      "leave obstacle.shape out, or choose exchange.plane = \"none\""});
  }
  if (loaded.config.exchange.cube) {
    broken.push_back({"exchange.plane", "wall", "the press is that of a fingertip",
                      "choose exchange.body = \"fingertip\", or no plane"});
  }
  if (!broken.empty()) throw loaded.locate(broken);
}

/// A wall adds k/m to the largest squared frequency of the masses behind it.
double with_wall(double step, double stiffness, const LatticeModel& model) {
  double lightest = model.mass[model.particles.front()];
  for (const std::uint32_t i : model.particles) lightest = std::min(lightest, model.mass[i]);
  const double squared = std::pow(2.0 * safety / step, 2) + stiffness / lightest;
  return 2.0 * safety / std::sqrt(squared);
}

}  // namespace

double SoftWall::gap(const Vector3& place, double time) const {
  return plane.normal.dot(place - plane.point - time * plane.velocity);
}

Vector3 SoftWall::force(const Vector3& place, double time) const {
  return -stiffness * std::min(0.0, gap(place, time)) * plane.normal;
}

double SoftWall::energy(const Vector3& place, double time) const {
  const double depth = std::min(0.0, gap(place, time));
  return 0.5 * stiffness * depth * depth;
}

lattice::State agitated(const LatticeModel& model, double agitation) {
  lattice::State state(model);
  const double length = agitation * model.spacing();
  std::uint64_t counter = 0;
  for (const std::uint32_t i : model.particles) {
    const double frequency = std::sqrt(model.stiffness[0] * model.inverse_mass[i]);
    for (std::size_t c = 0; c < 3; ++c) {
      state.displacement.component[c][i] = length * noise(counter++);
      state.velocity.component[c][i] = length * frequency * noise(counter++);
    }
  }
  return state;
}

void add_outer_forces(const UndampedBody& body, const lattice::State& state, double time,
                      lattice::VectorField& internal) {
  const LatticeModel& model = body.model;
  lattice::add_ligament_forces(model, state, lattice::RodState(body.rod), internal);
  if (!body.wall && body.gravity.isZero(0.0)) return;
  for (const std::uint32_t i : model.particles) {
    Vector3 outer = model.mass[i] * body.gravity;
    if (body.wall) outer += body.wall->force(lattice::position(model, state, i), time);
    internal.add(i, model.grid.axes.transpose() * outer);
  }
}

lattice::State synchronised(const UndampedBody& body, lattice::State state, double time) {
  lattice::Team team(1);
  lattice::VectorField force(body.model.points());
  lattice::InternalForces(body.model, team).accumulate(state, force);
  add_outer_forces(body, state, time, force);
  for (const std::uint32_t i : body.model.particles)
    state.velocity.add(i, 0.5 * body.step * body.model.inverse_mass[i] * force.at(i));
  return state;
}

UndampedBody undamped_body(const LoadedConfig& loaded) {
  const ExchangeSettings& settings = loaded.config.exchange;
  if (settings.has_wall) check_wall(loaded);
  const lattice::PressSetup setup = press_setup(loaded);
  UndampedBody body;
  body.model = settings.cube ? cube(setup, settings.cells) : tip(setup, settings.is_free);
  take_dampers_out(body.model);
  body.rod = lattice::rod_body(setup.geometry, setup.rod);
  body.gravity = -setup.gravity * lattice::press_plane(setup.protocol, setup.geometry).normal;
  body.step = lattice::StepController(body.model, nullptr, lattice::Integrator::symplectic_euler,
                                      setup.time_step)
                  .at_rest(setup.controller.period);
  if (settings.has_wall) {
    body.wall = wall_of(setup, settings.wall_stiffness * body.model.stiffness[0]);
    if (!setup.time_step) body.step = with_wall(body.step, body.wall->stiffness, body.model);
  }
  body.start = agitated(body.model, settings.agitation);
  return body;
}

}  // namespace fingertip::studies::inline exchange::inline lammps
