#include "lattice/tied_bond.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

constexpr std::size_t grain = 64;  // particles; about 5 microseconds of work

}  // namespace

TiedBond::TiedBond(const LatticeModel& model, Team& team) : model_(&model), team_(&team) {
  std::map<std::uint32_t, std::map<std::uint32_t, double>> matrix;
  for (const TiedPoint& tie : model.bond) {
    for (std::size_t a = 0; a < 8; ++a) {
      for (std::size_t b = 0; b < 8; ++b) {
        matrix[tie.corners[a]][tie.corners[b]] += tie.stiffness * tie.weights[a] * tie.weights[b];
      }
    }
  }
  std::map<std::uint32_t, std::uint32_t> number;
  for (const auto& [point, row] : matrix) number.emplace(point, std::uint32_t(number.size()));
  for (const auto& [point, row] : matrix) {
    points_.push_back(point);
    rest_.push_back(model.rest_position(point));
    first_.push_back(std::uint32_t(entries_.size()));
    sum_.push_back(0.0);
    for (const auto& [other, value] : row) {
      entries_.push_back({number.at(other), value});
      sum_.back() += std::abs(value);
    }
  }
  first_.push_back(std::uint32_t(entries_.size()));
  slips_.assign(points_.size(), Row::Zero());
  pulls_ = slips_;
}

void TiedBond::find_slips(const State& state, const RodState& rod, double ahead,
                          std::vector<Row>& slips) const {
  const Pose pose = rod.pose();
  const Eigen::Matrix3d turn = pose.orientation.toRotationMatrix();
  const Eigen::Matrix3d to_grid = model_->grid.axes.transpose();
  const Vector3 velocity = rod.velocity(), spin = rod.angular_velocity(), centre = rod.centre();
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Vector3 place = pose.position + turn * rest_[p];
    const Vector3 carried = place - rest_[p] + ahead * (velocity + spin.cross(place - centre));
    slips[p].head<3>() = state.displacement.at(points_[p]) + ahead * state.velocity.at(points_[p]) -
                         to_grid * carried;
  }
}

TiedBond::Row TiedBond::pull(std::size_t particle, const std::vector<Row>& slips) const {
  Row sum = Row::Zero();
  for (std::uint32_t e = first_[particle]; e < first_[particle + 1]; ++e) {
    sum += entries_[e].value * slips[entries_[e].row];
  }
  return sum;
}

/// Replaces what a particle took without regard to its contact.
void TiedBond::share(SharedLoad& load, double step, VectorField& force) {
  const std::uint32_t i = load.particle;
  const std::size_t p =
      std::size_t(std::lower_bound(points_.begin(), points_.end(), i) - points_.begin());
  const Vector3 others = force.at(i) + Vector3(pulls_[p].head<3>());
  const Vector3 total = others - Vector3(pull(p, slips_).head<3>());
  const double mass = model_->mass[i], square = step * step;
  const Eigen::Matrix3d inertia =
      (mass + square * sum_[p]) * Eigen::Matrix3d::Identity() + square * load.stiffness;
  const Vector3 acceleration = inertia.inverse() * total;
  load.held_back = -square * (load.stiffness * acceleration);
  force.set(i, mass * acceleration);
  pulls_[p].head<3>() = others + load.held_back - mass * acceleration;
}

Wrench TiedBond::add(const State& state, const RodState& rod, double step, VectorField& force,
                     std::vector<SharedLoad>* shared) {
  find_slips(state, rod, step, slips_);
  team_->split(points_.size(), grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::uint32_t i = points_[p];
      const double mass = model_->mass[i];
      const double share = mass / (mass + step * step * sum_[p]);
      const Vector3 others = force.at(i);
      const Vector3 taken = share * (others - Vector3(pull(p, slips_).head<3>()));
      force.set(i, taken);
      pulls_[p].head<3>() = others - taken;
    }
  });
  if (shared != nullptr) {
    for (SharedLoad& load : *shared) share(load, step, force);
  }
  const Eigen::Matrix3d& axes = model_->grid.axes;
  const Vector3 endpoint = rod.endpoint();
  Wrench on_rod;
  for (std::size_t p = 0; p < points_.size(); ++p) {
    const Vector3 pulled = axes * Vector3(pulls_[p].head<3>());
    on_rod.force += pulled;
    on_rod.torque += (rest_[p] + axes * state.displacement.at(points_[p]) - endpoint).cross(pulled);
  }
  return on_rod;
}

void TiedBond::list_inertia(double step, std::vector<TieInertia>& ties) const {
  for (std::size_t p = 0; p < points_.size(); ++p) {
    ties.push_back({points_[p], step * step * sum_[p], Eigen::Matrix3d::Zero()});
  }
}

double TiedBond::energy(const State& state, const RodState& rod) const {
  std::vector<Row> slips(points_.size(), Row::Zero());
  find_slips(state, rod, 0.0, slips);
  double sum = 0.0;
  for (std::size_t p = 0; p < points_.size(); ++p) sum += (slips[p] * pull(p, slips)).sum();
  return 0.5 * sum;
}

}  // namespace fingertip::lattice
