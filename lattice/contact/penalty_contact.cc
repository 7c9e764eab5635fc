#include "lattice/contact/penalty_contact.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fingertip::lattice::inline contact {

using meshes::Vector3;

namespace {

constexpr double max_turns = 64.0;      // steps until every point has had its turn
constexpr double max_skip_count = 7.0;  // that a point far away lets pass

// The same for any number of threads.
constexpr std::size_t near_portion = 32;    // near particles per partial sum
constexpr std::size_t speed_portion = 512;  // contact particles per partial maximum

// What is worth another thread: some microseconds.
constexpr std::size_t looks_per_piece = 32, holds_per_piece = 8;

std::size_t portions_of(std::size_t count, std::size_t each) {
  return (count + each - 1) / each;
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

}  // namespace

PenaltyContact::PenaltyContact(const LatticeModel& model, const Plane& plane, const ContactLaw& law,
                               Team& team, int width)
    : model_(&model),
      team_(&team),
      kernels_(&kernel::select_contact(width)),
      shape_(contact_shape(model)),
      plane_(plane),
      law_(law),
      margin_(0.5 * model.spacing()),
      memory_(shape_->groups.size()),
      is_near_(shape_->groups.size(), 0),
      skip_count_(shape_->groups.size(), 0),
      found_(shape_->groups.size()),
      loads_(shape_->groups.size()),
      near_groups_(shape_->particles.size(), 0),
      fastest_(portions_of(shape_->particles.size(), speed_portion)),
      given_(portions_of(shape_->particles.size(), near_portion)),
      on_particle_(shape_->particles.size()) {
  near_.reserve(shape_->groups.size());
  near_particles_.reserve(shape_->particles.size());
  held_.reserve(shape_->particles.size());
  const State rest(model);
  const kernel::ContactArrays start = arrays(rest, plane, 0.0, {});
  stand(start);
  broad_phase(start, shape_->groups.size());
}

void PenaltyContact::stand(const kernel::ContactArrays& arrays) {
  if (arrays.obstacle.flat || arrays.exact) return;
  for (std::uint32_t group = 0; group < shape_->groups.size(); ++group)
    kernels_->stand(arrays, group);
}

kernel::ContactArrays PenaltyContact::arrays(const State& state, const Plane& now, double step,
                                             const Pose& rod) {
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
  a.now = frame_of(now, model_->grid.axes);
  a.then = frame_of(plane_, model_->grid.axes);
  a.ahead = step;
  a.friction = law_.friction;
  a.law = model_->contact;
  a.obstacle = plane_.obstacle.form();
  if (a.obstacle.flat) return a;
  a.exact = model_->kinematics == Kinematics::finite;
  a.follows = law_.mode != meshes::ContactMode::frictionless;
  const Eigen::Matrix3d axes = plane_.turned.conjugate() * plane_.axes();
  Vector3::Map(a.tangent[0]) = axes.col(0);
  Vector3::Map(a.tangent[1]) = axes.col(1);
  // rest -> rod.position + rod.orientation rest, seen from the plane.
  a.carried = frame_of(plane_, rod.orientation.toRotationMatrix() * model_->grid.axes);
  Vector3::Map(a.carried.shift) += plane_.turned.conjugate() * rod.position;
  return a;
}

/// Groups that have come near are looked at in every step from now on.
void PenaltyContact::broad_phase(const kernel::ContactArrays& arrays, std::size_t looks) {
  const std::size_t first = next_look_, count = is_near_.size();
  looks = std::min(looks, count);
  constexpr std::uint8_t came = 2;
  team_->split(looks, looks_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t group = (first + n) % count;
      if (is_near_[group] != 0) continue;
      if (skip_count_[group] > 0) {
        --skip_count_[group];
        continue;
      }
      // Where points were when last looked at tells apply() where they crossed, had they come this
      // fast.
      const double gap = kernels_->look(arrays, margin_, group);
      if (gap < margin_) is_near_[group] = came;
      // From one turn to the next it comes nearer by half a margin at most.
      skip_count_[group] = std::uint8_t(std::clamp(gap / margin_ - 1.0, 0.0, max_skip_count));
    }
  });
  for (std::size_t n = 0; n < looks; ++n) {
    const std::size_t group = (first + n) % count;
    if (is_near_[group] == came) enter(std::uint32_t(group));
  }
  if (count > 0) next_look_ = (first + looks) % count;
}

