#include "lattice/contact/tied_bond.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "lattice/threads/sum_in_portions.h"

namespace fingertip::lattice::inline contact {

using Eigen::Matrix3d;
using meshes::Vector3;

namespace {

constexpr std::size_t bond_portion = 16;  // slices per partial sum: the same for any thread count

using Matrix = std::map<std::uint32_t, std::map<std::uint32_t, double>>;  // by grid index

Matrix matrix_of(const std::vector<EmbeddedPoint>& ties) {
  Matrix matrix;
  for (const EmbeddedPoint& tie : ties) {
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < 8; ++b) {
        matrix[tie.corners[a]][tie.corners[b]] += tie.stiffness * tie.weights[a] * tie.weights[b];
      }
    }
  }
  return matrix;
}

/// The bits of three grid coordinates in turn (Morton): what is near in this order is near in
/// space, so that a slice's rows have most of their columns in common.
std::uint64_t place_in_space(const LatticeModel& model, std::uint32_t point) {
  const std::array<int, 3> at = model.place(point);
  std::uint64_t place = 0;
  for (std::size_t bit = 0; bit < 20; ++bit) {
    for (std::size_t c = 0; c < 3; ++c) place |= std::uint64_t(at[c] >> bit & 1) << (3 * bit + c);
  }
  return place;
}

Vector3 vector(const double* values) {
  return {values[0], values[1], values[2]};
}

}  // namespace

TiedBond::TiedBond(const LatticeModel& model, Team& team, int width)
    : model_(&model), team_(&team), kernels_(&kernel::select_bond(width)) {
  const Matrix matrix = matrix_of(model.bond);
  for (const auto& [point, row] : matrix) points_.push_back(point);
  std::sort(points_.begin(), points_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return place_in_space(model, a) < place_in_space(model, b);
  });
  number_particles();
  for (std::size_t p = 0; p < numbers_.size(); ++p) {
    for (const auto& [other, value] : matrix.at(points_[p])) sum_[p] += std::abs(value);
  }
  for (std::size_t slice = 0; slice < slices_; ++slice) {
    first_.push_back(std::uint32_t(column_.size()));
    const std::size_t end = std::min(numbers_.size(), (slice + 1) * lanes);
    std::set<std::uint32_t> columns;
    for (std::size_t p = slice * lanes; p < end; ++p) {
      for (const auto& [other, value] : matrix.at(points_[p])) columns.insert(number_of(other));
    }
    column_.insert(column_.end(), columns.begin(), columns.end());
    for (const std::uint32_t column : columns) {
      kernel::Lanes values{};
      for (std::size_t p = slice * lanes; p < end; ++p) {
        const auto& row = matrix.at(points_[p]);
        const auto found = row.find(points_[column]);
        if (found != row.end()) values.at[p - slice * lanes] = found->second;
      }
      value_.push_back(values);
    }
    if (columns.size() % 2 != 0) {  // columns come in pairs
      column_.push_back(0);
      value_.push_back({});
    }
  }
  first_.push_back(std::uint32_t(column_.size()));
}

/// Takes the order of points_ and fills up the last slice.
void TiedBond::number_particles() {
  for (const std::uint32_t point : points_) {
    numbers_.emplace_back(point, std::uint32_t(numbers_.size()));
    const Vector3 rest = model_->grid.axes.transpose() * model_->rest_position(point);
    for (std::size_t c = 0; c < 3; ++c) rest_[c].push_back(rest[Eigen::Index(c)]);
    mass_.push_back(model_->mass[point]);
  }
  std::sort(numbers_.begin(), numbers_.end());
  slices_ = (points_.size() + lanes - 1) / lanes;
  const std::size_t filled = slices_ * lanes;
  points_.resize(filled, 0);
  mass_.resize(filled, 1.0);
  sum_.resize(filled, 0.0);
  for (Field* field : {&rest_, &slip_, &still_}) {
    for (auto& component : *field) component.resize(filled, 0.0);
  }
  partial_.resize((slices_ + bond_portion - 1) / bond_portion);
}

std::uint32_t TiedBond::number_of(std::uint32_t point) const {
  return std::lower_bound(numbers_.begin(), numbers_.end(), std::pair(point, 0U))->second;
}

kernel::BondArrays TiedBond::arrays(const State& state) const {
  kernel::BondArrays a{};
  for (std::size_t c = 0; c < 3; ++c) {
    a.displacement[c] = state.displacement.component[c].data();
    a.velocity[c] = state.velocity.component[c].data();
    a.rest[c] = rest_[c].data();
    a.slip[c] = slip_[c].data();
    a.still[c] = still_[c].data();
  }
  a.point = points_.data();
  a.mass = mass_.data();
  a.sum = sum_.data();
  a.first = first_.data();
  a.column = column_.data();
  a.value = value_.data();
  return a;
}

