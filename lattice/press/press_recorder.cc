#include "lattice/press/press_recorder.h"

#include <algorithm>
#include <cmath>

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

constexpr int even_depths = 60;

}  // namespace

PressRecorder::PressRecorder(const meshes::PressProtocol& protocol, const Plane& plane,
                             const Finger& finger, PressOutcome& outcome)
    : normal_(plane.normal),
      lateral_(protocol.lateral != 0.0),
      finger_(&finger),
      outcome_(&outcome) {
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
  const ContactPatch patch = finger_->contact_patch();
  sample.contact_radius = patch.radius;
  sample.max_pressure = patch.max_pressure;
  sample.time = between(previous_.time, end.time);
  if (lateral_) sample.lateral_displacement = between(previous_.lateral, end.lateral);
  return sample;
}

bool PressRecorder::add_step(const PressInstant& start) {
  plane_impulse_ += finger_->plane_impulse().force.dot(normal_);
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

std::optional<double> PressRecorder::next_depth(double beyond) const {
  const auto found = std::upper_bound(depths_.begin(), depths_.end(), beyond);
  return found != depths_.end() ? std::optional(*found) : std::nullopt;
}

void PressRecorder::add_trace(const PressInstant& now, const meshes::SetPoint& commanded,
                              const Wrench& applied, const ControllerReport& controller) {
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
  row.contact_stiffness = controller.stiffness;
  row.wanted_force = controller.force;
  row.force_mode = controller.mode == ControlMode::force;
  row.anchored = finger_->touching();
  row.sliding = finger_->sliding();
  row.kinetic_energy = finger_->kinetic_energy();
  row.rod_kinetic_energy = rod.kinetic_energy();
  row.elastic_energy = finger_->elastic_energy();
  outcome_->trace.push_back(row);
  plane_impulse_ = 0.0;
  plane_since_ = now.time;
}

void PressRecorder::update(double wall_time) {
  outcome_->simulated_time = finger_->time();
  outcome_->wall_time = wall_time;
  outcome_->momentum_defect = finger_->largest_impulse() > 0.0
                                  ? finger_->momentum_defect() / finger_->largest_impulse()
                                  : 0.0;
}

}  // namespace fingertip::lattice
