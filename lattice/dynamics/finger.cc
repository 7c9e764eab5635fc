#include "lattice/dynamics/finger.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/contact/contact_smoothing.h"
#include "lattice/forces/energy.h"

namespace fingertip::lattice::inline dynamics {

using meshes::Vector3;

namespace {

constexpr std::size_t portion = 32;  // blocks per partial sum: the same for any thread count
constexpr std::size_t weights_per_piece = 512;

/// Mirror planes bear what acts across them.
void hold(const LatticeModel& model, VectorField& force) {
  for (std::size_t c = 0; c < 3; ++c)
    for (const std::uint32_t p : model.held[c]) force.component[c][p] = 0.0;
}

}  // namespace

Finger::Finger(const LatticeModel& model, const RodBody& rod, const Plane& plane,
               const ContactLaw& law, Integrator integrator, double step, const Team& team)
    : model_(&model),
      team_(team),
      internal_(model, team_),
      surfaces_(make_surfaces(model, plane, law, team_)),
      move_(kernel::select_move()),
      integrator_(integrator),
      law_(law),
      tip_mass_(model.total_mass()),
      now_{.state = State(model),
           .rod = RodState(rod),
           .plane = plane,
           .relaxing = RelaxingMemory(model),
           .step = step},
      force_(model.points()),
      partial_momentum_((model.blocks.size() + portion - 1) / portion) {}

void Finger::load(const Snapshot& snapshot) {
  now_ = snapshot.memory;
  surfaces_ = *snapshot.surfaces;
}

void Finger::start_at(const FingerMemory& memory) {
  now_ = memory;
  CutSurfaces* const ties = std::get_if<CutSurfaces>(&surfaces_);
  if (ties == nullptr) return;
  ties->start_at(now_.state, now_.plane, now_.rod.pose());
  find_forces(0.0);
  now_.plane_impulse = ties->correct(now_.state, force_, now_.plane, now_.step);
}

void Finger::find_forces(double step) {
  ++evaluations_;
  double cells = 0.0, surfaces = 0.0, branches = 0.0;
  const bool notes = notes_energy_;
  if (notes) branches = branch_energy().stored;
  now_.extremes =
      internal_.note(now_.state, now_.time, now_.relaxing, force_, notes ? &cells : nullptr);
  if (!gravity_.isZero(0.0)) weigh_particles(force_);
  now_.bond = std::visit(
      [&](auto& s) {
        return s.apply(now_.state, now_.rod, now_.plane, step, force_, notes ? &surfaces : nullptr);
      },
      surfaces_);
  hold(*model_, force_);
  if (!notes) return;
  noted_energy_.elastic = cells + branches + surfaces;
  if (!now_.scaling) noted_energy_.kinetic = kinetic_energy();  // else the move sums it
}

CutSurfaces& Finger::ties() {
  CutSurfaces* ties = std::get_if<CutSurfaces>(&surfaces_);
  if (ties == nullptr) throw std::logic_error("these surfaces act between steps, not by forces");
  return *ties;
}

void Finger::scale_masses(std::shared_ptr<MassScaling> scaling) {
  scaling->make(now_.state, ties().bond_inertia(now_.step), now_.step, team_);
  now_.scaling = std::move(scaling);
}

/// About the world's origin, along the grid's axes.
Vector6 Finger::along_grid(const Vector3& force, const Vector3& torque) const {
  Vector6 wrench;
  wrench << model_->grid.axes.transpose() * force, model_->grid.axes.transpose() * torque;
  return wrench;
}

/// Of a free rod under `applied` at its endpoint.
OuterLoads::Rod Finger::rod_load(const Wrench& applied) const {
  const RodState& rod = now_.rod;
  const Vector3 weight = rod.body().mass * gravity_, centre = rod.centre();
  const Eigen::Matrix3d axes = model_->grid.axes, inertia = rod.world_inertia();
  const Vector3 turning = rod.angular_velocity().cross(rod.angular_momentum());
  OuterLoads::Rod load;
  load.load =
      along_grid(applied.force + weight, applied.torque + rod.endpoint().cross(applied.force) +
                                             centre.cross(weight) - turning);
  load.inertia =
      rigid_inertia(rod.body().mass, axes.transpose() * centre, axes.transpose() * inertia * axes);
  return load;
}

/// Before the rubber is asked: as in the last step, but for the jump of the load, which moves the
/// bare rod first.
Vector6 Finger::expected_acceleration(const OuterLoads::Rod& rod) const {
  const auto& before = now_.carrying_rod;
  const Wrench& bond = now_.bond;
  const Vector6 pull =
      before ? Vector6(rod.load - before->load)
             : Vector6(rod.load +
                       along_grid(bond.force, bond.torque + now_.rod.endpoint().cross(bond.force)));
  const Vector6 jump = rod.inertia.ldlt().solve(pull);
  return before ? Vector6(before->acceleration + jump) : jump;
}

/// The same with scaled masses, `applied` on a free rod (null: prescribed).
Vector3 Finger::move_scaled(const Wrench* applied) {
  const MassScaling& scaling = *now_.scaling;
  if (std::abs(scaling.step() - now_.step) > 1e-9 * now_.step)
    throw std::logic_error("masses are scaled for steps of another length");
  if (!accelerations_) accelerations_ = std::make_unique<AccelerationFields>(scaling.fields());
  OuterLoads outer;
  outer.plane = ties().plane_hold(now_.step);
  outer.gravity = model_->grid.axes.transpose() * gravity_;
  if (applied != nullptr) {
    outer.rod = rod_load(*applied);
    if (now_.restraint.share[0].empty()) now_.restraint = scaling.restraint();
    scaling.restrain(now_.state, outer.plane, team_, *accelerations_, now_.restraint);
    outer.rod->restraint = &now_.restraint;
    outer.rod->expected = expected_acceleration(*outer.rod);
  }
  Reactions reactions = scaling.accelerate(now_.state, outer, force_, team_, *accelerations_);
  const CarriedRubber::Moved moved =
      scaling.move(now_.state, outer, reactions, team_, *accelerations_);
  reactions.plane -= moved.kept;
  if (notes_energy_) noted_energy_.kinetic = moved.kinetic_energy;
  now_.carrying_rod.reset();
  if (outer.rod) now_.carrying_rod = {reactions.rod, outer.rod->load};
  const Eigen::Matrix3d& axes = model_->grid.axes;
  const Vector3 bond = axes * reactions.bond.head<3>();
  now_.bond = {bond, axes * reactions.bond.tail<3>() - now_.rod.endpoint().cross(bond)};
  ties().set_plane_wrench({axes * reactions.plane.head<3>(), axes * reactions.plane.tail<3>()});
  return axes * moved.momentum;
}

CellExtremes Finger::internal_forces(const State& state, double time, VectorField& force) {
  ++evaluations_;
  return internal_.accumulate(state, time, now_.relaxing, force);
}

Finger::Trial Finger::attempt(const State& state, const RodState& rod, const Plane& plane,
                              double time, VectorField& force) {
  Trial trial;
  trial.extremes = internal_forces(state, time, force);
  if (!gravity_.isZero(0.0)) weigh_particles(force);
  trial.surfaces = ties().attempt(state, rod, plane, force);
  hold(*model_, force);
  return trial;
}

void Finger::weigh_particles(VectorField& force) {
  const Vector3 gravity = model_->grid.axes.transpose() * gravity_;
  const std::vector<std::uint32_t>& particles = model_->particles;
  team_.split(particles.size(), weights_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      force.add(particles[p], model_->mass[particles[p]] * gravity);
    }
  });
}