/// A group becomes near.
void PenaltyContact::enter(std::uint32_t group) {
  is_near_[group] = 1;
  near_.push_back(group);
  for (const std::uint32_t particle : shape_->groups[group].particle) {
    if (near_groups_[particle]++ == 0) near_particles_.push_back(particle);
  }
}

void PenaltyContact::apply_near(const kernel::ContactArrays& arrays) {
  const kernel::Grip grip = grip_of(law_);
  team_->split(near_.size(), holds_per_piece, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      found_[near_[n]] = kernels_->apply(arrays, grip, near_[n]);
    }
  });
  touching_ = sliding_ = 0;
  energy_ = 0.0;
  std::size_t kept = 0;
  for (const std::uint32_t group : near_) {
    const kernel::GroupFindings& found = found_[group];
    touching_ += found.touching;
    sliding_ += found.sliding;
    energy_ += found.energy;
    // Far again: released only when nothing acts.
    is_near_[group] = found.anchored || found.smallest_gap < 2.0 * margin_;
    if (is_near_[group] != 0) {
      near_[kept++] = group;
    } else {
      for (const std::uint32_t particle : shape_->groups[group].particle) --near_groups_[particle];
    }
  }
  if (kept == near_.size()) return;
  near_.resize(kept);
  std::erase_if(near_particles_, [&](std::uint32_t p) { return near_groups_[p] == 0; });
}

/// What the groups of its cells do to a contact particle.
kernel::ContactLoad PenaltyContact::load_on(std::uint32_t particle, bool& touches) const {
  kernel::ContactLoad sum{};
  touches = false;
  for (std::uint32_t n = shape_->first_place[particle]; n < shape_->first_place[particle + 1];
       ++n) {
    const ContactShape::Place& place = shape_->places[n];
    if (found_[place.group].touching == 0) continue;
    touches = true;
    const kernel::ContactLoad& load = loads_[place.group].corner[place.corner];
    for (std::size_t c = 0; c < 3; ++c) sum.force[c] += load.force[c];
    for (std::size_t c = 0; c < 6; ++c) sum.stiffness[c] += load.stiffness[c];
  }
  return sum;
}

namespace {

/// Of a particle on a mirror plane without what couples it to the motion across, which is held.
Eigen::Matrix3d stiffness_of(const kernel::ContactLoad& load, const LatticeModel& model,
                             std::uint32_t particle) {
  const auto& k = load.stiffness;
  Eigen::Matrix3d stiffness;
  stiffness << k[0], k[3], k[4], k[3], k[1], k[5], k[4], k[5], k[2];
  if (model.sector.count() > 1) {
    const Vector3 own = stiffness.diagonal();
    model.sector.hold(model.place(particle), stiffness);
    stiffness.diagonal() = own;
  }
  return stiffness;
}

}  // namespace