/// Where the rod carries the X_i within `ahead` seconds at its present velocities.
kernel::Carried TiedBond::carried(const RodState& rod, double ahead) const {
  const Pose pose = rod.pose();
  const Matrix3d turn = pose.orientation.toRotationMatrix(), axes = model_->grid.axes;
  const Vector3 spin = rod.angular_velocity();
  Matrix3d goes_on = Matrix3d::Identity();  // 1 + ahead [spin]x
  for (int c = 0; c < 3; ++c) goes_on.col(c) += ahead * spin.cross(Vector3::Unit(c));
  const Vector3 start = rod.velocity() + spin.cross(pose.position - rod.centre());
  const Matrix3d moved = axes.transpose() * (goes_on * turn - Matrix3d::Identity()) * axes;
  const Vector3 shift = axes.transpose() * (pose.position + ahead * start);
  kernel::Carried result{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      result.turn[3 * row + column] = moved(row, column);
    }
    result.shift[row] = shift[row];
  }
  return result;
}

/// Replaces what a particle took without regard to its contact; returns by how much the rod
/// receives more, about the tip's origin.
Wrench TiedBond::share(SharedLoad& load, const State& state, double square, VectorField& force) {
  const std::uint32_t i = load.particle;
  const std::size_t p = number_of(i);
  const double heavy = mass_[p] + square * sum_[p];
  const Vector3 taken = force.at(i), total = heavy / mass_[p] * taken;
  const Matrix3d inertia = heavy * Matrix3d::Identity() + square * load.stiffness;
  const Vector3 acceleration = inertia.inverse() * total;
  load.held_back = -square * (load.stiffness * acceleration);
  force.set(i, mass_[p] * acceleration);
  const Vector3 more = model_->grid.axes * (taken + load.held_back - mass_[p] * acceleration);
  return {more, position(*model_, state, i).cross(more)};
}

Wrench TiedBond::add(const State& state, const RodState& rod, double step, VectorField& force,
                     std::vector<SharedLoad>* shared, double* stored) {
  kernel::BondArrays all = arrays(state);
  for (std::size_t c = 0; c < 3; ++c) all.force[c] = force.component[c].data();
  const kernel::Carried motion = carried(rod, step);
  team_->split(slices_, bond_portion, [&](std::size_t begin, std::size_t end) {
    kernels_->find_slips(all, motion, step, begin, end);
  });
  if (stored != nullptr) {
    kernel::BondArrays here = all;
    for (std::size_t c = 0; c < 3; ++c) here.slip[c] = still_[c].data();
    const kernel::Carried now = carried(rod, 0.0);
    team_->split(slices_, bond_portion, [&](std::size_t begin, std::size_t end) {
      kernels_->find_slips(here, now, 0.0, begin, end);
    });
  }
  const auto take = stored != nullptr ? kernels_->take_and_sum : kernels_->take;
  team_->split(partial_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t last = std::min(slices_, (p + 1) * bond_portion);
      partial_[p] = take(all, step * step, p * bond_portion, last);
    }
  });
  Vector3 pulled = Vector3::Zero(), moment = Vector3::Zero();  // along the grid's axes
  double energy = 0.0;
  for (const kernel::Pulled& part : partial_) {
    pulled += vector(part.force);
    moment += vector(part.moment);
    energy += part.energy;
  }
  if (stored != nullptr) *stored = energy;
  Wrench on_rod{model_->grid.axes * pulled, model_->grid.axes * moment};  // about the tip's origin
  if (shared != nullptr) {
    for (SharedLoad& load : *shared) {
      const Wrench more = share(load, state, step * step, force);
      on_rod.force += more.force;
      on_rod.torque += more.torque;
    }
  }
  on_rod.torque -= rod.endpoint().cross(on_rod.force);
  return on_rod;
}

void TiedBond::list_inertia(double step, std::vector<BondInertia>& ties) const {
  ties.clear();
  for (const auto& [point, number] : numbers_) {
    ties.push_back({point, step * step * sum_[number]});
  }
}

double TiedBond::energy(const State& state, const RodState& rod) const {
  const kernel::BondArrays all = arrays(state);
  const kernel::Carried motion = carried(rod, 0.0);
  team_->split(slices_, bond_portion, [&](std::size_t begin, std::size_t end) {
    kernels_->find_slips(all, motion, 0.0, begin, end);
  });
  return sum_in_portions<16>(*team_, slices_, [&](std::size_t begin, std::size_t end) {
    return kernels_->energy(all, begin, end);
  });
}

}  // namespace fingertip::lattice::inline contact
