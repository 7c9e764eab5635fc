#include "lattice/press_recorder.h"

#include <algorithm>
#include <cmath>

#include "lattice/cells/cut_tip.h"
#include "lattice/energy.h"

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

constexpr int even_depths = 60;

/// The point of the outer surface nearest to `rest`: cut cells reach beyond it.
Vector3 outer_point(const Vector3& rest, double radius) {
  return Vector3(0.0, 0.0, std::min(rest.z(), 0.0)) + radius * outer_normal(rest);
}

}  // namespace

PressRecorder::PressRecorder(const meshes::PressProtocol& protocol,
                             const meshes::Geometry& geometry, const Plane& plane,
                             const Finger& finger, PressOutcome& outcome)
    : normal_(plane.normal), finger_(&finger), outcome_(&outcome) {
  const auto samples =
      protocol.samples.empty() ? meshes::default_samples(protocol.depth) : protocol.samples;
  depths_ = samples;
  for (int i = 1; i <= even_depths; ++i) {
    const double depth = protocol.depth * i / even_depths;
    const bool known = std::any_of(samples.begin(), samples.end(), [&](double sample) {
      return std::abs(sample - depth) < 1e-6 * protocol.depth;
    });
    if (!known) depths_.push_back(depth);
  }
  std::sort(depths_.begin(), depths_.end());
  for (const double depth : depths_) {
    is_sample_.push_back(std::find(samples.begin(), samples.end(), depth) != samples.end());
  }
  find_boundary(geometry);
}

void PressRecorder::find_boundary(const meshes::Geometry& geometry) {
  const LatticeModel& model = finger_->model();
  std::vector<int> number(model.points(), -1);
  for (std::size_t b = 0; b < model.boundary.size(); ++b) {
    number[model.boundary[b]] = int(b);
    const Vector3 rest = model.rest_position(model.boundary[b]);
    outcome_->boundary_rest.push_back(model.is_cut() ? outer_point(rest, geometry.tip_radius)
                                                     : rest);
  }
  follow_surface(number);
  // Far corners of slivers that no point of the surface hangs on are not part of the picture.
  for (std::size_t b = 0; b < model.boundary.size(); ++b) {
    const bool on_surface = drawn_[b] || outcome_->boundary_rest[b].z() < lowest_contact(geometry);
    if (model.is_cut() && !on_surface) number[model.boundary[b]] = -1;
  }
  for (const std::size_t i : model.boundary) {
    if (number[i] < 0) continue;
    for (int s = 0; s < directions; ++s) {
      if (half_stencil[std::size_t(s)].family != axis) continue;
      const std::size_t j = i + std::size_t(neighbour_offset(model.grid.size, s));
      if (number[j] >= 0) outcome_->boundary_springs.push_back({number[i], number[j]});
    }
  }
}

/// Puts the tied point that is nearest to it in a boundary particle's place.
void PressRecorder::follow_surface(const std::vector<int>& number) {
  drawn_.assign(outcome_->boundary_rest.size(), nullptr);
  const std::vector<Vector3> rest = outcome_->boundary_rest;
  for (const TiedPoint& tie : finger_->model().outer) {
    for (const std::uint32_t corner : tie.corners) {
      if (number[corner] < 0) continue;
      const std::size_t b = std::size_t(number[corner]);
      if (drawn_[b] && (drawn_[b]->rest - rest[b]).norm() <= (tie.rest - rest[b]).norm()) continue;
      drawn_[b] = &tie;
      outcome_->boundary_rest[b] = tie.rest;
    }
  }
}

meshes::PressSample PressRecorder::sample_between(const PressInstant& end,
                                                  double indentation) const {
  const double fraction =
      (indentation - previous_.indentation) / (end.indentation - previous_.indentation);
  const auto between = [fraction](const auto& from, const auto& to) {
    return (from + fraction * (to - from));
  };
  const Vector3 force = between(previous_.bond.force, end.bond.force).eval();
  const Vector3 torque = between(previous_.bond.torque, end.bond.torque).eval();
  const Vector3 t1 = first_tangent(normal_), t2 = t1.cross(normal_);
  meshes::PressSample sample;
  sample.indentation = indentation;
  sample.normal_force = force.dot(normal_);
  sample.lateral_force_x = force.dot(t1);
  sample.lateral_force_y = force.dot(t2);
  sample.torque_x = torque.x();
  sample.torque_y = torque.y();
  sample.torque_z = torque.z();
  sample.contact_radius = finger_->contact_radius();
  sample.time = between(previous_.time, end.time);
  return sample;
}

bool PressRecorder::add_step(const PressInstant& start) {
  plane_impulse_ += finger_->plane_impulse().dot(normal_);
  if (std::isnan(outcome_->first_touch_time) && finger_->touching() > 0) {
    outcome_->first_touch_time = finger_->time();
  }
  bool passed_sample = false;
  while (next_ < depths_.size() && start.indentation >= depths_[next_]) {
    outcome_->response.append(sample_between(start, depths_[next_]));
    passed_sample = passed_sample || is_sample_[next_] != 0;
    ++next_;
  }
  previous_ = start;
  return passed_sample;
}

void PressRecorder::add_trace(const PressInstant& now, const SetPoint& commanded,
                              const Wrench& applied) {
  const RodState& rod = finger_->rod();
  const double elapsed = now.time - plane_since_;
  TraceRow row;
  row.time = now.time;
  row.indentation = now.indentation;
  row.commanded_speed = commanded.speed;
  row.speed = -rod.velocity_at(rod.endpoint()).dot(normal_);
  row.tilt = Eigen::AngleAxisd(rod.pose().orientation).angle();
  row.normal_force = now.bond.force.dot(normal_);
  row.lateral_force = (now.bond.force - normal_ * row.normal_force).norm();
  row.torque = now.bond.torque.norm();
  row.command_force = -applied.force.dot(normal_);
  row.plane_force = elapsed > 0.0 ? plane_impulse_ / elapsed : 0.0;
  row.anchored = finger_->touching();
  row.kinetic_energy = lattice::kinetic_energy(finger_->model(), finger_->state());
  row.elastic_energy = finger_->elastic_energy();
  outcome_->trace.push_back(row);
  plane_impulse_ = 0.0;
  plane_since_ = now.time;
}

void PressRecorder::update(double wall_time) {
  const LatticeModel& model = finger_->model();
  outcome_->simulated_time = finger_->time();
  outcome_->wall_time = wall_time;
  outcome_->momentum_defect = finger_->largest_impulse() > 0.0
                                  ? finger_->momentum_defect() / finger_->largest_impulse()
                                  : 0.0;
  outcome_->boundary_deformed.resize(model.boundary.size());
  outcome_->boundary_anchored = finger_->held();
  const State& state = finger_->state();
  for (std::size_t b = 0; b < model.boundary.size(); ++b) {
    const Vector3 moved =
        drawn_[b] ? shift(*drawn_[b], state, 0.0) : state.displacement.at(model.boundary[b]);
    outcome_->boundary_deformed[b] = outcome_->boundary_rest[b] + model.grid.axes * moved;
  }
}

}  // namespace fingertip::lattice
