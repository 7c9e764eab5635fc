#include "lattice/contact.h"

#include <algorithm>
#include <cmath>

namespace fingertip::lattice {

using meshes::Vector3;

PlaneContact::PlaneContact(const LatticeModel& model, const Plane& plane, meshes::ContactMode mode)
    : model_(&model), normal_(plane.normal), mode_(mode) {
  candidates_.reserve(model.boundary.size());
  for (const std::uint32_t particle : model.boundary) {
    const Vector3 rest = model.rest_position(particle);
    Candidate c;
    c.particle = particle;
    c.rest_gap = normal_.dot(rest - plane.point);
    c.lateral = (rest - normal_ * normal_.dot(rest)).norm();
    candidates_.push_back(c);
  }
}

double PlaneContact::gap(const Candidate& c, const Vector3& displacement) const {
  return c.rest_gap + normal_.dot(displacement);
}

double PlaneContact::radius() const {
  double largest = 0.0;
  for (const Candidate& c : candidates_) {
    if (c.held) largest = std::max(largest, c.lateral);
  }
  return largest;
}

Vector3 PlaneContact::resolve(State& state, const VectorField& force, double step) {
  Vector3 impulse = Vector3::Zero();
  for (Candidate& c : candidates_) {
    if (c.held) {
      impulse += hold(c, state, force, step);
    } else if (gap(c, state.displacement.at(c.particle)) < 0.0) {
      impulse += touch(c, state);
    } else {
      c.displacement = state.displacement.at(c.particle);
    }
  }
  return impulse;
}

Vector3 PlaneContact::hold(Candidate& c, State& state, const VectorField& force, double step) {
  const Vector3 reaction = -force.at(c.particle);
  if (mode_ == meshes::ContactMode::stick) {
    state.displacement.set(c.particle, c.displacement);
    state.velocity.set(c.particle, Vector3::Zero());
    return step * reaction;
  }
  const Vector3 moved = state.displacement.at(c.particle);
  if (normal_.dot(reaction) < 0.0) {  // the plane does not pull
    c.held = false;
    c.displacement = moved;
    --anchored_;
    return Vector3::Zero();
  }
  const Vector3 velocity = state.velocity.at(c.particle);
  c.displacement = moved - normal_ * gap(c, moved);
  state.displacement.set(c.particle, c.displacement);
  state.velocity.set(c.particle, velocity - normal_ * normal_.dot(velocity));
  return step * normal_.dot(reaction) * normal_;
}

Vector3 PlaneContact::touch(Candidate& c, State& state) {
  const Vector3 moved = state.displacement.at(c.particle);
  const Vector3 velocity = state.velocity.at(c.particle);
  const double before = std::max(gap(c, c.displacement), 0.0), after = gap(c, moved);
  const double fraction = std::clamp(before / (before - after), 0.0, 1.0);
  const Vector3 crossing = c.displacement + fraction * (moved - c.displacement);
  c.held = true;
  ++anchored_;
  if (mode_ == meshes::ContactMode::stick) {
    c.displacement = crossing;
    state.displacement.set(c.particle, c.displacement);
    state.velocity.set(c.particle, Vector3::Zero());
    return -model_->mass[c.particle] * velocity;
  }
  c.displacement = moved - normal_ * after;
  state.displacement.set(c.particle, c.displacement);
  const Vector3 stopped = normal_ * normal_.dot(velocity);
  state.velocity.set(c.particle, velocity - stopped);
  return -model_->mass[c.particle] * stopped;
}

}  // namespace fingertip::lattice