/// Returns their momentum before.
Vector3 Finger::move_particles() {
  kernel::Motion motion{};
  for (std::size_t c = 0; c < 3; ++c) {
    motion.force[c] = force_.component[c].data();
    motion.displacement[c] = now_.state.displacement.component[c].data();
    motion.velocity[c] = now_.state.velocity.component[c].data();
  }
  motion.mass = model_->mass.data();
  motion.inverse_mass = model_->inverse_mass.data();
  motion.step = now_.step;
  motion.symplectic = integrator_ != Integrator::explicit_euler;
  const auto& blocks = model_->blocks;
  team_.split(partial_momentum_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t last = std::min(blocks.size(), (p + 1) * portion);
      move_(motion, blocks.data(), p * portion, last, partial_momentum_[p].data());
    }
  });
  Vector3 momentum = Vector3::Zero();
  for (const Vector3& p : partial_momentum_) momentum += p;
  return model_->sector.whole(Vector3(model_->grid.axes * momentum));
}

void Finger::advance(const Wrench& applied) {
  find_forces(now_.step);
  const Vector3 of_particles = now_.scaling ? move_scaled(&applied) : move_particles();
  RodState& rod = now_.rod;
  const Vector3 momentum_before = rod.momentum();
  const Vector3 endpoint = rod.endpoint(), weight = rod.body().mass * gravity_;
  Wrench total{applied.force + now_.bond.force + weight, applied.torque + now_.bond.torque};
  total.torque += (rod.centre() - endpoint).cross(weight);
  if (integrator_ != Integrator::explicit_euler) {
    rod.kick(total, endpoint, now_.step);
    rod.drift(now_.step);
  } else {
    rod.drift(now_.step);
    rod.kick({total.force, total.torque + (endpoint - rod.endpoint()).cross(total.force)},
             rod.endpoint(), now_.step);
  }
  check_momentum(momentum_before + of_particles);
  close_step(now_.step * (applied.force + weight));
}

