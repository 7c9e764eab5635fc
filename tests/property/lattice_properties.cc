// Properties that hold for every deformation, checked on random ones.
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <cmath>
#include <iostream>

#include "lattice/forces/energy.h"
#include "lattice/forces/forces.h"
#include "lattice/model/model.h"
#include "lattice/model/state.h"
#include "tests/lattice/reference.h"

using namespace fingertip;
using lattice::Kinematics;
using lattice::LatticeModel;
using lattice::ModelKind;
using lattice::State;
using lattice::VectorField;
using meshes::Vector3;

namespace {

double uniform(double from, double to) {
  return from + (to - from) * 1e-9 * *rc::gen::inRange(0, 1000000001);
}
Vector3 random_vector(double size) {
  return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
}

/// A block of any of the models, springs alone or cells with a law.
struct Block {
  ModelKind kind;
  Kinematics kinematics;
  std::array<int, 3> cells;
  double spacing;
  lattice::SpringConstants constants;
  meshes::Rubber rubber;
  bool springs;  ///< hookean: of central springs, else as tips are made

  LatticeModel built() const {
    if (springs) {
      return lattice::build_block(kind, kinematics, constants, spacing, cells, rubber.density,
                                  rubber.retardation_time);
    }
    lattice::LatticeSettings settings;
    settings.model = kind;
    settings.kinematics = kinematics;
    settings.spacing = spacing;
    settings.constants = constants;
    meshes::CubicGrid grid;
    grid.spacing = spacing;
    grid.origin = Vector3::Constant(-spacing);
    grid.size = {cells[0] + 3 + lattice::row_margin, cells[1] + 3, cells[2] + 3};
    return lattice::build_model(lattice::GridCells(grid, lattice::whole_cells({1, 1, 1}, cells)),
                                kind, lattice::formulation_for(rubber, settings), rubber.density);
  }
};

Block random_block() {
  Block block;
  block.kind = *rc::gen::element(ModelKind::published, ModelKind::central, ModelKind::hookean,
                                 ModelKind::network);
  block.kinematics = *rc::gen::element(Kinematics::small, Kinematics::finite);
  block.cells = {*rc::gen::inRange(1, 11), *rc::gen::inRange(1, 4), *rc::gen::inRange(1, 4)};
  block.spacing = uniform(1e-4, 1e-2);
  block.constants = {uniform(0.1, 10.0), uniform(0.0, 10.0), uniform(0.0, 10.0), uniform(0.0, 1e4)};
  block.rubber.shear_modulus = uniform(100.0, 1e4);
  block.rubber.youngs_modulus = uniform(2.0, 2.98) * block.rubber.shear_modulus;
  block.rubber.retardation_time = uniform(0.0, 1e-3);
  block.springs = block.kind == ModelKind::published ||
                  (block.kind != ModelKind::network && *rc::gen::element(true, false));
  return block;
}

LatticeModel random_model() {
  return random_block().built();
}

State random_state(const LatticeModel& model, double speed) {
  State state(model);
  for (const std::size_t i : model.particles) {
    // Little enough that no cell is turned inside out.
    state.displacement.set(i, random_vector(0.15 * model.spacing()));
    state.velocity.set(i, random_vector(speed));
  }
  return state;
}

VectorField forces(const LatticeModel& model, const State& state, int threads = 1) {
  lattice::Team team(threads);
  lattice::InternalForces internal(model, team);
  VectorField force(model.points());
  internal.accumulate(state, force);
  return force;
}

double power(const LatticeModel& model, const VectorField& force, const VectorField& velocity) {
  double sum = 0.0;
  for (const std::size_t i : model.particles) sum += force.at(i).dot(velocity.at(i));
  return sum;
}

/// Sum of the forces' magnitudes, plus the round-off that even a body at rest has.
double size_of(const LatticeModel& model, const VectorField& field) {
  double sum = 0.0;
  for (const std::size_t i : model.particles) sum += field.at(i).norm();
  const double springs = model.stiffness[0] + model.stiffness[1] + model.stiffness[2];
  const lattice::CellMaterial& m = model.cell_lattice.material;
  const double cells = (m.c11 + m.kappa + m.shear + m.lambda) * model.spacing();
  return sum + 1e-3 * (springs + cells) * model.spacing();
}

bool kernel_equals_edge_list() {
  return rc::check("the kernel computes the edge list's forces", [] {
    const LatticeModel model = random_model();
    const State state = random_state(model, 1.0);
    const VectorField expected = reference::forces(model, state);
    const VectorField computed = forces(model, state);
    const double scale = size_of(model, expected);
    for (const std::size_t i : model.particles) {
      RC_ASSERT((computed.at(i) - expected.at(i)).norm() <= 1e-12 * scale);
    }
  });
}

bool forces_balance() {
  return rc::check("internal forces add up to nothing, and so do their moments", [] {
    const LatticeModel model = random_model();
    const State state = random_state(model, 1.0);
    const VectorField force = forces(model, state);
    Vector3 sum = Vector3::Zero(), moment = Vector3::Zero();
    for (const std::size_t i : model.particles) {
      const Vector3 at = model.kinematics == Kinematics::small
                             ? model.rest_position(i)
                             : Vector3(lattice::position(model, state, i));
      sum += force.at(i);
      moment += at.cross(force.at(i));
    }
    const double scale = size_of(model, force);
    RC_ASSERT(sum.norm() <= 1e-12 * scale);
    RC_ASSERT(moment.norm() <= 1e-12 * scale * 20.0 * model.spacing());
  });
}

bool forces_come_from_the_energy() {
  return rc::check("power against any motion is the fall of the elastic energy", [] {
    const LatticeModel model = random_model();
    State state = random_state(model, 0.0);
    const VectorField force = forces(model, state);
    VectorField motion(model.points());
    for (const std::size_t i : model.particles) motion.set(i, random_vector(1.0));
    const double h = 1e-6 * model.spacing();
    const auto energy = [&](double step) {
      State moved = state;
      for (const std::size_t i : model.particles) moved.displacement.add(i, step * motion.at(i));
      return lattice::elastic_energy(model, moved);
    };
    const double slope = (energy(h) - energy(-h)) / (2.0 * h);
    RC_ASSERT(std::abs(slope + power(model, force, motion)) <= 1e-6 * size_of(model, force));
  });
}

bool dampers_only_take_energy() {
  return rc::check("dampers never feed energy into the motion", [] {
    const LatticeModel model = random_model();
    const State moving = random_state(model, 1.0);
    State still = moving;
    for (const std::size_t i : model.particles) still.velocity.set(i, Vector3::Zero());
    const double viscous = power(model, forces(model, moving), moving.velocity) -
                           power(model, forces(model, still), moving.velocity);
    RC_ASSERT(viscous <= 1e-10 * size_of(model, forces(model, moving)));
  });
}

/// Rotations of any size at finite strain, infinitesimal ones at small strain.
bool rigid_motion_is_free() {
  return rc::check("a rigid motion costs nothing and is not damped", [] {
    const LatticeModel model = random_model();
    const bool finite = model.kinematics == Kinematics::finite;
    const Eigen::AngleAxisd turn(uniform(-3.0, 3.0),
                                 (random_vector(1.0) + Vector3(0.1, 0.2, 1.3)).normalized());
    const Vector3 spin = random_vector(5.0), small_turn = random_vector(0.3);
    const Vector3 shift = random_vector(model.spacing());
    State state(model);
    for (const std::size_t i : model.particles) {
      const Vector3 rest = model.rest_position(i);
      const Vector3 u = shift + (finite ? Vector3(turn * rest - rest) : small_turn.cross(rest));
      state.displacement.set(i, u);
      state.velocity.set(i, spin.cross(finite ? Vector3(rest + u) : rest));
    }
    State still = state;
    for (const std::size_t i : model.particles) still.velocity.set(i, Vector3::Zero());
    const double scale = size_of(model, VectorField(model.points()));
    const VectorField moving = forces(model, state), resting = forces(model, still);
    for (const std::size_t i : model.particles) {
      RC_ASSERT(resting.at(i).norm() <= 1e-9 * scale);
      RC_ASSERT((moving.at(i) - resting.at(i)).norm() <= 1e-9 * scale);
    }
  });
}

/// Also of a body that is strained.
bool spinning_is_not_damped() {
  return rc::check("at finite strain a deformed body turns without damping", [] {
    Block block = random_block();
    block.kinematics = Kinematics::finite;
    const LatticeModel model = block.built();
    const State still = random_state(model, 0.0);
    State turning = still;
    const Vector3 spin = random_vector(50.0), drift = random_vector(1.0);
    for (const std::size_t i : model.particles) {
      turning.velocity.set(i, drift + spin.cross(lattice::position(model, still, i)));
    }
    const VectorField before = forces(model, still), after = forces(model, turning);
    const double scale = size_of(model, before);
    for (const std::size_t i : model.particles) {
      RC_ASSERT((before.at(i) - after.at(i)).norm() <= 1e-11 * scale);
    }
  });
}

/// A symmetry of the cube: axis c goes to axis[c], turned around where sign[c] is -1.
struct CubeSymmetry {
  std::array<int, 3> axis{0, 1, 2};
  std::array<double, 3> sign{};

