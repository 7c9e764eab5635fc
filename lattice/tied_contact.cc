#include "lattice/tied_contact.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "lattice/cells/contact_patch.h"

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

constexpr double most_turns = 16.0;  // steps until every point has been looked at

using Cell = std::array<std::uint32_t, 8>;  // its corners

/// The points of every cell, in the order of the cells' first points.
std::vector<std::vector<std::uint32_t>> points_by_cell(const std::vector<TiedPoint>& points) {
  std::vector<std::vector<std::uint32_t>> result;
  std::map<Cell, std::size_t> number;
  for (std::uint32_t p = 0; p < points.size(); ++p) {
    const auto [found, is_new] = number.emplace(points[p].corners, result.size());
    if (is_new) result.emplace_back();
    result[found->second].push_back(p);
  }
  return result;
}

/// Lane `lane` of a group becomes this point, or if it only fills up one that is tied to nothing.
void set_point(kernel::ContactGroup& group, std::size_t lane, const TiedPoint& tie,
               const Vector3& rest, bool fills_up) {
  double size = 0.0;
  for (const double weight : tie.weights) size += std::abs(weight);
  group.stiffness.at[lane] = fills_up ? 0.0 : tie.stiffness;
  group.inertia.at[lane] = size * group.stiffness.at[lane];
  for (std::size_t c = 0; c < 3; ++c) group.rest[c].at[lane] = rest[Eigen::Index(c)];
  for (std::size_t c = 0; c < 8; ++c) {
    group.weight[c].at[lane] = tie.weights[c];
    group.share[lane].at[c] = tie.weights[c];
  }
}

/// From places along the grid's axes to such that are fixed to the plane.
kernel::PlaneFrame frame_of(const Plane& plane, const Eigen::Matrix3d& axes) {
  const Eigen::Matrix3d turn = plane.turned.conjugate().toRotationMatrix() * axes;
  const Vector3 shift = -(plane.turned.conjugate() * plane.point);
  kernel::PlaneFrame frame{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) frame.turn[3 * row + column] = turn(row, column);
    frame.shift[row] = shift[row];
  }
  return frame;
}

kernel::Grip grip_of(const ContactLaw& law) {
  switch (law.mode) {
    case meshes::ContactMode::frictionless: return kernel::Grip::frictionless;
    case meshes::ContactMode::coulomb: return kernel::Grip::coulomb;
    default: return kernel::Grip::stick;
  }
}

Vector3 at(const kernel::Lanes* field, std::size_t lane) {
  return {field[0].at[lane], field[1].at[lane], field[2].at[lane]};
}

}  // namespace

std::shared_ptr<const TiedContact::Shape> TiedContact::shape_of(const LatticeModel& model) {
  const Eigen::Matrix3d to_grid = model.grid.axes.transpose();
  auto shape = std::make_shared<Shape>();
  std::map<std::uint32_t, std::uint32_t> number;
  for (const TiedPoint& tie : model.outer) {
    for (const std::uint32_t corner : tie.corners) number.emplace(corner, 0);
    shape->centre += tie.rest / double(model.outer.size());
  }
  for (auto& [particle, n] : number) {
    n = std::uint32_t(shape->particles.size());
    shape->particles.push_back(particle);
    shape->rest.push_back(to_grid * model.rest_position(particle));
  }
  for (const std::vector<std::uint32_t>& cell : points_by_cell(model.outer)) {
    for (std::size_t first = 0; first < cell.size(); first += lanes) {
      kernel::ContactGroup group{};
      for (std::size_t c = 0; c < 8; ++c) {
        group.corner[c] = model.outer[cell[first]].corners[c];
        group.particle[c] = number.at(group.corner[c]);
      }
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        const bool fills_up = first + lane >= cell.size();
        const std::uint32_t point = cell[fills_up ? first : first + lane];
        const TiedPoint& tie = model.outer[point];
        set_point(group, lane, tie, to_grid * tie.rest, fills_up);
        shape->points.push_back(point);
        shape->outward.push_back(outer_normal(tie.rest));
        shape->reach = std::max(shape->reach, (tie.rest - shape->centre).norm());
      }
      shape->groups.push_back(group);
    }
  }
  shape->bonded.resize(shape->particles.size(), 0);
  for (const TiedPoint& tie : model.bond) {
    for (const std::uint32_t corner : tie.corners) {
      const auto found = number.find(corner);
      if (found != number.end()) shape->bonded[found->second] = 1;
    }
  }
  return shape;
}

