#include "lattice/finger.h"

#include <algorithm>

#include "lattice/energy.h"

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

constexpr std::size_t portion = 32;  // blocks per partial sum: the same for any thread count

}  // namespace

Finger::Finger(const LatticeModel& model, const RodBody& rod, const Plane& plane,
               meshes::ContactMode contact, Integrator integrator, double step, int threads)
    : model_(&model),
      team_(threads),
      internal_(model, team_),
      surfaces_(make_surfaces(model, plane, contact, team_)),
      move_(kernel::select_move()),
      integrator_(integrator),
      step_(step),
      state_(model),
      force_(model.points()),
      rod_(rod),
      partial_momentum_((model.blocks.size() + portion - 1) / portion) {}

void Finger::find_forces() {
  extremes_ = internal_.accumulate(state_, force_);
  bond_ = surfaces_->hold(state_, rod_, step_, force_);
}

void Finger::move_particles() {
  kernel::Motion motion{};
  for (std::size_t c = 0; c < 3; ++c) {
    motion.force[c] = force_.component[c].data();
    motion.displacement[c] = state_.displacement.component[c].data();
    motion.velocity[c] = state_.velocity.component[c].data();
  }
  motion.mass = model_->mass.data();
  motion.inverse_mass = model_->inverse_mass.data();
  motion.step = step_;
  motion.symplectic = integrator_ == Integrator::symplectic_euler;
  const auto& blocks = model_->blocks;
  team_.split(partial_momentum_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t last = std::min(blocks.size(), (p + 1) * portion);
      move_(motion, blocks.data(), p * portion, last, partial_momentum_[p].data());
    }
  });
}

void Finger::advance(const Wrench& applied) {
  find_forces();
  const Vector3 momentum_before = rod_.momentum();
  const Vector3 endpoint = rod_.endpoint();
  Wrench total = applied;
  total.force += bond_.force;
  total.torque += bond_.torque;
  if (integrator_ == Integrator::symplectic_euler) {
    rod_.kick(total, endpoint, step_);
    rod_.drift(step_);
  } else {
    rod_.drift(step_);
    rod_.kick({total.force, total.torque + (endpoint - rod_.endpoint()).cross(total.force)},
              rod_.endpoint(), step_);
  }
  move_particles();
  check_momentum(momentum_before);
  close_step(step_ * applied.force);
}

void Finger::advance(const RodMotion& at_end) {
  find_forces();
  const Vector3 momentum_before = rod_.momentum();
  rod_.prescribe(at_end.travel, at_end.velocity);
  move_particles();
  check_momentum(momentum_before);
  close_step(rod_.momentum() - momentum_before - step_ * bond_.force);
}

void Finger::check_momentum(const Vector3& rod_momentum) {
  Vector3 of_particles = Vector3::Zero();
  for (const Vector3& p : partial_momentum_) of_particles += p;
  const Vector3 momentum = rod_momentum + model_->grid.axes * of_particles;
  if (balance_started_) {
    const double defect = (momentum - expected_momentum_).norm();
    if (!(defect <= momentum_defect_)) momentum_defect_ = defect;  // keeps a NaN visible
  }
  expected_momentum_ = momentum;
  balance_started_ = true;
}

void Finger::close_step(const Vector3& applied_impulse) {
  plane_impulse_ = surfaces_->settle(state_, force_, step_);
  expected_momentum_ += applied_impulse + plane_impulse_;
  largest_impulse_ = std::max({largest_impulse_, applied_impulse.norm(), plane_impulse_.norm(),
                               step_ * bond_.force.norm()});
  time_ += step_;
}

double Finger::elastic_energy() const {
  return lattice::elastic_energy(*model_, state_) + surfaces_->energy(state_, rod_);
}

}  // namespace fingertip::lattice
