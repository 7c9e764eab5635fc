#include "lattice/tied_contact.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lattice/cells/contact_patch.h"

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

constexpr double most_turns = 16.0;  // steps until every point has been looked at

/// Of a moving plane toward any point of the tip [m/s].
double fastest_approach(const Plane& plane, const LatticeModel& model) {
  double fastest = 0.0;
  for (const TiedPoint& tie : model.outer) {
    fastest = std::max(fastest, plane.normal.dot(plane.velocity_at(tie.rest)));
  }
  return fastest;
}

/// The part of a tie `stretch` in the plane, not longer than `longest`; its share of what it was.
struct Clipped {
  Vector3 aside;
  double share = 1.0;
};
Clipped clip(const Vector3& stretch, const Vector3& normal, double longest) {
  Clipped result{stretch - stretch.dot(normal) * normal};
  const double length = result.aside.norm();
  if (length > longest) {
    result.share = longest / length;
    result.aside *= result.share;
  }
  return result;
}

/// The normal in the axes of Plane::fixed; the same at any time.
Vector3 fixed_normal(const Plane& plane) {
  return plane.turned.conjugate() * plane.normal;
}

}  // namespace

TiedContact::TiedContact(const LatticeModel& model, const Plane& plane, const ContactLaw& law)
    : model_(&model), plane_(plane), law_(law), margin_(0.5 * model.spacing()) {
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
    point.place = plane.fixed(tie.rest);
    point.gap = plane.gap(tie.rest);
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

/// Where a point of the surface will be [m].
Vector3 TiedContact::place_of(std::size_t number, const State& state, double ahead) const {
  const TiedPoint& tie = model_->outer[number];
  return tie.rest + model_->grid.axes * shift(tie, state, ahead);
}

/// Points that have come near are looked at in every step from now on.
void TiedContact::look_around(const State& state, double ahead, std::size_t looks) {
  for (std::size_t n = 0; n < looks; ++n, ++next_look_) {
    if (next_look_ >= points_.size()) next_look_ = 0;
    Point& point = points_[next_look_];
    if (point.near) continue;
    const Vector3 place = place_of(next_look_, state, ahead);
    const double gap = plane_.gap(place);
    if (gap < margin_) {
      // Where it was when last looked at tells look_at() where it crossed, had it come this fast.
      point.near = true;
      near_.push_back(std::uint32_t(next_look_));
    } else {
      point.place = plane_.fixed(place);
      point.gap = gap;
    }
  }
}

/// Brings gap and anchor of a near point up to date.
void TiedContact::look_at(std::size_t number, const State& state, double ahead) {
  Point& point = points_[number];
  const Vector3 world = place_of(number, state, ahead);
  const Vector3 place = plane_.fixed(world);
  const double gap = plane_.gap(world);
  if (law_.mode != meshes::ContactMode::frictionless && !point.anchored && gap < 0.0) {
    const double before = std::max(point.gap, 0.0);
    const double fraction = before / (before - gap);
    point.anchor = (1.0 - fraction) * point.place + fraction * place;
    point.anchored = true;
  } else if (point.anchored && gap > 0.0) {
    point.anchored = point.sliding = false;
  }
  point.place = place;
  point.gap = gap;
}

/// Brings the anchor of a tie to where slip has left it by `now`, the start of a step.
void TiedContact::drag_anchor(std::size_t number, const State& state, const Plane& now) {
  Point& point = points_[number];
  point.sliding = false;
  const Vector3 world = place_of(number, state, 0.0), normal = fixed_normal(now);
  const double depth = -now.gap(world);
  if (!(depth > 0.0)) return;  // not yet there: anchored where it will be
  const Vector3 place = now.fixed(world), stretch = point.anchor - place;
  const Clipped kept = clip(stretch, normal, law_.friction * depth);
  if (kept.share >= 1.0) return;
  point.anchor = place + stretch.dot(normal) * normal + kept.aside;
  point.sliding = true;
}

TiedContact::Pull TiedContact::pull(std::size_t number) const {
  const Point& point = points_[number];
  const double stiffness = model_->outer[number].stiffness;
  const Eigen::Matrix3d to_grid = model_->grid.axes.transpose();
  if (law_.mode == meshes::ContactMode::frictionless) {
    return {-stiffness * std::min(point.gap, 0.0) * (to_grid * plane_.normal), 0.0};
  }
  if (!point.anchored) return {};
  Vector3 stretch = point.anchor - point.place;
  double share = 1.0;
  if (law_.mode == meshes::ContactMode::coulomb) {
    const Vector3 normal = fixed_normal(plane_);
    const double depth = std::max(-point.gap, 0.0);
    const Clipped kept = clip(stretch, normal, law_.friction * depth);
    share = kept.share;
    if (share < 1.0) stretch = depth * normal + kept.aside;
  }
  return {stiffness * (to_grid * (plane_.turned * stretch)), share};
}

void TiedContact::load(std::size_t number, const Pull& pull) {
  const TiedPoint& tie = model_->outer[number];
  double weights = 0.0;
  for (const double w : tie.weights) weights += std::abs(w);
  for (std::size_t c = 0; c < 8; ++c) {
    const std::uint32_t particle = points_[number].corners[c];
    Load& load = loads_[particle];
    if (!load.loaded) loaded_.push_back(particle);
    load.loaded = true;
    load.force += tie.weights[c] * pull.force;
    const double stiffness = tie.stiffness * std::abs(tie.weights[c]) * weights;
    load.stiffness += stiffness;
    load.aside += pull.aside * stiffness;
  }
}

/// Passes the loads on to the particles; returns what the plane gives them altogether.
Wrench TiedContact::unload(const State& state, double step, VectorField& force,
                           std::vector<SharedLoad>* shared) {
  const Vector3 normal = model_->grid.axes.transpose() * plane_.normal;
  const Eigen::Matrix3d along = normal * normal.transpose();
  const Eigen::Matrix3d aside = Eigen::Matrix3d::Identity() - along;
  Wrench sum;
  held_.clear();
  for (const std::uint32_t particle : loaded_) {
    const std::uint32_t i = particles_[particle];
    const Load& load = loads_[particle];
    const Vector3 others = force.at(i);
    Vector3 taken = others + load.force;
    if (shared != nullptr && bonded_[particle] != 0) {
      shared->push_back({i, load.stiffness * along + load.aside * aside, Vector3::Zero()});
    } else {
      const double heavy = step * step * load.stiffness, heavy_aside = step * step * load.aside;
      const double mass = model_->mass[i];
      taken = mass / (mass + heavy) * (along * taken).eval() +
              mass / (mass + heavy_aside) * (aside * taken).eval();
    }
    force.set(i, taken);
    const Vector3 given = model_->grid.axes * (taken - others);
    sum.force += given;
    sum.torque += position(*model_, state, i).cross(given);
    held_.push_back({particle, load.stiffness, load.aside});
    loads_[particle] = Load{};
  }
  loaded_.clear();
  return sum;
}

void TiedContact::add_inertia(double step, std::vector<TieInertia>& ties) const {
  const auto of_bond = std::ptrdiff_t(ties.size());
  const Vector3 normal = model_->grid.axes.transpose() * plane_.normal;
  const Eigen::Matrix3d along = normal * normal.transpose();
  for (const Held& held : held_) {
    const std::uint32_t i = particles_[held.particle];
    const Eigen::Matrix3d inertia =
        step * step * (held.stiffness * along + held.aside * (Eigen::Matrix3d::Identity() - along));
    if (bonded_[held.particle] != 0) {
      const auto place =
          std::lower_bound(ties.begin(), ties.begin() + of_bond, i,
                           [](const TieInertia& tie, std::uint32_t p) { return tie.particle < p; });
      place->contact = inertia;
    } else {
      ties.push_back({i, 0.0, inertia});
    }
  }
}

/// So many that every point has its turn before the fastest particle has come half the margin
/// nearer.
std::size_t TiedContact::looks_per_step(const State& state, double step) const {
  const Vector3 normal = model_->grid.axes.transpose() * plane_.normal;
  double closing = 0.0;
  for (const std::uint32_t i : particles_) {
    closing = std::max(closing, -normal.dot(state.velocity.at(i)));
  }
  if (!plane_.at_rest()) closing += fastest_approach(plane_, *model_);
  const double turns = std::clamp(0.5 * margin_ / (closing * step), 1.0, most_turns);
  return std::size_t(double(points_.size()) / std::floor(turns)) + 1;
}

Wrench TiedContact::add(const State& state, const Plane& plane, double step, VectorField& force,
                        std::vector<SharedLoad>* shared) {
  plane_ = plane.after(step);
  if (!is_trial_) look_around(state, step, looks_per_step(state, step));
  touching_ = sliding_ = 0;
  energy_ = 0.0;
  for (const std::uint32_t number : near_) {
    if (law_.mode == meshes::ContactMode::coulomb && points_[number].anchored) {
      drag_anchor(number, state, plane);
    }
    look_at(number, state, step);
    const Pull tie = pull(number);
    points_[number].force = model_->grid.axes * tie.force;
    if (tie.force.isZero(0.0)) continue;
    ++touching_;
    if (points_[number].sliding) ++sliding_;
    energy_ += 0.5 * tie.force.squaredNorm() / model_->outer[number].stiffness;
    load(number, tie);
  }
  // Far again: released only when nothing acts.
  std::erase_if(near_, [this](std::uint32_t number) {
    Point& point = points_[number];
    point.near = point.anchored || point.gap < 2.0 * margin_;
    return !point.near;
  });
  return unload(state, step, force, shared);
}

void TiedContact::try_from(const TiedContact& accepted) {
  is_trial_ = true;
  near_ = accepted.near_;
  for (const std::uint32_t number : near_) points_[number] = accepted.points_[number];
}

/// Along the normal, at the last add() [N].
double TiedContact::push(std::size_t number) const {
  return points_[number].force.dot(plane_.normal);
}

std::vector<PointLoad> TiedContact::point_loads(const State& state) const {
  std::vector<PointLoad> loads;
  for (const std::uint32_t number : near_) {
    if (!(push(number) > 0.0)) continue;
    loads.push_back({place_of(number, state, 0.0), points_[number].force});
  }
  return loads;
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
    loaded.push_back({{place.dot(t1), place.dot(t2)}, push(number), facing * tie.area});
  }
  return contact_radius(loaded);
}

std::vector<std::uint8_t> TiedContact::held() const {
  std::vector<std::uint8_t> touched(model_->points(), 0), result;
  for (const std::uint32_t number : near_) {
    if (!(push(number) > 0.0)) continue;
    const std::uint8_t how = points_[number].sliding ? 2 : 1;
    for (const std::uint32_t corner : model_->outer[number].corners) {
      touched[corner] = touched[corner] == 1 ? 1 : how;
    }
  }
  for (const std::uint32_t particle : model_->boundary) result.push_back(touched[particle]);
  return result;
}

}  // namespace fingertip::lattice