TiedContact::TiedContact(const LatticeModel& model, const Plane& plane, const ContactLaw& law,
                         int width)
    : model_(&model),
      kernels_(&kernel::select_contact(width)),
      shape_(shape_of(model)),
      plane_(plane),
      law_(law),
      margin_(0.5 * model.spacing()),
      memory_(shape_->groups.size()),
      is_near_(shape_->groups.size(), 0),
      loads_(shape_->particles.size()),
      loaded_(shape_->particles.size()) {
  near_.reserve(shape_->groups.size());
  const State rest(model);
  look_around(arrays(rest, plane, 0.0), shape_->groups.size());
}

kernel::ContactArrays TiedContact::arrays(const State& state, const Plane& now, double step) {
  kernel::ContactArrays a{};
  const Vector3 normal = plane_.turned.conjugate() * plane_.normal;  // the same at any time
  for (std::size_t c = 0; c < 3; ++c) {
    a.displacement[c] = state.displacement.component[c].data();
    a.velocity[c] = state.velocity.component[c].data();
    a.normal[c] = normal[Eigen::Index(c)];
  }
  a.groups = shape_->groups.data();
  a.memory = memory_.data();
  a.loads = loads_.data();
  a.loaded = loaded_.data();
  a.now = frame_of(now, model_->grid.axes);
  a.then = frame_of(plane_, model_->grid.axes);
  a.ahead = step;
  a.friction = law_.friction;
  return a;
}

/// Groups that have come near are looked at in every step from now on.
void TiedContact::look_around(const kernel::ContactArrays& arrays, std::size_t looks) {
  for (std::size_t n = 0; n < looks; ++n, ++next_look_) {
    if (next_look_ >= is_near_.size()) next_look_ = 0;
    if (is_near_[next_look_] != 0) continue;
    // Where points were when last looked at tells hold() where they crossed, had they come this
    // fast.
    if (!kernels_->look(arrays, margin_, next_look_)) continue;
    is_near_[next_look_] = 1;
    near_.push_back(std::uint32_t(next_look_));
  }
}

void TiedContact::hold_near(const kernel::ContactArrays& arrays) {
  const kernel::Grip grip = grip_of(law_);
  touching_ = sliding_ = 0;
  energy_ = 0.0;
  loaded_count_ = 0;
  std::size_t kept = 0;
  for (const std::uint32_t group : near_) {
    const kernel::GroupFindings found = kernels_->hold(arrays, grip, group, loaded_count_);
    touching_ += found.touching;
    sliding_ += found.sliding;
    energy_ += found.energy;
    // Far again: released only when nothing acts.
    is_near_[group] = found.anchored || found.smallest_gap < 2.0 * margin_;
    if (is_near_[group] != 0) near_[kept++] = group;
  }
  near_.resize(kept);
}

/// Passes the loads on to the particles; returns what the plane gives them altogether.
Wrench TiedContact::unload(const State& state, double step, VectorField& force,
                           std::vector<SharedLoad>* shared) {
  const Vector3 normal = model_->grid.axes.transpose() * plane_.normal;
  const double square = step * step;
  held_.clear();
  Vector3 sum = Vector3::Zero(), moment = Vector3::Zero();  // along the grid's axes
  for (std::size_t n = 0; n < loaded_count_; ++n) {
    const std::uint32_t particle = loaded_[n], i = shape_->particles[particle];
    const kernel::ContactLoad& load = loads_[particle];
    const Vector3 others = force.at(i);
    Vector3 taken = others + Eigen::Map<const Vector3>(load.force);
    if (shared != nullptr && shape_->bonded[particle] != 0) {
      const Eigen::Matrix3d along = normal * normal.transpose();
      shared->push_back(
          {i, load.stiffness * along + load.aside * (Eigen::Matrix3d::Identity() - along),
           Vector3::Zero()});
    } else {
      const double mass = model_->mass[i];
      const double share = mass / (mass + square * load.stiffness);
      const double share_aside = mass / (mass + square * load.aside);
      const Vector3 along = normal.dot(taken) * normal;
      taken = share * along + share_aside * (taken - along);
    }
    force.set(i, taken);
    const Vector3 given = taken - others;
    sum += given;
    moment += (shape_->rest[particle] + state.displacement.at(i)).cross(given);
    held_.push_back({particle, load.stiffness, load.aside});
    loads_[particle] = {};
  }
  return {model_->grid.axes * sum, model_->grid.axes * moment};
}

