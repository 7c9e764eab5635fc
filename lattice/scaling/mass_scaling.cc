#include "lattice/scaling/mass_scaling.h"

#include <Eigen/Cholesky>
#include <utility>

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

Vector3 at(const MultigridFields::Field& field, std::size_t point) {
  return {field[0][point], field[1][point], field[2][point]};
}

}  // namespace

ScalingGround::ScalingGround(const LatticeModel& lattice)
    : model(&lattice),
      hierarchy(std::make_shared<GridHierarchy>(lattice)),
      rubber(lattice),
      rule(lattice) {
  for (auto& edge : edges) edge.assign(lattice.points(), 0.0);
}

MassScaling::MassScaling(std::shared_ptr<ScalingGround> ground)
    : ground_(std::move(ground)), inertia_(ground_->model->mass), grids_(ground_->hierarchy) {}

void MassScaling::make(const State& state, std::span<const BondInertia> bond, double step,
                       Team& team, double room) {
  inertia_ = ground_->model->mass;
  for (const BondInertia& tie : bond) inertia_[tie.particle] += tie.inertia;
  ground_->rule.find(state, step, room, team, ground_->edges);
  grids_.set(ground_->edges, inertia_);
}

AccelerationFields MassScaling::fields() const {
  return {MultigridFields(*ground_->hierarchy), ground_->rubber.scratch()};
}

/// The forces as they are, D a, in the frame of a rod that accelerates as expected.
void MassScaling::set_load(const Vector6& expected, const State& state, const VectorField& force,
                           const PlaneHold& plane, Team& team,
                           MultigridFields::Level& finest) const {
  const LatticeModel& model = *ground_->model;
  ground_->rubber.load(expected, inertia_, state, team, force, finest.load);
  finest.contact.clear();
  for (const ContactInertia& tie : plane.ties) {
    finest.contact.push_back({tie.particle, Grain(tie.along), Grain(tie.aside)});
    const Vector3 more =
        plane.taken(tie, model.inverse_mass[tie.particle] * force.at(tie.particle));
    for (std::size_t c = 0; c < 3; ++c)
      finest.load[c][tie.particle] += Grain(more[Eigen::Index(c)]);
  }
}

Reactions MassScaling::accelerate(const State& state, const OuterLoads& outer, Team& team,
                                  AccelerationFields& fields, VectorField& force) const {
  const CarriedRubber& rubber = ground_->rubber;
  const std::vector<double>& inverse_mass = ground_->model->inverse_mass;
  MultigridFields::Level& finest = fields.grids.levels.front();
  const Vector6 expected = outer.rod ? outer.rod->expected : Vector6(Vector6::Zero());
  set_load(expected, state, force, outer.plane, team, finest);
  grids_.solve(outer.plane.normal, team, fields.grids);

  Reactions reactions;
  reactions.plane << outer.plane.wrench.force, outer.plane.wrench.torque;
  for (const ContactInertia& tie : outer.plane.ties) {
    const std::size_t i = tie.particle;
    const Vector3 change = at(finest.solution, i) - inverse_mass[i] * force.at(i);
    reactions.plane -= acting_at(rubber.position(i, state), outer.plane.taken(tie, change));
  }
  const CarriedRubber::Sums sums = rubber.sums(finest.solution, state, team, fields.carried);
  const Vector6 on_rubber =
      reactions.plane - sums.taken + sums.inertia.leftCols<3>() * outer.gravity;
  if (outer.rod) {
    const Matrix6 whole = outer.rod->inertia + sums.inertia;
    reactions.rod = whole.ldlt().solve(outer.rod->load + on_rubber);
  }
  rubber.accelerate(reactions.rod, finest.solution, state, team, force);
  reactions.bond = on_rubber - sums.inertia * reactions.rod;
  return reactions;
}

}  // namespace fingertip::lattice