/// Passes the loads of some particles on to them; returns what the plane gives them, along the
/// grid's axes. If those of the bond share theirs with it, they get the plain forces.
Wrench PenaltyContact::unload_portion(std::size_t number, const State& state, double square,
                                      bool shares, VectorField& force) {
  Wrench sum;
  const std::size_t last = std::min(near_particles_.size(), (number + 1) * near_portion);
  for (std::size_t n = number * near_portion; n < last; ++n) {
    const std::uint32_t particle = near_particles_[n], i = shape_->particles[particle];
    const kernel::ContactLoad load = load_on(particle, on_particle_[n].acts);
    if (!on_particle_[n].acts) continue;
    const Eigen::Matrix3d stiffness = stiffness_of(load, *model_, i);
    on_particle_[n].held = {particle, stiffness};
    const Vector3 others = force.at(i);
    Vector3 taken = others + Eigen::Map<const Vector3>(load.force);
    if (!shares || shape_->bonded[particle] == 0) {
      const double mass = model_->mass[i];
      const Eigen::Matrix3d inertia = mass * Eigen::Matrix3d::Identity() + square * stiffness;
      // The plane's part first, which has no direction but those of its ties.
      const Vector3 acceleration = inertia.inverse() * taken;
      taken -= square * (stiffness * acceleration);
    }
    force.set(i, taken);
    const Vector3 given = taken - others;
    sum.force += given;
    sum.torque += (shape_->rest[particle] + state.displacement.at(i)).cross(given);
  }
  return sum;
}

/// Passes the loads on to the particles; returns what the plane gives them altogether.
Wrench PenaltyContact::unload(const State& state, double step, VectorField& force,
                              std::vector<SharedLoad>* shared) {
  const std::size_t portions = portions_of(near_particles_.size(), near_portion);
  team_->split(portions, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      given_[n] = unload_portion(n, state, step * step, shared != nullptr, force);
    }
  });
  list_held(shared);
  Wrench sum;
  for (std::size_t n = 0; n < portions; ++n) {
    sum.force += given_[n].force;
    sum.torque += given_[n].torque;
  }
  return {model_->grid.axes * sum.force, model_->grid.axes * sum.torque};
}

void PenaltyContact::list_held(std::vector<SharedLoad>* shared) {
  held_.clear();
  for (std::size_t n = 0; n < near_particles_.size(); ++n) {
    if (!on_particle_[n].acts) continue;
    const Held& held = on_particle_[n].held;
    held_.push_back(held);
    if (shared == nullptr || shape_->bonded[held.particle] == 0) continue;
    shared->push_back({shape_->particles[held.particle], held.stiffness, Vector3::Zero()});
  }
}

void PenaltyContact::list_inertia(double step, std::vector<ContactInertia>& ties) const {
  const double square = step * step;
  ties.clear();
  for (const Held& held : held_) {
    ties.push_back(
        {shape_->particles[held.particle], square * held.stiffness, shape_->rest[held.particle]});
  }
}

/// Of the particles toward the plane [m/s].
double PenaltyContact::closing_speed(const State& state) {
  const Vector3 normal = model_->grid.axes.transpose() * plane_.normal;
  const double* velocity[3];
  for (std::size_t c = 0; c < 3; ++c) velocity[c] = state.velocity.component[c].data();
  const std::vector<std::uint32_t>& particles = shape_->particles;
  team_->split(fastest_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t n = begin; n < end; ++n) {
      const std::size_t first = n * speed_portion;
      fastest_[n] = kernels_->closing(velocity, normal.data(), particles.data() + first,
                                      std::min(speed_portion, particles.size() - first));
    }
  });
  return fastest_.empty() ? 0.0 : *std::max_element(fastest_.begin(), fastest_.end());
}

/// So many that every group has its turn before the fastest particle has come half the margin
/// nearer; all, if that is less than a step's way or nobody knows.
std::size_t PenaltyContact::looks_per_step(const State& state, double step) {
  // What moves along a plane can come nearer to another obstacle.
  if (!plane_.obstacle.is_plane()) step = 0.0;
  double closing = closing_speed(state);
  // Of a moving plane toward any point: its velocity is linear in the place.
  const double turning = plane_.normal.cross(plane_.angular_velocity).norm();
  closing += std::max(
      0.0, plane_.normal.dot(plane_.velocity_at(shape_->centre)) + turning * shape_->reach);
  const double turns = std::min(0.5 * margin_ / (closing * step), max_turns);
  if (!(step > 0.0 && turns >= 1.0 && drift_ < 0.1 * margin_)) {
    std::fill(skip_count_.begin(), skip_count_.end(), std::uint8_t{0});
    drift_ = 0.0;
    return is_near_.size();
  }
  return std::size_t(double(is_near_.size()) / std::floor(turns)) + 1;
}