  Vector3 vector(const Vector3& v) const {
    Vector3 image;
    for (std::size_t c = 0; c < 3; ++c) image[axis[c]] = sign[c] * v[Eigen::Index(c)];
    return image;
  }
  /// The block's lowest corner stays at the origin.
  std::size_t point(const LatticeModel& from, const LatticeModel& to,
                    const std::array<int, 3>& cells, std::size_t i) const {
    const Vector3 at = from.grid.coordinates(from.rest_position(i)).array().round();
    std::array<int, 3> image{};
    for (std::size_t c = 0; c < 3; ++c) {
      const int n = int(at[Eigen::Index(c)]);  // 1 to cells + 1
      image[std::size_t(axis[c])] = sign[c] > 0.0 ? n : cells[c] + 2 - n;
    }
    return to.grid.index(image[0], image[1], image[2]);
  }
};

bool cubic_symmetry() {
  return rc::check("the forces of a mirrored or turned block are mirrored or turned", [] {
    const Block block = random_block();
    CubeSymmetry symmetry;
    for (const int last : {2, 1}) {
      std::swap(symmetry.axis[std::size_t(last)],
                symmetry.axis[std::size_t(*rc::gen::inRange(0, last + 1))]);
    }
    Block image = block;
    for (std::size_t c = 0; c < 3; ++c) {
      symmetry.sign[c] = *rc::gen::element(1.0, -1.0);
      image.cells[std::size_t(symmetry.axis[c])] = block.cells[c];
    }
    const LatticeModel a = block.built(), b = image.built();
    const State state = random_state(a, 1.0);
    State mapped(b);
    for (const std::size_t i : a.particles) {
      const std::size_t j = symmetry.point(a, b, block.cells, i);
      RC_ASSERT(b.is_particle[j] == 1);
      mapped.displacement.set(j, symmetry.vector(state.displacement.at(i)));
      mapped.velocity.set(j, symmetry.vector(state.velocity.at(i)));
    }
    const VectorField force = forces(a, state), image_force = forces(b, mapped);
    const double scale = size_of(a, force);
    for (const std::size_t i : a.particles) {
      const Vector3 expected = symmetry.vector(force.at(i));
      const std::size_t j = symmetry.point(a, b, block.cells, i);
      RC_ASSERT((image_force.at(j) - expected).norm() <= 1e-11 * scale);
    }
  });
}

bool threads_do_not_matter() {
  return rc::check("two threads give the same bits as one", [] {
    const LatticeModel model = random_model();
    const State state = random_state(model, 1.0);
    RC_ASSERT(forces(model, state, 1).component == forces(model, state, 2).component);
  });
}

bool finite_models_are_objective() {
  return rc::check("turning a deformed body turns its forces", [] {
    Block block = random_block();
    block.kinematics = Kinematics::finite;
    const LatticeModel model = block.built();
    const State state = random_state(model, 1.0);
    const Eigen::AngleAxisd turn(uniform(-3.0, 3.0),
                                 (random_vector(1.0) + Vector3(0.1, 0.2, 1.3)).normalized());
    const Vector3 spin = random_vector(5.0);
    State turned(model);
    for (const std::size_t i : model.particles) {
      const Vector3 x = turn * lattice::position(model, state, i);
      turned.displacement.set(i, x - model.rest_position(i));
      turned.velocity.set(i, turn * state.velocity.at(i) + spin.cross(x));
    }
    const VectorField before = forces(model, state), after = forces(model, turned);
    const double scale = size_of(model, before);
    for (const std::size_t i : model.particles) {
      RC_ASSERT((turn * before.at(i) - after.at(i)).norm() <= 1e-10 * scale);
    }
  });
}

}  // namespace

int main() {
  bool good = kernel_equals_edge_list();
  good = forces_balance() && good;
  good = forces_come_from_the_energy() && good;
  good = dampers_only_take_energy() && good;
  good = rigid_motion_is_free() && good;
  good = spinning_is_not_damped() && good;
  good = cubic_symmetry() && good;
  good = threads_do_not_matter() && good;
  good = finite_models_are_objective() && good;
  return good ? 0 : 1;
}
