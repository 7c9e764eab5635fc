#include "lattice/press/press_recorder.h"

#include <algorithm>
#include <cmath>

#include "lattice/press/whole_tip.h"
#include "meshes/press/contact_patch.h"

namespace fingertip::lattice::inline press {

using meshes::PressSample, meshes::Vector3;

namespace {

constexpr int even_depths = 60;

}  // namespace

PressRecorder::PressRecorder(const PressSetup& setup, const meshes::PressMotion& motion,
                             const Plane& plane, const Finger& finger, PressOutcome& outcome)
    : normal_(plane.normal),
      lateral_(setup.protocol.lateral != 0.0),
      prescribed_(setup.protocol.mode == meshes::DriveMode::quasi_static),
      program_(!setup.protocol.program.empty()),
      finger_(&finger),
      marked_(setup.protocol.markers),
      markers_(setup, finger.model().sector.count(), rest_places(finger.model())),
      outcome_(&outcome) {
  const meshes::PressProtocol& protocol = setup.protocol;
  const double end = motion.stages().front().to;
  auto samples = depths_on_the_way(protocol, 0.0, end);
  if (program_) samples.pop_back();
  depths_ = samples;
  for (int i = 1; i <= even_depths; ++i) {
    const double depth = protocol.depth * i / even_depths;
    const auto same = [&](double sample) {
      return std::abs(sample - depth) < 1e-6 * protocol.depth;
    };
    const bool beyond = program_ && (depth > end || same(end));
    if (!beyond && std::none_of(samples.begin(), samples.end(), same)) depths_.push_back(depth);
  }
  std::sort(depths_.begin(), depths_.end());
  for (const double depth : depths_) {
    is_sample_.push_back(std::find(samples.begin(), samples.end(), depth) != samples.end());
    times_.push_back(motion.time_at(depth));
  }
  previous_.indentation = -protocol.clearance;
  if (!program_) return;
  for (const meshes::MotionSample& sample : motion.samples())
    if (sample.time >= motion.stages().front().end) later_.push_back(sample);
  for (const meshes::MotionSample& sample : later_) times_.push_back(sample.time);
}

PressSample PressRecorder::sample_between(const PressInstant& end, double fraction,
                                          std::size_t stage) {
  const auto between = [fraction](const auto& from, const auto& to) {
    return (from + fraction * (to - from));
  };
  const Vector3 force = between(previous_.bond.force, end.bond.force).eval();
  const Vector3 torque = between(previous_.bond.torque, end.bond.torque).eval();
  const Vector3 t1 = first_tangent(normal_), t2 = t1.cross(normal_);
  PressSample sample;
  sample.indentation = between(previous_.indentation, end.indentation);
  sample.normal_force = force.dot(normal_);
  sample.lateral_force_x = force.dot(t1);
  sample.lateral_force_y = force.dot(t2);
  sample.torque_x = torque.x();
  sample.torque_y = torque.y();
  sample.torque_z = torque.z();
  if (finger_->has_field()) {
    sample.contact_radius = contact_radius(field());
    sample.max_pressure = largest_pressure(field());
  } else {
    sample.contact_radius = finger_->contact_patch().radius;
    sample.max_pressure = meshes::unknown;
  }
  if (stage == 0)
    move(sample, {&PressSample::contact_radius, &PressSample::max_pressure}, end.indentation,
         sample.indentation);
  sample.set_contact(sample.contact_radius, sample.max_pressure);
  sample.time = between(previous_.time, end.time);
  if (lateral_) sample.lateral_displacement = between(previous_.lateral, end.lateral);
  if (program_) sample.stage = double(stage + 1);
  return sample;
}

/// Brings what a sample has `from` an indentation to another one beside it, along the chord from
/// the last row.
void PressRecorder::move(PressSample& sample, std::initializer_list<double PressSample::*> values,
                         double from, double to) const {
  const auto& rows = outcome_->response.samples();
  if (rows.empty()) return;
  const PressSample& last = rows.back();
  const double way = from - last.indentation;
  if (!(way > std::abs(to - from))) return;
  for (const auto value : values)
    if (!std::isnan(last.*value))  // of the published model
      sample.*value += (to - from) / way * (sample.*value - last.*value);
}

PressSample PressRecorder::sample_at(const PressInstant& end, const meshes::MotionSample& wanted) {
  const double lasts = end.time - previous_.time;
  PressSample sample =
      sample_between(end, lasts > 0.0 ? (wanted.time - previous_.time) / lasts : 1.0, wanted.stage);
  sample.time = wanted.time;
  if (prescribed_) sample.indentation = wanted.indentation;
  // A controller may leave the end of the first loading a hair's breadth away: what belongs to it
  // is brought there, so that it can be told at the depth that was asked for.
  constexpr double hair = 0.01;
  const double beside = wanted.indentation - sample.indentation;
  if (wanted.stage > 0 || outcome_->response.empty() ||
      std::abs(beside) > hair * wanted.indentation)
    return sample;
  move(sample,
       {&PressSample::normal_force, &PressSample::lateral_force_x, &PressSample::lateral_force_y,
        &PressSample::torque_x, &PressSample::torque_y, &PressSample::torque_z,
        &PressSample::contact_radius, &PressSample::max_pressure},
       sample.indentation, wanted.indentation);
  sample.set_contact(sample.contact_radius, sample.max_pressure);
  sample.indentation = wanted.indentation;
  return sample;
}

/// Of the rod on the rubber: the bond's force along the way.
void PressRecorder::add_work(const PressInstant& end) {
  const Vector3 force = 0.5 * (previous_.bond.force + end.bond.force);
  const double work = force.dot(normal_) * (end.indentation - previous_.indentation) +
                      force.dot(first_tangent(normal_)) * (end.lateral - previous_.lateral);
  outcome_->work += work;
  outcome_->work_in += std::max(work, 0.0);
}

/// For the last row; the contact's field is that of the last step, at an indentation [m].
void PressRecorder::note_fields(double indentation) {
  if (!field().empty()) outcome_->response.back().spin_torque = spin_torque(field());
  add_sample(field(), int(outcome_->response.samples().size()), indentation, outcome_->contact);
  note_markers();
}

/// For the last row, at its time: velocities lead back to it from the end of the step.
void PressRecorder::note_markers() {
  if (markers_.empty()) return;
  const RodState& rod = finger_->rod();
  const PressSample& sample = outcome_->response.back();
  const double ahead = sample.time - finger_->time();
  std::vector<Vector3> displacements = markers_.places(finger_->model(), finger_->state(), ahead);
  for (std::size_t i = 0; i < marked_.size(); ++i) {
    const Vector3 carried = rod.pose() * marked_[i];
    displacements[i] = rod.pose().orientation.inverse() *
                       (displacements[i] - carried - ahead * rod.velocity_at(carried));
  }
  add_sample(meshes::marker_rows(marked_, displacements), int(outcome_->response.samples().size()),
             sample.indentation, outcome_->markers);
}

/// Of the finger after its last step.
const std::vector<meshes::ContactPoint>& PressRecorder::field() {
  if (!has_field_) field_ = finger_->contact_field();
  has_field_ = true;
  return field_;
}

bool PressRecorder::add_step(const PressInstant& start) {
  has_field_ = false;
  plane_impulse_ += finger_->plane_impulse().force.dot(normal_);
  if (std::isnan(outcome_->first_touch_time) && finger_->touching() > 0) {
    outcome_->first_touch_time = finger_->time();
  }
  bool passed_sample = false;
  while (next_later_ == 0 && next_ < depths_.size() && start.indentation >= depths_[next_]) {
    const double way = start.indentation - previous_.indentation;
    PressSample sample = sample_between(start, (depths_[next_] - previous_.indentation) / way, 0);
    sample.indentation = depths_[next_];
    outcome_->response.append(sample);
    if (is_sample_[next_] != 0) note_fields(start.indentation);
    passed_sample = passed_sample || is_sample_[next_] != 0;
    ++next_;
  }
  for (; next_later_ < later_.size() && start.time >= later_[next_later_].time; ++next_later_) {
    outcome_->response.append(sample_at(start, later_[next_later_]));
    note_fields(start.indentation);
    passed_sample = true;
  }
  add_work(start);
  previous_ = start;
  return passed_sample;
}

std::optional<double> PressRecorder::next_time(double after) const {
  const auto found = std::upper_bound(times_.begin(), times_.end(), after);
  return found != times_.end() ? std::optional(*found) : std::nullopt;
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
  row.rod_kinetic_energy = rod.kinetic_energy();
  outcome_->trace.push_back(row);
  plane_impulse_ = 0.0;
  plane_since_ = now.time;
}

void PressRecorder::set_energy(const Finger::Energy& energy) {
  outcome_->trace.back().kinetic_energy = energy.kinetic;
  outcome_->trace.back().elastic_energy = energy.elastic;
}

void PressRecorder::update(double wall_time) {
  outcome_->simulated_time = finger_->time();
  outcome_->wall_time = wall_time;
  outcome_->momentum_defect = finger_->largest_impulse() > 0.0
                                  ? finger_->momentum_defect() / finger_->largest_impulse()
                                  : 0.0;
}

}  // namespace fingertip::lattice::inline press
