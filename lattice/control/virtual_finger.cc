#include "lattice/control/virtual_finger.h"

#include <algorithm>
#include <utility>

#include "lattice/dynamics/integrators/make_stepper.h"
#include "lattice/dynamics/thread_choice.h"
#include "lattice/model/cut_model.h"
#include "meshes/cells/cubic_grid.h"

namespace fingertip::lattice::inline control {

namespace {

int threads_for(const FingerSetup& setup) {
  if (setup.threads != 0) return setup.threads;
  const double particles =
      meshes::expected_particle_count(setup.geometry, setup.lattice.spacing) / setup.sectors;
  return fastest_threads(particles, machine_cores());
}

}  // namespace

VirtualFinger::VirtualFinger(const FingerSetup& setup)
    : setup_(setup),
      model_(build_tip(setup.geometry, setup.rubber, setup.lattice, setup.sectors)),
      rod_(lattice::rod_body(setup.geometry, setup.rod)),
      team_(threads_for(setup)),
      steps_(model_, setup.prescribed ? nullptr : &rod_, setup.integrator, setup.time_step, team_) {
  const double step = steps_.at_rest(1.0);
  finger_ = std::make_unique<Finger>(model_, rod_, setup.plane, setup.contact, setup.integrator,
                                     step, team_);
  finger_->set_gravity(setup.gravity);
  const double tip = setup.geometry.tip_radius;
  stepper_ = make_stepper({setup.integrator, setup.time_step, setup.tolerance, setup.energy_bound,
                           setup.rubber.youngs_modulus * tip * tip * tip},
                          *finger_, steps_);
  if (setup.prescribed) drive_ = Motion([](double) { return RodMotion{}; });
  start_ = save();
}

Measurement VirtualFinger::read() const {
  const RodState& rod = finger_->rod();
  const meshes::Vector3 endpoint = rod.endpoint();
  Measurement m;
  m.time = finger_->time();
  m.pose = {endpoint, rod.pose().orientation};
  m.twist = {rod.velocity_at(endpoint), rod.angular_velocity()};
  m.wrench = finger_->bond();
  const Wrench& impulse = finger_->plane_impulse();
  const meshes::Vector3 force = impulse.force / finger_->step();
  m.contact = ContactState{finger_->touching(),
                           finger_->contact_patch().radius,
                           {force, impulse.torque / finger_->step() - endpoint.cross(force)}};
  if (setup_.skin.taxels.empty()) return m;
  // As the rod sees it, which may have turned.
  const Eigen::Matrix3d from_plane = field_axes(finger_->plane().normal),
                        to_rod = rod.pose().orientation.conjugate().toRotationMatrix() * from_plane;
  std::vector<meshes::ContactPoint> field = finger_->contact_field();
  for (meshes::ContactPoint& point : field) {
    point.rest = from_plane * point.rest;
    for (meshes::Vector3* vector : {&point.place, &point.shear, &point.normal})
      *vector = to_rod * *vector;
  }
  m.taxels = taxel_readings(field, setup_.skin);
  return m;
}

void VirtualFinger::write(const Wrench& applied) {
  drive_ = model_.sector.even(applied);
}

void VirtualFinger::write(Motion motion) {
  drive_ = std::move(motion);
}

StepReport VirtualFinger::step_report(double period) const {
  StepReport report = steps_.report(steps_.at_rest(period));
  const double smallest = stepper_->count().smallest;
  report.smallest = smallest > 0.0 ? std::min(report.step, smallest) : report.step;
  const std::string more = stepper_->explanation();
  if (!more.empty()) report.explanation += "; " + more;
  return report;
}

bool VirtualFinger::do_step(double duration, const StepObserver& after_step) {
  const double until = finger_->time() + duration;
  bool arrived = true;
  stepper_->begin(drive_, duration);
  while (arrived && finger_->time() < until - 1e-6 * finger_->step()) {
    stepper_->step(drive_, until);
    arrived = !after_step || after_step();
  }
  stepper_->end();
  return arrived;
}

VirtualFinger::Snapshot VirtualFinger::save() const {
  return {finger_->save(), steps_.memory(), stepper_->memory(), drive_};
}

void VirtualFinger::load(const Snapshot& snapshot) {
  finger_->load(snapshot.finger);
  steps_.recall(snapshot.steps);
  stepper_->recall(snapshot.stepper);
  drive_ = snapshot.drive;
}

void VirtualFinger::take_over(const VirtualFinger& other, State state) {
  FingerMemory now = start_.finger.memory;
  now.state = std::move(state);
  now.rod = other.finger_->rod();
  now.plane = other.finger_->plane();
  now.time = other.time();
  finger_->start_at(now);
  drive_ = other.drive_;
}

}  // namespace fingertip::lattice::inline control
