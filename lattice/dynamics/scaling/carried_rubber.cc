#include "lattice/dynamics/scaling/carried_rubber.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "lattice/dynamics/scaling/body_sweeps.h"
#include "lattice/kernels/by_width.h"

namespace fingertip::lattice::inline dynamics::inline scaling {

using meshes::Vector3;

namespace {

const sweeps::BodyLoops& body_loops() {
  static const sweeps::BodyLoops& widest =
      kernel::by_width(0, [](auto w) { return sweeps::body_loops_at<w()>; })();
  return widest;
}

constexpr std::size_t blocks_per_sum = 64;  // blocks per partial sum: the same for any thread count

sweeps::BodyArrays arrays(const LatticeModel& model, const State& state,
                          const std::array<double, 3>* starts) {
  sweeps::BodyArrays a{};
  for (std::size_t c = 0; c < 3; ++c) a.displacement[c] = state.displacement.component[c].data();
  a.mass = model.mass.data();
  a.blocks = model.blocks.data();
  a.starts = starts;
  a.spacing = model.spacing();
  return a;
}

/// Of a body of mass m, first moment p and second moments q = Σ m x xᵀ (xx, yy, zz, xy, yz, zx).
Matrix6 body_inertia(double m, const double* p, const double* q) {
  Matrix6 inertia = Matrix6::Zero();
  inertia.topLeftCorner<3, 3>() = m * Eigen::Matrix3d::Identity();
  Eigen::Matrix3d first, second;
  first << 0.0, -p[2], p[1], p[2], 0.0, -p[0], -p[1], p[0], 0.0;
  second << q[1] + q[2], -q[3], -q[5], -q[3], q[2] + q[0], -q[4], -q[5], -q[4], q[0] + q[1];
  inertia.bottomLeftCorner<3, 3>() = first;
  inertia.topRightCorner<3, 3>() = first.transpose();
  inertia.bottomRightCorner<3, 3>() = second;
  return inertia;
}

}  // namespace

Vector6 acting_at(const Vector3& x, const Vector3& force) {
  Vector6 wrench;
  wrench << force, x.cross(force);
  return wrench;
}

CarriedRubber::CarriedRubber(const LatticeModel& model)
    : model_(&model), moves_(model.is_particle.begin(), model.is_particle.end()) {
  for (const std::uint32_t block : model.blocks) {
    const Vector3 start = model.grid.axes.transpose() * model.rest_position(block);
    starts_.push_back({start[0], start[1], start[2]});
  }
}

CarriedRubber::Scratch CarriedRubber::scratch() const {
  return {std::vector<std::array<double, 16>>((model_->blocks.size() + blocks_per_sum - 1) /
                                              blocks_per_sum)};
}

void CarriedRubber::load(const Vector6& motion, const std::vector<double>& gain, const State& state,
                         Team& team, const VectorField& force, MultigridFields::Field& load) const {
  sweeps::BodyArrays body = arrays(*model_, state, starts_.data());
  for (std::size_t c = 0; c < 3; ++c) {
    body.force[c] = force.component[c].data();
    body.load[c] = load[c].data();
  }
  body.gain = gain.data();
  team.split(model_->blocks.size(), blocks_per_sum, [&](std::size_t begin, std::size_t end) {
    body_loops().load(body, begin, end, motion.data());
  });
}

CarriedRubber::Sums CarriedRubber::sums(const MultigridFields::Field& acceleration,
                                        const State& state, Team& team, Scratch& scratch) const {
  sweeps::BodyArrays body = arrays(*model_, state, starts_.data());
  for (std::size_t c = 0; c < 3; ++c) body.acceleration[c] = acceleration[c].data();
  const std::size_t blocks = model_->blocks.size();
  team.split(scratch.partial.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t first = p * blocks_per_sum, last = std::min(blocks, first + blocks_per_sum);
      body_loops().sum(body, first, last, scratch.partial[p].data());
    }
  });
  std::array<double, 16> total{};
  for (const auto& part : scratch.partial)
    for (std::size_t k = 0; k < total.size(); ++k) total[k] += part[k];
  return {model_->sector.whole_on_grid(Vector6(total.data())),
          model_->sector.whole_on_grid(body_inertia(total[6], &total[7], &total[10]))};
}

CarriedRubber::Moved CarriedRubber::move(const Vector6& motion, const Restraint* restraint,
                                         const MultigridFields::Field& acceleration, double step,
                                         Team& team, Scratch& scratch, State& state) const {
  sweeps::BodyArrays body = arrays(*model_, state, starts_.data());
  for (std::size_t c = 0; c < 3; ++c) {
    body.acceleration[c] = acceleration[c].data();
    body.place[c] = state.displacement.component[c].data();
    body.velocity[c] = state.velocity.component[c].data();
  }
  body.moves = moves_.data();
  sweeps::Patch patch{};
  if (restraint != nullptr) {
    const Vector3 moved = motion.head<3>() + motion.tail<3>().cross(restraint->centre);
    for (std::size_t n = 0; n < 3; ++n) {
      const Vector3& direction = restraint->directions[n];
      Vector3::Map(patch.part[n]) = direction.dot(moved) * direction;
      body.share[n] = restraint->share[n].data();
    }
  }
  const std::size_t blocks = model_->blocks.size();
  team.split(scratch.partial.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t first = p * blocks_per_sum, last = std::min(blocks, first + blocks_per_sum);
      double* const sums = scratch.partial[p].data();
      if (restraint != nullptr) {
        body_loops().move_restrained(body, first, last, motion.data(), patch, step, sums);
      } else {
        body_loops().move(body, first, last, motion.data(), step, sums);
      }
    }
  });
  Vector6 momentum = Vector6::Zero(), kept = Vector6::Zero();
  double kinetic_energy = 0.0;
  for (const auto& part : scratch.partial) {
    momentum.head<3>() += Vector3(part.data());
    kinetic_energy += 0.5 * part[3];
    if (restraint != nullptr) kept += Vector6(part.data() + 4);
  }
  const Sector& sector = model_->sector;
  return {sector.whole_on_grid(momentum).head<3>(), sector.count() * kinetic_energy,
          sector.whole_on_grid(kept)};
}

}  // namespace fingertip::lattice::inline dynamics::inline scaling
