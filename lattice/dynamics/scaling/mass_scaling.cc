#include "lattice/dynamics/scaling/mass_scaling.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

namespace fingertip::lattice::inline dynamics::inline scaling {

using meshes::Vector3;

namespace {

Vector3 vector_at(const MultigridFields::Field& field, std::size_t point) {
  return {field[0][point], field[1][point], field[2][point]};
}

/// Along the plane's normal [kg].
double along_normal(const ContactInertia& tie, const PlaneHold& plane) {
  return plane.normal.dot(tie.inertia * plane.normal);
}

/// Whether what was found for one sum serves for another. Less is held than then: too much is kept,
/// which is safe.
bool serves(double then, double now) {
  return now <= 1.1 * then && now >= 0.8 * then;
}

bool serves(const Restraint::Ground& then, const Restraint::Ground& now, double spacing) {
  constexpr double turned = 0.99;  // cosine
  return serves(then.along, now.along) && serves(then.tangential, now.tangential) &&
         serves(then.edges, now.edges) && (then.patch - now.patch).norm() < spacing &&
         then.normal.dot(now.normal) > turned;
}

/// Keeps the other directions as near to what they were as a normal lets them.
void turn(Restraint& restraint, const Vector3& normal) {
  auto& [along, across, beside] = restraint.directions;
  along = normal;
  across = (across - normal.dot(across) * normal).normalized();
  beside = normal.cross(across);
}

/// The part of `follows` along a direction, from 0 to 1.
void take_share(const Vector3& direction, const MultigridFields::Field& follows,
                std::vector<Single>& share) {
  const auto count = Eigen::Index(share.size());
  const auto part = [&](std::size_t c) {
    return Single(direction[Eigen::Index(c)]) *
           Eigen::Map<const Eigen::ArrayXf>(follows[c].data(), count);
  };
  Eigen::Map<Eigen::ArrayXf>(share.data(), count) =
      (part(0) + part(1) + part(2)).max(0.0F).min(1.0F);
}

}  // namespace

ScalingGround::ScalingGround(const LatticeModel& lattice)
    : model(&lattice),
      hierarchy(std::make_shared<GridHierarchy>(lattice)),
      rubber(lattice),
      rule(lattice) {}

MassScaling::MassScaling(std::shared_ptr<ScalingGround> ground)
    : ground_(std::move(ground)),
      inertia_(ground_->model->mass),
      gain_(ground_->model->is_particle.begin(), ground_->model->is_particle.end()),
      grids_(ground_->hierarchy) {
  bonded_.reserve(ground_->model->particles.size());
}

void MassScaling::make(const State& state, std::span<const BondInertia> bond, double step,
                       Team& team, double allowance) {
  const LatticeModel& model = *ground_->model;
  for (const std::uint32_t p : bonded_) {
    inertia_[p] = model.mass[p];
    gain_[p] = 1.0;
  }
  bonded_.clear();
  for (const BondInertia& tie : bond) {
    inertia_[tie.particle] += tie.inertia;
    bonded_.push_back(tie.particle);
  }
  for (const std::uint32_t p : bonded_) gain_[p] = inertia_[p] * model.inverse_mass[p];
  step_ = step;
  sum_of_edges_ = ground_->rule.find(state, step, allowance, team, grids_.finest_edges());
  grids_.set(inertia_, team);
}

AccelerationFields MassScaling::fields() const {
  return {MultigridFields(*ground_->hierarchy), ground_->rubber.scratch()};
}

Restraint MassScaling::restraint() const {
  Restraint none;
  for (auto& share : none.share) share.assign(inertia_.size(), 0.0F);
  return none;
}

void MassScaling::set_contact(const PlaneHold& plane, MultigridFields::Level& finest) const {
  finest.contact.clear();
  for (const ContactInertia& tie : plane.ties)
    finest.contact.push_back({tie.particle, tie.inertia.cast<Single>()});
}

void MassScaling::restrain(const State& state, const PlaneHold& plane, Team& team,
                           AccelerationFields& fields, Restraint& restraint) const {
  Restraint::Ground now;
  for (const ContactInertia& tie : plane.ties) {
    const double along = along_normal(tie, plane);
    now.along += along;
    now.tangential += 0.5 * (tie.inertia.trace() - along);
    now.patch += along * tie.rest;
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
  turn(restraint, now.normal);
  find_inertia(state, plane, restraint);
}

/// B C of unit accelerations along the normal and both ways across it: all at the same time where
/// they are the grid's axes and ties those of a plane, for then neither these nor S couple them.
void MassScaling::find_shares(const PlaneHold& plane, Team& team, AccelerationFields& fields,
                              Restraint& restraint) const {
  MultigridFields::Level& finest = fields.grids.levels.front();
  Eigen::Index axis = 0;
  plane.normal.cwiseAbs().minCoeff(&axis);
  restraint.directions[1] = Vector3::Unit(axis);
  turn(restraint, plane.normal);
  const Vector3& normal = restraint.directions[0];
  set_contact(plane, finest);
  const bool uncoupled = normal.cwiseAbs().maxCoeff() > 1.0 - 1e-6 &&
                         std::ranges::all_of(plane.ties, [](const ContactInertia& tie) {
                           const auto others = [](const Eigen::Matrix3d& m) {
                             return std::abs(m(0, 1)) + std::abs(m(0, 2)) + std::abs(m(1, 2));
                           };
                           return others(tie.inertia) <= 1e-6 * tie.inertia.trace();
                         });
  for (std::size_t first = 0; first < 3; first += uncoupled ? 3 : 1) {
    const std::size_t last = uncoupled ? 3 : first + 1;
    for (auto& component : finest.load) std::fill(component.begin(), component.end(), 0.0F);
    for (const ContactInertia& tie : plane.ties) {
      Vector3 taken = Vector3::Zero();
      for (std::size_t n = first; n < last; ++n) taken += tie.inertia * restraint.directions[n];
      for (std::size_t c = 0; c < 3; ++c)
        finest.load[c][tie.particle] = Single(taken[Eigen::Index(c)]);
    }
    grids_.solve(team, fields.grids);
    for (std::size_t n = first; n < last; ++n)
      take_share(restraint.directions[n], finest.solution, restraint.share[n]);
  }
}

/// Finds the patch's centre, and what the rod feels: the patch as a whole by what Y leaves of C,
/// and turned about its centre by C.
void MassScaling::find_inertia(const State& state, const PlaneHold& plane,
                               Restraint& restraint) const {
  Eigen::Matrix3d along, left = Eigen::Matrix3d::Zero(), turned = left;
  for (std::size_t n = 0; n < 3; ++n) along.col(Eigen::Index(n)) = restraint.directions[n];
  restraint.centre.setZero();
  double sum = 0.0;
  for (const ContactInertia& tie : plane.ties) {
    // Of ties that couple the directions what is as far from each of both.
    Vector3 kept;
    for (std::size_t n = 0; n < 3; ++n)
      kept[Eigen::Index(n)] = std::sqrt(1.0 - double(restraint.share[n][tie.particle]));
    left += kept.asDiagonal() * (along.transpose() * tie.inertia * along) * kept.asDiagonal();
    const double weight = along_normal(tie, plane);
    restraint.centre += weight * (tie.rest + state.displacement.at(tie.particle));
    sum += weight;
  }
  restraint.centre /= sum;
  const Eigen::Matrix<double, 3, 6> shifted = along.transpose() * rigid_motion(restraint.centre);
  restraint.inertia = shifted.transpose() * left * shifted;
  for (const ContactInertia& tie : plane.ties) {
    const Vector3 arm = tie.rest + state.displacement.at(tie.particle) - restraint.centre;
    Eigen::Matrix3d cross;  // w x arm = crossᵀ w
    cross << 0.0, -arm.z(), arm.y(), arm.z(), 0.0, -arm.x(), -arm.y(), arm.x(), 0.0;
    turned += cross * tie.inertia * cross.transpose();
  }
  restraint.inertia.bottomRightCorner<3, 3>() += turned;
  restraint.inertia = ground_->model->sector.whole_on_grid(restraint.inertia);
}

/// The forces as they are, D a, in the frame of a rod that accelerates as expected.
void MassScaling::set_load(const Vector6& expected, const State& state, const VectorField& force,
                           const PlaneHold& plane, Team& team,
                           MultigridFields::Level& finest) const {
  const LatticeModel& model = *ground_->model;
  ground_->rubber.load(expected, gain_, state, team, force, finest.load);
  set_contact(plane, finest);
  for (const ContactInertia& tie : plane.ties) {
    const Vector3 more = tie.inertia * (model.inverse_mass[tie.particle] * force.at(tie.particle));
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
  grids_.solve(team, fields.grids);

  Vector6 taken = Vector6::Zero();
  for (const ContactInertia& tie : outer.plane.ties) {
    const std::size_t i = tie.particle;
    const Vector3 change = vector_at(finest.solution, i) - inverse_mass[i] * force.at(i);
    taken += acting_at(tie.rest + state.displacement.at(i), tie.inertia * change);
  }
  Reactions reactions;
  reactions.plane << outer.plane.wrench.force, outer.plane.wrench.torque;
  reactions.plane -= ground_->model->sector.whole_on_grid(taken);
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
  return ground_->rubber.move(reactions.rod, restraint, fields.grids.levels.front().solution, step_,
                              team, fields.carried, state);
}

}  // namespace fingertip::lattice::inline dynamics::inline scaling
