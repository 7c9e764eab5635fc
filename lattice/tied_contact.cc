#include "lattice/tied_contact.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lattice/cells/contact_patch.h"

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

constexpr double most_turns = 16.0;  // steps until every point has been looked at

}  // namespace

TiedContact::TiedContact(const LatticeModel& model, const Plane& plane, meshes::ContactMode mode)
    : model_(&model),
      plane_(plane),
      normal_(model.grid.axes.transpose() * plane.normal),
      stick_(mode == meshes::ContactMode::stick),
      margin_(0.5 * model.spacing()) {
  std::map<std::uint32_t, std::uint32_t> number;
  for (const TiedPoint& tie : model.outer) {
    for (const std::uint32_t corner : tie.corners) number.emplace(corner, 0);
  }
  for (auto& [particle, n] : number) {
    n = std::uint32_t(particles_.size());
    particles_.push_back(particle);
  }
  for (const TiedPoint& tie : model.outer) {
    Point point;
    for (std::size_t c = 0; c < 8; ++c) point.corners[c] = number.at(tie.corners[c]);
    point.rest_gap = plane.normal.dot(tie.rest - plane.point);
    point.gap = point.rest_gap;
    points_.push_back(point);
  }
  loads_.resize(particles_.size());
  bonded_.resize(particles_.size(), 0);
  loaded_.reserve(particles_.size());
  near_.reserve(points_.size());
  for (const TiedPoint& tie : model.bond) {
    for (const std::uint32_t corner : tie.corners) {
      const auto found = number.find(corner);
      if (found != number.end()) bonded_[found->second] = 1;
    }
  }
  look_around(State(model), 0.0, points_.size());
}

/// Points that have come near are looked at in every step from now on.
void TiedContact::look_around(const State& state, double ahead, std::size_t looks) {
  for (std::size_t n = 0; n < looks; ++n, ++next_look_) {
    if (next_look_ >= points_.size()) next_look_ = 0;
    Point& point = points_[next_look_];
    if (point.near) continue;
    const Vector3 moved = shift(model_->outer[next_look_], state, ahead);
    const double gap = point.rest_gap + normal_.dot(moved);
    if (gap < margin_) {
      // Where it was when last looked at tells look_at() where it crossed, had it come this fast.
      point.near = true;
      near_.push_back(std::uint32_t(next_look_));
    } else {
      point.shift = moved;
      point.gap = gap;
    }
  }
}

/// Brings gap and anchor of a near point up to date.
void TiedContact::look_at(std::size_t number, const State& state, double ahead) {
  Point& point = points_[number];
  const Vector3 moved = shift(model_->outer[number], state, ahead);
  const double gap = point.rest_gap + normal_.dot(moved);
  if (stick_ && !point.anchored && gap < 0.0) {
    const double before = std::max(point.gap, 0.0);
    const double fraction = before / (before - gap);
    point.anchor = (1.0 - fraction) * point.shift + fraction * moved;
    point.anchored = true;
  } else if (point.anchored && gap > 0.0) {
    point.anchored = false;
  }
  point.shift = moved;
  point.gap = gap;
}

/// Of the tie on the tip, along the grid's axes [N].
Vector3 TiedContact::pull(std::size_t number) const {
  const Point& point = points_[number];
  const double stiffness = model_->outer[number].stiffness;
  if (stick_) {
    return point.anchored ? Vector3(stiffness * (point.anchor - point.shift))
                          : Vector3(Vector3::Zero());
  }
  return -stiffness * std::min(point.gap, 0.0) * normal_;
}

void TiedContact::load(std::size_t number, const Vector3& pull) {
  const TiedPoint& tie = model_->outer[number];
  double weights = 0.0;
  for (const double w : tie.weights) weights += std::abs(w);
  for (std::size_t c = 0; c < 8; ++c) {
    const std::uint32_t particle = points_[number].corners[c];
    Load& load = loads_[particle];
    if (!load.loaded) loaded_.push_back(particle);
    load.loaded = true;
    load.force += tie.weights[c] * pull;
    load.stiffness += tie.stiffness * std::abs(tie.weights[c]) * weights;
  }
}