void TiedContact::list_inertia(double step, std::vector<ContactInertia>& ties) const {
  const double square = step * step;
  ties.clear();
  for (const Held& held : held_) {
    ties.push_back(
        {shape_->particles[held.particle], square * held.stiffness, square * held.aside});
  }
}

/// So many that every group has its turn before the fastest particle has come half the margin
/// nearer.
std::size_t TiedContact::looks_per_step(const State& state, double step) const {
  const Vector3 normal = model_->grid.axes.transpose() * plane_.normal;
  const double* velocity[3];
  for (std::size_t c = 0; c < 3; ++c) velocity[c] = state.velocity.component[c].data();
  double closing = kernels_->closing(velocity, normal.data(), shape_->particles.data(),
                                     shape_->particles.size());
  // Of a moving plane toward any point: its velocity is linear in the place.
  const double turning = plane_.normal.cross(plane_.angular_velocity).norm();
  closing += std::max(
      0.0, plane_.normal.dot(plane_.velocity_at(shape_->centre)) + turning * shape_->reach);
  const double turns = std::clamp(0.5 * margin_ / (closing * step), 1.0, most_turns);
  return std::size_t(double(is_near_.size()) / std::floor(turns)) + 1;
}

Wrench TiedContact::add(const State& state, const Plane& plane, double step, VectorField& force,
                        std::vector<SharedLoad>* shared) {
  plane_ = plane.after(step);
  const kernel::ContactArrays all = arrays(state, plane, step);
  if (!is_trial_) look_around(all, looks_per_step(state, step));
  hold_near(all);
  return unload(state, step, force, shared);
}

void TiedContact::try_from(const TiedContact& accepted) {
  is_trial_ = true;
  near_ = accepted.near_;
  for (const std::uint32_t group : near_) memory_[group] = accepted.memory_[group];
}

std::vector<PointLoad> TiedContact::point_loads(const State& state) const {
  std::vector<PointLoad> found;
  for (const std::uint32_t group : near_) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!(memory_[group].push.at[lane] > 0.0)) continue;
      const TiedPoint& tie = model_->outer[shape_->points[group * lanes + lane]];
      const Vector3 force = {memory_[group].force[0].at[lane], memory_[group].force[1].at[lane],
                             memory_[group].force[2].at[lane]};
      found.push_back(
          {tie.rest + model_->grid.axes * shift(tie, state, 0.0), plane_.turned * force});
    }
  }
  return found;
}

double TiedContact::radius() const {
  const Vector3 t1 = first_tangent(plane_.normal), t2 = t1.cross(plane_.normal);
  std::vector<LoadedPoint> loaded;
  loaded.reserve(std::size_t(touching_));
  for (const std::uint32_t group : near_) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double push = memory_[group].push.at[lane];
      if (push == 0.0) continue;
      const TiedPoint& tie = model_->outer[shape_->points[group * lanes + lane]];
      const Vector3 place = model_->kinematics == Kinematics::finite
                                ? plane_.turned * at(memory_[group].place, lane)
                                : tie.rest;
      const double facing = std::abs(shape_->outward[group * lanes + lane].dot(plane_.normal));
      loaded.push_back({{place.dot(t1), place.dot(t2)}, push, facing * tie.area});
    }
  }
  return contact_radius(loaded);
}

std::vector<std::uint8_t> TiedContact::held() const {
  std::vector<std::uint8_t> touched(model_->points(), 0), result;
  for (const std::uint32_t group : near_) {
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!(memory_[group].push.at[lane] > 0.0)) continue;
      const std::uint8_t how = memory_[group].sliding.at[lane] != 0.0 ? 2 : 1;
      for (const std::uint32_t corner : shape_->groups[group].corner) {
        touched[corner] = touched[corner] == 1 ? 1 : how;
      }
    }
  }
  for (const std::uint32_t particle : model_->boundary) result.push_back(touched[particle]);
  return result;
}

}  // namespace fingertip::lattice