void Finger::advance(const RodMotion& at_end) {
  find_forces(now_.step);
  const Vector3 of_particles = now_.scaling ? move_scaled(nullptr) : move_particles();
  const Vector3 momentum_before = now_.rod.momentum();
  now_.rod.prescribe(at_end.travel, at_end.velocity);
  check_momentum(momentum_before + of_particles);
  close_step(now_.rod.momentum() - momentum_before - now_.step * now_.bond.force);
}

void Finger::check_momentum(const Vector3& momentum) {
  if (now_.balance_started) {
    const double defect = (momentum - now_.expected_momentum).norm();
    if (!(defect <= now_.momentum_defect)) now_.momentum_defect = defect;  // keeps a NaN visible
  }
  now_.expected_momentum = momentum;
  now_.balance_started = true;
}

void Finger::start_step() {
  find_forces(0.0);
  check_momentum(linear_momentum(*model_, now_.state) + now_.rod.momentum());
}

void Finger::close_step(const Vector3& on_rod) {
  const Wrench impulse = std::visit(
      [&](auto& s) { return s.correct(now_.state, force_, now_.plane, now_.step); }, surfaces_);
  finish_step(now_.step, impulse, on_rod);
}

void Finger::finish_step(double duration, const Wrench& plane_impulse, const Vector3& on_rod) {
  notes_energy_ = false;
  now_.step = duration;
  now_.plane_impulse = plane_impulse;
  const Vector3 weight = now_.step * tip_mass_ * gravity_;
  now_.expected_momentum += on_rod + now_.plane_impulse.force + weight;
  now_.largest_impulse =
      std::max({now_.largest_impulse, on_rod.norm(), now_.plane_impulse.force.norm(), weight.norm(),
                now_.step * now_.bond.force.norm()});
  now_.plane = now_.plane.after(now_.step);
  now_.time += now_.step;
}

std::vector<meshes::ContactPoint> Finger::field_of(std::vector<TiedPoint> points) const {
  const Eigen::Matrix3d to_plane = field_axes(now_.plane.normal).transpose();
  for (TiedPoint& tied : points)
    for (Vector3* vector : tied.point.vectors()) *vector = to_plane * *vector;
  return contact::contact_field(points, model_->sector.count(), law_);
}

std::vector<meshes::ContactPoint> Finger::contact_now() const {
  std::vector<TiedPoint> points = tied_points();
  for (TiedPoint& tied : points) {
    Vector3 moved = Vector3::Zero();
    for (std::size_t c = 0; c < 8; ++c)
      moved += tied.weights[c] * now_.state.displacement.at(tied.particles[c]);
    tied.point.place = tied.point.rest + model_->grid.axes * moved;
  }
  std::vector<meshes::ContactPoint> field = field_of(std::move(points));
  const Eigen::Matrix3d from_plane = field_axes(now_.plane.normal);
  for (meshes::ContactPoint& point : field)
    for (Vector3* vector : point.vectors()) *vector = from_plane * *vector;
  return field;
}

double Finger::kinetic_energy() const {
  Team team = team_;  // a handle
  return lattice::kinetic_energy(*model_, now_.state, team);
}

double Finger::elastic_energy() const {
  Team team = team_;  // a handle
  return lattice::elastic_energy(*model_, now_.state, team) + branch_energy().stored +
         ask([&](const auto& s) { return s.energy(now_.state, now_.rod); });
}

}  // namespace fingertip::lattice::inline dynamics