/// How far the plane is from where it was to be, at most, for any point [m].
double PenaltyContact::distance(const Plane& plane) const {
  return (plane.point - plane_.point).norm() +
         shape_->reach * (plane.normal - plane_.normal).norm();
}

Wrench PenaltyContact::add(const State& state, const Plane& plane, double step, VectorField& force,
                           std::vector<SharedLoad>* shared, const Pose& rod) {
  drift_ += distance(plane);
  plane_ = plane.after(step);
  const kernel::ContactArrays all = arrays(state, plane, step, rod);
  if (!is_trial_) broad_phase(all, looks_per_step(state, step));
  apply_near(all);
  return unload(state, step, force, shared);
}

void PenaltyContact::try_from(const PenaltyContact& accepted) {
  is_trial_ = true;
  forget_near();
  for (const std::uint32_t group : accepted.near_) {
    enter(group);
    memory_[group] = accepted.memory_[group];
  }
}

void PenaltyContact::start_at(const State& state, const Plane& plane, const Pose& rod) {
  constexpr double all = -1e300;  // a gap that no point is below
  plane_ = plane;
  const kernel::ContactArrays here = arrays(state, plane, 0.0, rod);
  stand(here);
  for (std::uint32_t group = 0; group < shape_->groups.size(); ++group) {
    const double least = kernels_->look(here, all, group);
    skip_count_[group] = 0;
    if (least >= margin_) continue;
    if (is_near_[group] == 0) enter(group);
    kernel::ContactMemory& memory = memory_[group];
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const double below = std::fmin(memory.gap.at[lane], 0.0);
      for (std::size_t c = 0; c < 3; ++c) memory.place[c].at[lane] -= below * here.normal[c];
      memory.gap.at[lane] -= below;
    }
  }
}

void PenaltyContact::forget_near() {
  for (const std::uint32_t group : near_) {
    is_near_[group] = 0;
    found_[group] = {};
  }
  for (const std::uint32_t particle : near_particles_) near_groups_[particle] = 0;
  near_.clear();
  near_particles_.clear();
}

std::vector<TiedPoint> PenaltyContact::points(const State& state, const Vector3& travel) const {
  const Eigen::Matrix3d& axes = model_->grid.axes;
  const bool finite = model_->kinematics == Kinematics::finite,
             free = law_.mode == meshes::ContactMode::frictionless;
  std::vector<TiedPoint> found;
  for (const std::uint32_t group : near_) {
    const kernel::ContactMemory& memory = memory_[group];
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!(shape_->groups[group].stiffness.at[lane] > 0.0)) continue;  // repeats the first
      const EmbeddedPoint& tie = model_->outer[shape_->points[group * lanes + lane]];
      meshes::ContactPoint& point =
          found.emplace_back(TiedPoint{{}, tie.corners, tie.weights}).point;
      const Vector3 place = tie.rest + axes * shift(tie, state, 0.0);
      point.rest = tie.rest;
      point.place = finite ? Vector3(place - travel) : tie.rest;
      point.normal = finite ? plane_.normal_at(place) : plane_.normal;
      if (!finite) {
        point.area = seen_area(tie, plane_.normal);
      } else {
        Eigen::Matrix<double, 3, 8> moved;
        for (int c = 0; c < 8; ++c)
          moved.col(c) = axes * state.displacement.at(tie.corners[std::size_t(c)]);
        point.area = carried_surface(tie, moved, model_->grid.spacing * axes).norm();
      }
      const bool acts = memory.push.at[lane] > 0.0;
      point.set_force(plane_.turned *
                      (acts ? Vector3(memory.force[0].at[lane], memory.force[1].at[lane],
                                      memory.force[2].at[lane])
                            : Vector3::Zero()));
      if (free) point.shear.setZero();  // but for round-off it is
      const bool holds = acts && memory.sliding.at[lane] == 0.0;
      const bool sticks = law_.mode == meshes::ContactMode::stick || (holds && !free);
      point.state = sticks ? meshes::ContactState::stick : meshes::ContactState::slip;
    }
  }
  return found;
}

