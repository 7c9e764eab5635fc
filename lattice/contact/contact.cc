#include "lattice/contact/contact.h"

#include <algorithm>
#include <cmath>

namespace fingertip::lattice::inline contact {

using meshes::ContactMode;
using meshes::Vector3;

PlaneContact::PlaneContact(const LatticeModel& model, const Plane& plane, const ContactLaw& law)
    : model_(&model), plane_(plane), law_(law) {
  candidates_.reserve(model.boundary.size());
  for (const std::uint32_t particle : model.boundary) {
    Candidate c;
    c.particle = particle;
    c.rest = model.rest_position(particle);
    c.images = int(model.sector.count() * model.sector.share(model.place(particle)));
    candidates_.push_back(c);
  }
}

/// Of a particle, in world axes.
Vector3 PlaneContact::world(const VectorField& field, std::size_t particle) const {
  return model_->grid.axes * field.at(particle);
}

Vector3 PlaneContact::place(const Candidate& c, const Vector3& displacement) const {
  return c.rest + displacement;
}

double PlaneContact::radius() const {
  const Vector3& normal = plane_.normal;
  double largest = 0.0;
  for (const Candidate& c : candidates_) {
    if (c.held) largest = std::max(largest, (c.rest - normal * normal.dot(c.rest)).norm());
  }
  return largest;
}

Wrench PlaneContact::resolve(State& state, const VectorField& force, const Plane& plane,
                             double step) {
  const Sweep sweep{plane, plane.after(step), step};
  plane_ = sweep.end;
  sliding_ = 0;
  Wrench sum;
  for (Candidate& c : candidates_) {
    Wrench impulse;
    if (c.held) {
      impulse = hold(c, state, force, sweep);
    } else if (sweep.end.gap(place(c, world(state.displacement, c.particle))) < 0.0) {
      impulse = touch(c, state, sweep);
    } else {
      c.displacement = world(state.displacement, c.particle);
      continue;
    }
    sum.force += impulse.force;
    sum.torque += impulse.torque;
  }
  return sum;
}

/// What the plane gives of the impulse [N s] with which a particle would stick; whether that is
/// all.
bool PlaneContact::gives(Candidate& c, const Vector3& sticking, const Vector3& normal,
                         Vector3& given) {
  c.sliding = false;
  given = sticking;
  if (law_.mode == ContactMode::stick) return true;
  const double push = std::max(normal.dot(sticking), 0.0);
  const Vector3 tangential = sticking - push * normal;
  given = push * normal;
  if (law_.mode == ContactMode::frictionless) return false;
  const double limit = law_.friction * push, needed = tangential.norm();
  c.sliding = needed > limit;
  if (c.sliding) sliding_ += c.images;
  given += c.sliding ? Vector3(limit / needed * tangential) : tangential;
  return !c.sliding;
}

void PlaneContact::set_state(Candidate& c, State& state, const Vector3& displacement,
                             const Vector3& velocity) {
  const Eigen::Matrix3d to_grid = model_->grid.axes.transpose();
  state.displacement.set(c.particle, to_grid * displacement);
  state.velocity.set(c.particle, to_grid * velocity);
  c.displacement = displacement;
  c.velocity = velocity;
}

Wrench PlaneContact::hold(Candidate& c, State& state, const VectorField& force,
                          const Sweep& sweep) {
  const double mass = model_->mass[c.particle];
  const Vector3 start = place(c, c.displacement), normal = sweep.end.normal_at(start);
  const Vector3 fixed = sweep.start.fixed(start);
  const Vector3 carried = sweep.end.place(fixed) - sweep.start.place(fixed);
  const Vector3 with_plane = carried / sweep.step;
  const Vector3 sticking = mass * (with_plane - c.velocity) - sweep.step * world(force, c.particle);
  if (law_.mode != ContactMode::stick && normal.dot(sticking) < 0.0) {  // the plane does not pull
    c.held = c.sliding = false;
    c.displacement = world(state.displacement, c.particle);
    anchored_ -= c.images;
    return {};
  }
  Vector3 given;
  if (gives(c, sticking, normal, given)) {
    set_state(c, state, c.displacement + carried, with_plane);
    return {given, start.cross(given)};
  }
  Vector3 moved = world(state.displacement, c.particle) + sweep.step / mass * given;
  const Vector3 back = -sweep.end.gap(place(c, moved)) * normal;  // on what turns or is curved
  moved += back;
  given += mass / sweep.step * back;
  set_state(c, state, moved, world(state.velocity, c.particle) + given / mass);
  return {given, start.cross(given)};
}

Wrench PlaneContact::touch(Candidate& c, State& state, const Sweep& sweep) {
  const double mass = model_->mass[c.particle];
  const Vector3 moved = world(state.displacement, c.particle),
                velocity = world(state.velocity, c.particle);
  const double before = std::max(sweep.start.gap(place(c, c.displacement)), 0.0);
  const double after = sweep.end.gap(place(c, moved));
  const double fraction = std::clamp(before / (before - after), 0.0, 1.0);
  const Vector3 crossing = c.displacement + fraction * (moved - c.displacement);
  const double left = (1.0 - fraction) * sweep.step;
  const Vector3 at = place(c, crossing);
  const Vector3 sticking = mass * (sweep.end.velocity_at(at) - velocity);
  Vector3 given;
  gives(c, sticking, sweep.end.normal_at(at), given);
  c.held = true;
  anchored_ += c.images;
  const Vector3 stopped = velocity + given / mass;
  set_state(c, state, crossing + left * stopped, stopped);
  return {given, at.cross(given)};
}

}  // namespace fingertip::lattice::inline contact