/// Passes the loads on to the particles; returns what the plane gives them altogether.
Vector3 TiedContact::unload(double step, VectorField& force, std::vector<SharedLoad>* shared) {
  const Eigen::Matrix3d shape = stick_ ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                                       : Eigen::Matrix3d(normal_ * normal_.transpose());
  Vector3 sum = Vector3::Zero();
  for (const std::uint32_t particle : loaded_) {
    const std::uint32_t i = particles_[particle];
    const Load& load = loads_[particle];
    const Vector3 others = force.at(i);
    Vector3 taken = others + load.force;
    if (shared != nullptr && bonded_[particle] != 0) {
      shared->push_back({i, load.stiffness * shape, Vector3::Zero()});
    } else {
      const double mass = model_->mass[i];
      const double share = mass / (mass + step * step * load.stiffness);
      taken -= (1.0 - share) * (shape * taken);
    }
    force.set(i, taken);
    sum += taken - others;
    loads_[particle] = Load{};
  }
  loaded_.clear();
  return model_->grid.axes * sum;
}

/// So many that every point has its turn before the fastest particle has come half the margin
/// nearer.
std::size_t TiedContact::looks_per_step(const State& state, double step) const {
  double closing = 0.0;
  for (const std::uint32_t i : particles_) {
    closing = std::max(closing, -normal_.dot(state.velocity.at(i)));
  }
  const double turns = std::clamp(0.5 * margin_ / (closing * step), 1.0, most_turns);
  return std::size_t(double(points_.size()) / std::floor(turns)) + 1;
}

Vector3 TiedContact::add(const State& state, double step, VectorField& force,
                         std::vector<SharedLoad>* shared) {
  look_around(state, step, looks_per_step(state, step));
  touching_ = 0;
  energy_ = 0.0;
  for (const std::uint32_t number : near_) {
    look_at(number, state, step);
    const Vector3 tie_pull = pull(number);
    points_[number].push = tie_pull.dot(normal_);
    if (tie_pull.isZero(0.0)) continue;
    ++touching_;
    energy_ += 0.5 * tie_pull.squaredNorm() / model_->outer[number].stiffness;
    load(number, tie_pull);
  }
  // Far again: released only when nothing acts.
  std::erase_if(near_, [this](std::uint32_t number) {
    Point& point = points_[number];
    point.near = point.anchored || point.gap < 2.0 * margin_;
    return !point.near;
  });
  return unload(step, force, shared);
}

double TiedContact::radius(const State& state) const {
  const Vector3 t1 = first_tangent(plane_.normal), t2 = t1.cross(plane_.normal);
  std::vector<LoadedPoint> loaded;
  for (const std::uint32_t number : near_) {
    const TiedPoint& tie = model_->outer[number];
    Vector3 place = tie.rest;
    if (model_->kinematics == Kinematics::finite) {
      place += model_->grid.axes * shift(tie, state, 0.0);
    }
    const double facing = std::abs(outer_normal(tie.rest).dot(plane_.normal));
    loaded.push_back({{place.dot(t1), place.dot(t2)}, points_[number].push, facing * tie.area});
  }
  return contact_patch(std::move(loaded), 1, model_->spacing()).radius;
}

std::vector<std::uint8_t> TiedContact::held() const {
  std::vector<std::uint8_t> touched(model_->points(), 0), result;
  for (const std::uint32_t number : near_) {
    if (!(points_[number].push > 0.0)) continue;
    for (const std::uint32_t corner : model_->outer[number].corners) touched[corner] = 1;
  }
  for (const std::uint32_t particle : model_->boundary) result.push_back(touched[particle]);
  return result;
}

}  // namespace fingertip::lattice