kernel::PatchView PenaltyContact::patch_view() const {
  const Vector3 t1 = first_tangent(plane_.normal), t2 = t1.cross(plane_.normal);
  const Eigen::Matrix3d to_grid = model_->grid.axes.transpose();
  kernel::PatchView view{};
  view.at_rest = model_->kinematics != Kinematics::finite;
  const Eigen::Matrix3d to_view =
      view.at_rest ? to_grid : plane_.turned.conjugate().toRotationMatrix();
  Vector3::Map(view.tangent[0]) = to_view * t1;
  Vector3::Map(view.tangent[1]) = to_view * t2;
  Vector3::Map(view.normal) = to_grid * plane_.normal;
  return view;
}

meshes::ContactPatch PenaltyContact::patch() const {
  constexpr std::size_t portions = 16;  // the same for any number of threads
  const kernel::PatchView view = patch_view();
  std::array<kernel::PatchSums, portions> part{};
  team_->split(portions, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t last = (p + 1) * near_.size() / portions;
      for (std::size_t n = p * near_.size() / portions; n < last; ++n) {
        if (found_[near_[n]].touching == 0) continue;
        kernels_->add_up(shape_->groups[near_[n]], memory_[near_[n]], view, part[p]);
      }
    }
  });
  meshes::ForceMoments sums;
  for (const kernel::PatchSums& p : part) {
    for (std::size_t i = 0; i < sums.power.size(); ++i) sums.power[i] += p.power[i];
    sums.area += p.area;
    sums.touched += p.touched;
  }
  const meshes::ContactPatch patch = contact_patch(sums, model_->sector.count());
  return patch.is_fine ? judged(patch, view) : patch;
}

/// By the loads of the contact particles, from the groups that touch.
meshes::ContactPatch PenaltyContact::judged(const meshes::ContactPatch& patch,
                                            const kernel::PatchView& view) const {
  std::vector<meshes::PatchLoad> loads(shape_->particles.size());
  double pushed = 0.0, bare = 0.0;
  const auto along = [](const double* direction, const kernel::Lanes* at, std::size_t lane) {
    return direction[0] * at[0].at[lane] + direction[1] * at[1].at[lane] +
           direction[2] * at[2].at[lane];
  };
  for (const std::uint32_t number : near_) {
    if (found_[number].touching == 0) continue;
    const kernel::ContactGroup& group = shape_->groups[number];
    const kernel::ContactMemory& memory = memory_[number];
    const kernel::Lanes* const place = view.at_rest ? group.rest : memory.place;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (!(group.stiffness.at[lane] > 0.0)) continue;  // repeats the first
      const double push = memory.push.at[lane],
                   area = std::abs(along(view.normal, group.facing, lane)),
                   expected = area * patch.max_pressure *
                              patch.profile({along(view.tangent[0], place, lane),
                                             along(view.tangent[1], place, lane)});
      if (expected > 0.0) (push > 0.0 ? pushed : bare) += area;
      const EmbeddedPoint& tie = model_->outer[shape_->points[number * lanes + lane]];
      for (std::size_t c = 0; c < 8; ++c) {
        meshes::PatchLoad& load = loads[group.particle[c]];
        load.borne += tie.weights[c] * push;
        load.expected += tie.weights[c] * expected;
      }
    }
  }
  return patch.judged_by(loads, bare / (pushed + bare));
}

std::vector<std::uint8_t> PenaltyContact::held() const {
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

}  // namespace fingertip::lattice::inline contact
