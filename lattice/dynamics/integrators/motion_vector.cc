#include "lattice/dynamics/integrators/motion_vector.h"

#include <algorithm>
#include <cmath>

namespace fingertip::lattice::inline dynamics::inline integrators {

using meshes::Vector3;

namespace {

using Entries = Eigen::Map<Vector3>;
using ConstEntries = Eigen::Map<const Vector3>;

void gather(const LatticeModel& model, const VectorField& field, double* to) {
  for (const auto& component : field.component) {
    for (const std::uint32_t block : model.blocks) {
      to = std::copy_n(component.data() + block, lanes, to);
    }
  }
}

void scatter(const LatticeModel& model, const double* from, VectorField& field) {
  for (auto& component : field.component) {
    for (const std::uint32_t block : model.blocks) {
      std::copy_n(from, lanes, component.data() + block);
      from += lanes;
    }
  }
}

}  // namespace

MotionVector::MotionVector(const LatticeModel& model)
    : model_(&model),
      velocity_(3 * lanes * model.blocks.size()),
      rod_(2 * velocity_),
      impulse_(rod_ + rod_entries) {}

void MotionVector::write(const State& state, const RodState& rod, double* y) const {
  gather(*model_, state.displacement, y);
  gather(*model_, state.velocity, y + velocity_);
  double* r = y + rod_;
  Entries{r} = rod.centre();
  Eigen::Map<Eigen::Vector4d>{r + 3} = rod.pose().orientation.coeffs();
  Entries{r + 7} = rod.momentum();
  Entries{r + 10} = rod.angular_momentum();
  std::fill_n(y + impulse_, impulse_entries, 0.0);
}

void MotionVector::read(const double* y, State& state, RodState& rod) const {
  scatter(*model_, y, state.displacement);
  scatter(*model_, y + velocity_, state.velocity);
  const double* r = y + rod_;
  const Eigen::Quaterniond orientation{Eigen::Map<const Eigen::Vector4d>{r + 3}};
  rod.set_state(ConstEntries{r}, orientation, ConstEntries{r + 7}, ConstEntries{r + 10});
}

void MotionVector::write_rates(const State& state, const VectorField& force,
                               const CutSurfaces::Trial& exerted, double* rates) const {
  gather(*model_, state.velocity, rates);
  double* acceleration = rates + velocity_;
  for (const auto& component : force.component) {
    for (const std::uint32_t block : model_->blocks) {
      for (std::size_t i = block; i < block + lanes; ++i) {
        *acceleration++ = model_->inverse_mass[i] * component[i];
      }
    }
  }
  std::fill_n(rates + rod_, rod_entries, 0.0);
  double* impulse = rates + impulse_;
  Entries{impulse} = exerted.plane.force;
  Entries{impulse + 3} = exerted.plane.torque;
  Entries{impulse + 6} = exerted.bond.force;
}

void MotionVector::write_rod_rates(const RodState& rod, const Wrench& at_endpoint,
                                   const Vector3& weight, double* rates) const {
  double* r = rates + rod_;
  const Eigen::Quaterniond orientation = rod.pose().orientation;
  const Vector3 spin = rod.angular_velocity();
  Entries{r} = rod.velocity();
  Eigen::Map<Eigen::Vector4d>{r + 3} =
      0.5 * (Eigen::Quaterniond(0.0, spin.x(), spin.y(), spin.z()) * orientation).coeffs();
  Entries{r + 7} = at_endpoint.force + weight;
  Entries{r + 10} = at_endpoint.torque + (rod.endpoint() - rod.centre()).cross(at_endpoint.force);
}

MotionVector::Impulses MotionVector::impulses(const double* y) const {
  const double* i = y + impulse_;
  return {{ConstEntries{i}, ConstEntries{i + 3}}, ConstEntries{i + 6}};
}

void MotionVector::write_scales(const RodState& rod, double frequency, double* scales) const {
  const double length = 0.01 * model_->spacing(), speed = length * frequency;
  std::fill_n(scales, velocity_, length);
  std::fill_n(scales + velocity_, velocity_, speed);
  const RodBody& body = rod.body();
  const double angle = length / body.endpoint.norm();
  const double inertia = body.inertia.diagonal().maxCoeff();
  const double importance = std::sqrt(double(rod_entries) / double(rod_));
  double* r = scales + rod_;
  std::fill_n(r, 3, importance * length);
  std::fill_n(r + 3, 4, importance * angle);
  std::fill_n(r + 7, 3, importance * body.mass * speed);
  std::fill_n(r + 10, 3, importance * inertia * angle * frequency);
  std::fill_n(scales + impulse_, impulse_entries, 1e30);
}

}  // namespace fingertip::lattice::inline dynamics::inline integrators
