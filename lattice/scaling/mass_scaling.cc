#include "lattice/scaling/mass_scaling.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

Vector3 at(const MultigridFields::Field& field, std::size_t point) {
  return {field[0][point], field[1][point], field[2][point]};
}

/// Whether what was found for one sum serves for another. Less is held than then: too much is kept,
/// which is safe.
bool serves(double then, double now) {
  return now <= 1.1 * then && now >= 0.8 * then;
}

bool serves(const Restraint::Ground& then, const Restraint::Ground& now, double spacing) {
  constexpr double turned = 0.99;  // cosine
  return serves(then.along, now.along) && serves(then.aside, now.aside) &&
         serves(then.edges, now.edges) && (then.patch - now.patch).norm() < spacing &&
         then.normal.dot(now.normal) > turned;
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
    : ground_(std::move(ground)),
      inertia_(ground_->model->mass),
      gain_(inertia_.size(), 0.0),
      grids_(ground_->hierarchy) {}

void MassScaling::make(const State& state, std::span<const BondInertia> bond, double step,
                       Team& team, double room) {
  inertia_ = ground_->model->mass;
  for (const BondInertia& tie : bond) inertia_[tie.particle] += tie.inertia;
  for (std::size_t p = 0; p < gain_.size(); ++p)
    gain_[p] = inertia_[p] * ground_->model->inverse_mass[p];
  step_ = step;
  sum_of_edges_ = ground_->rule.find(state, step, room, team, ground_->edges);
  grids_.set(ground_->edges, inertia_);
}

AccelerationFields MassScaling::fields() const {
  return {MultigridFields(*ground_->hierarchy), ground_->rubber.scratch()};
}

Restraint MassScaling::restraint() const {
  Restraint none;
  none.along.assign(inertia_.size(), 0.0F);
  none.aside.assign(inertia_.size(), 0.0F);
  return none;
}

void MassScaling::set_contact(const PlaneHold& plane, MultigridFields::Level& finest) const {
  finest.contact.clear();
  for (const ContactInertia& tie : plane.ties)
    finest.contact.push_back({tie.particle, Single(tie.along), Single(tie.aside)});
}

void MassScaling::restrain(const State& state, const PlaneHold& plane, Team& team,
                           AccelerationFields& fields, Restraint& restraint) const {
  Restraint::Ground now;
  for (const ContactInertia& tie : plane.ties) {
    now.along += tie.along;
    now.aside += tie.aside;
    now.patch += tie.along * ground_->model->rest_position(tie.particle);
  }
  restraint.holds = now.along > 0.0;
  if (!restraint.holds) return;
  now.patch /= now.along;
  now.normal = plane.normal;
  now.edges = sum_of_edges_;
  if (!serves(restraint.found, now, ground_->model->spacing())) {
    find_shares(plane, team, fields, restraint);
    restraint.found = now;
  }
  find_inertia(state, plane, restraint);
}

/// B C of unit accelerations along the normal and, at the same time, across it: the plane's ties
/// are what couples directions, and not these two.
void MassScaling::find_shares(const PlaneHold& plane, Team& team, AccelerationFields& fields,
                              Restraint& restraint) const {
  MultigridFields::Level& finest = fields.grids.levels.front();
  const Vector3 normal = plane.normal, across = normal.unitOrthogonal();
  set_contact(plane, finest);
  for (auto& component : finest.load) std::fill(component.begin(), component.end(), 0.0F);
  for (const ContactInertia& tie : plane.ties) {
    const Vector3 taken = tie.along * normal + tie.aside * across;
    for (std::size_t c = 0; c < 3; ++c)
      finest.load[c][tie.particle] = Single(taken[Eigen::Index(c)]);
  }
  grids_.solve(normal, team, fields.grids);
  for (const std::uint32_t p : ground_->model->particles) {
    const Vector3 follows = at(finest.solution, p);
    restraint.along[p] = Single(std::clamp(normal.dot(follows), 0.0, 1.0));
    restraint.aside[p] = Single(std::clamp(across.dot(follows), 0.0, 1.0));
  }
}

/// Finds the patch's centre, and what the rod feels: the patch as a whole by what Y leaves of C,
/// and turned about its centre by C.
void MassScaling::find_inertia(const State& state, const PlaneHold& plane,
                               Restraint& restraint) const {
  const Eigen::Matrix3d along = plane.normal * plane.normal.transpose(),
                        aside = Eigen::Matrix3d::Identity() - along;
  Eigen::Matrix3d whole = Eigen::Matrix3d::Zero();
  restraint.centre.setZero();
  double sum = 0.0;
  for (const ContactInertia& tie : plane.ties) {
    whole += tie.along * (1.0 - double(restraint.along[tie.particle])) * along +
             tie.aside * (1.0 - double(restraint.aside[tie.particle])) * aside;
    restraint.centre += tie.along * ground_->rubber.position(tie.particle, state);
    sum += tie.along;
  }
  restraint.centre /= sum;
  const Eigen::Matrix<double, 3, 6> shifted = rigid_motion(restraint.centre);
  restraint.inertia = shifted.transpose() * whole * shifted;
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  for (const ContactInertia& tie : plane.ties) {
    const Vector3 arm = ground_->rubber.position(tie.particle, state) - restraint.centre,
                  tilt = arm.cross(plane.normal);  // the normal part of w x arm is w . tilt
    turned += tie.aside * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
    turned += (tie.along - tie.aside) * tilt * tilt.transpose();
  }
  restraint.inertia.bottomRightCorner<3, 3>() += turned;
}

/// The forces as they are, D a, in the frame of a rod that accelerates as expected.
void MassScaling::set_load(const Vector6& expected, const State& state, const VectorField& force,
                           const PlaneHold& plane, Team& team,
                           MultigridFields::Level& finest) const {
  const LatticeModel& model = *ground_->model;
  ground_->rubber.load(expected, gain_, state, team, force, finest.load);
  set_contact(plane, finest);
  for (const ContactInertia& tie : plane.ties) {
    const Vector3 more =
        plane.taken(tie, model.inverse_mass[tie.particle] * force.at(tie.particle));
    for (std::size_t c = 0; c < 3; ++c)
      finest.load[c][tie.particle] += Single(more[Eigen::Index(c)]);
  }
}

Reactions MassScaling::accelerate(const State& state, const OuterLoads& outer,
                                  const VectorField& force, Team& team,
                                  AccelerationFields& fields) const {
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
  reactions.bond = on_rubber;
  if (!outer.rod) return reactions;
  const Restraint* restraint = outer.rod->restraint;
  const Matrix6 held =
                    restraint && restraint->holds ? restraint->inertia : Matrix6(Matrix6::Zero()),
                carried = sums.inertia + held, whole = outer.rod->inertia + carried;
  reactions.rod = whole.ldlt().solve(outer.rod->load + on_rubber);
  reactions.bond -= carried * reactions.rod;
  reactions.plane -= held * reactions.rod;
  return reactions;
}

CarriedRubber::Moved MassScaling::move(State& state, const OuterLoads& outer,
                                       const Reactions& reactions, Team& team,
                                       AccelerationFields& fields) const {
  const Restraint* restraint = outer.rod ? outer.rod->restraint : nullptr;
  if (restraint && !restraint->holds) restraint = nullptr;
  return ground_->rubber.move(reactions.rod, restraint, outer.plane.normal,
                              fields.grids.levels.front().solution, step_, team, fields.carried,
                              state);
}

}  // namespace fingertip::lattice
