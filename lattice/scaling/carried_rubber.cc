#include "lattice/scaling/carried_rubber.h"

#include <algorithm>

#include "lattice/scaling/body_sweeps.h"

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

constexpr std::size_t portion = 64;  // blocks per partial sum: the same for any thread count

sweeps::BodyArrays arrays(const LatticeModel& model, const State& state,
                          const std::array<double, 3>* starts) {
  sweeps::BodyArrays a{};
  for (std::size_t c = 0; c < 3; ++c) a.displacement[c] = state.displacement.component[c].data();
  a.inverse_mass = model.inverse_mass.data();
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

Matrix6 point_inertia(double mass, const Vector3& x) {
  const Vector3 p = mass * x;
  const double q[6] = {p[0] * x[0], p[1] * x[1], p[2] * x[2],
                       p[0] * x[1], p[1] * x[2], p[2] * x[0]};
  return body_inertia(mass, p.data(), q);
}

CarriedRubber::CarriedRubber(const LatticeModel& model) : model_(&model) {
  for (const std::uint32_t block : model.blocks) {
    const Vector3 start = model.grid.axes.transpose() * model.rest_position(block);
    starts_.push_back({start[0], start[1], start[2]});
  }
}

CarriedRubber::Scratch CarriedRubber::scratch() const {
  return {std::vector<std::array<double, 16>>((model_->blocks.size() + portion - 1) / portion)};
}

Vector3 CarriedRubber::position(std::size_t point, const State& state) const {
  return model_->grid.axes.transpose() * model_->rest_position(point) +
         state.displacement.at(point);
}

void CarriedRubber::load(const Vector6& motion, const std::vector<double>& inertia,
                         const State& state, Team& team, const VectorField& force,
                         MultigridFields::Field& load) const {
  sweeps::BodyArrays body = arrays(*model_, state, starts_.data());
  for (std::size_t c = 0; c < 3; ++c) {
    body.force[c] = force.component[c].data();
    body.load[c] = load[c].data();
  }
  body.inertia = inertia.data();
  team.split(model_->blocks.size(), portion, [&](std::size_t begin, std::size_t end) {
    sweeps::load(body, begin, end, motion.data());
  });
}

CarriedRubber::Sums CarriedRubber::sums(const MultigridFields::Field& acceleration,
                                        const State& state, Team& team, Scratch& scratch) const {
  sweeps::BodyArrays body = arrays(*model_, state, starts_.data());
  for (std::size_t c = 0; c < 3; ++c) body.acceleration[c] = acceleration[c].data();
  const std::size_t blocks = model_->blocks.size();
  team.split(scratch.partial.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const std::size_t first = p * portion, last = std::min(blocks, first + portion);
      sweeps::sum_taken(body, first, last, scratch.partial[p].data());
      sweeps::sum_inertia(body, first, last, scratch.partial[p].data() + 6);
    }
  });
  std::array<double, 16> total{};
  for (const auto& part : scratch.partial)
    for (std::size_t k = 0; k < total.size(); ++k) total[k] += part[k];
  return {Vector6(total.data()), body_inertia(total[6], &total[7], &total[10])};
}

void CarriedRubber::accelerate(const Vector6& motion, const MultigridFields::Field& acceleration,
                               const State& state, Team& team, VectorField& force) const {
  sweeps::BodyArrays body = arrays(*model_, state, starts_.data());
  for (std::size_t c = 0; c < 3; ++c) {
    body.acceleration[c] = acceleration[c].data();
    body.result[c] = force.component[c].data();
  }
  team.split(model_->blocks.size(), portion, [&](std::size_t begin, std::size_t end) {
    sweeps::carry(body, begin, end, motion.data());
  });
}

}  // namespace fingertip::lattice
