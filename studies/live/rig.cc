#include "studies/live/rig.h"

#include <algorithm>
#include <cmath>

#include "lattice/dynamics/time_step.h"

namespace fingertip::studies::inline live {

using meshes::Vector3;

namespace {

/// Of the rubber's thickness: deeper no lattice of a live view is asked to go.
constexpr double deepest = 0.7;

lattice::PressSetup under_control(lattice::PressSetup setup) {
  setup.protocol.mode = meshes::DriveMode::pid;
  setup.protocol.program.clear();  // here a person moves the set point
  setup.protocol.twist = 0.0;
  return setup;
}

LiveLimits limits_for(const lattice::PressSetup& setup) {
  LiveLimits limits;
  limits.depth = {-setup.protocol.clearance,
                  std::max(setup.protocol.depth, deepest * setup.geometry.thickness())};
  const auto reach = [](Span& span, double value) {
    span = {std::min(span.least, value), std::max(span.most, value)};
  };
  reach(limits.speed, setup.protocol.speed);
  reach(limits.natural_frequency, setup.controller.natural_frequency);
  reach(limits.derivative_filter, setup.controller.derivative_filter);
  limits.reach = 2.0 * setup.geometry.tip_radius;
  return limits;
}

/// About the configured force; at the lower end the touch is still noticed.
Span contact_forces(const lattice::ForceSettings& settings) {
  const double least = std::max(0.2 * settings.force, 1.5 * settings.touch_force);
  return {std::min(least, settings.force), 3.0 * settings.force};
}

double within(double value, const Span& span) {
  return std::clamp(value, span.least, span.most);
}

/// With the step that a live lattice takes: its scaled masses know no press to choose one for.
lattice::PressSetup at_speed(lattice::PressSetup setup, double speed) {
  setup.protocol.speed = speed;
  if (!setup.time_step) setup.time_step = lattice::usual_scaled_step;
  return setup;
}

/// Of `setup` one of `sectors` parts.
std::unique_ptr<lattice::VirtualFinger> finger_of(const lattice::PressSetup& setup,
                                                  const lattice::PressWay& way, int sectors) {
  lattice::FingerSetup finger = lattice::finger_setup(setup, way);
  finger.sectors = sectors;
  return std::make_unique<lattice::VirtualFinger>(finger);
}

lattice::MarkerPoints markers_of(const lattice::PressSetup& setup,
                                 const lattice::LatticeModel& model) {
  return {setup, model.sector.count(), lattice::rest_places(model)};
}

}  // namespace

LiveRig::LiveRig(const lattice::PressSetup& setup)
    : setup_(under_control(setup)),
      way_(setup_.protocol, setup_.geometry),
      finger_(finger_of(setup_, way_, lattice::moving_sectors(setup_))),
      tip_(std::make_unique<lattice::WholeTip>(setup_, finger_->model())),
      markers_(markers_of(setup_, finger_->model())),
      limits_(limits_for(setup_)),
      set_point_(setup.protocol.speed, setup.protocol.clearance + setup.protocol.depth,
                 setup.protocol.clearance, setup.controller.period),
      estimator_(at_speed(setup_, setup.protocol.speed)) {
  settings_ = {setup.protocol.speed, setup.protocol.depth, setup.controller.natural_frequency,
               setup.controller.derivative_filter, setup.controller.bond_compensation};
  lattice::ControlTask task = lattice::control_task(setup_, way_, finger_->rod_body());
  const Vector3 start = finger_->rod_body().endpoint;
  task.path = [this, start](double) { return way_.at(start, set_point_.now()); };
  std::unique_ptr<lattice::Controller> inner;
  if (setup_.make_controller) inner = setup_.make_controller(task);
  controller_ = std::make_unique<LiveController>(std::move(inner), task, setup_.controller);
  if (const lattice::HoldsForce* held = controller_->force_loop()) {
    settings_.contact_force = held->force_settings().force;
    limits_.contact_force = contact_forces(held->force_settings());
  }
  loop_ = std::make_unique<lattice::ControlLoop>(*finger_, *controller_, setup_.hardware,
                                                 setup_.controller, task.period);
}

void LiveRig::go_on_with(const lattice::PressSetup& setup, int sectors) {
  lattice::PressSetup next = under_control(setup);
  auto finger = finger_of(next, way_, sectors);
  auto tip = std::make_unique<lattice::WholeTip>(next, finger->model());
  auto markers = markers_of(next, finger->model());
  lattice::State state = tip_->state_of(finger_->model(), finger_->finger().state());
  if (sectors > 1 || next.lattice.spacing != setup_.lattice.spacing)
    state = lattice::carried_over(tip_->model(), state, finger->model());
  finger->take_over(*finger_, std::move(state));
  loop_->go_on_with(*finger);
  finger_ = std::move(finger);
  tip_ = std::move(tip);
  markers_ = std::move(markers);
  setup_ = std::move(next);
  estimator_ = lattice::ForceEstimator(at_speed(setup_, settings_.speed));
  ++lattices_;
}

void LiveRig::go_on_whole(const lattice::PressSetup& setup) {
  if (sectors() > 1) part_ = {setup_, sectors()};
  go_on_with(setup, 1);
}

double LiveRig::indentation() const {
  return way_.indentation(finger_->rod_body().endpoint, finger_->finger().rod().endpoint(),
                          setup_.protocol.clearance);
}

void LiveRig::advance() {
  finger_->finger().note_energy();
  loop_->sample();
  loop_->advance();
  set_point_.advance();
  check_sanity();
}

void LiveRig::check_sanity() const {
  const lattice::Finger::Energy& energy = finger_->finger().noted_energy();  // a period ago
  const double largest = 1e3 * setup_.rubber.longitudinal_modulus() * setup_.geometry.tip_volume();
  const Vector3 travel = finger_->finger().rod().endpoint() - finger_->rod_body().endpoint;
  if (!(energy.kinetic + energy.elastic < largest))
    throw meshes::NotConverged("the lattice blew up");
  const meshes::Geometry& finger = setup_.geometry;
  const double size =
      finger.is_dome() ? finger.rod_length : finger.tip_radius + finger.pole() - finger.lowest();
  if (!(travel.norm() < 10.0 * size)) {
    throw meshes::NotConverged("the rod flew away");
  }
}

void LiveRig::reset() {
  if (part_) go_on_with(part_->setup, part_->sectors);
  part_.reset();
  loop_->reset();
  set_point_.restart(0.0);
}

void LiveRig::set(const LiveSettings& wanted) {
  LiveSettings next = wanted;
  for (const Slider& slider : sliders)
    next.*slider.value = within(wanted.*slider.value, limits_.*slider.limits);
  set_point_.want(next.speed, setup_.protocol.clearance + next.depth);
  const bool other_gains = next.natural_frequency != settings_.natural_frequency ||
                           next.derivative_filter != settings_.derivative_filter ||
                           next.bond_compensation != settings_.bond_compensation;
  if (other_gains) {
    lattice::PidSettings servo = controller_->servo();
    servo.natural_frequency = next.natural_frequency;
    servo.derivative_filter = next.derivative_filter;
    servo.bond_compensation = next.bond_compensation;
    controller_->set_servo(servo);
  }
  next.contact_force = 0.0;
  if (limits_.contact_force) {
    next.contact_force = within(wanted.contact_force, *limits_.contact_force);
    controller_->force_loop()->set_force(next.contact_force);
  }
  if (next.controller && !controller_->on()) {
    // The way is taken up where the rod is now, so that it is not torn there.
    set_point_.restart(indentation() + setup_.protocol.clearance);
  }
  controller_->switch_on(next.controller);
  if (next.speed != settings_.speed)
    estimator_ = lattice::ForceEstimator(at_speed(setup_, next.speed));
  settings_ = next;
}

void LiveRig::hold(const Vector3& place) {
  if (sectors() > 1) go_on_whole(setup_);
  const Vector3 start = finger_->rod_body().endpoint;
  const Vector3 reach = Vector3::Constant(limits_.reach);
  controller_->hand().hold((place - start).cwiseMin(reach).cwiseMax(-reach) + start);
}

LiveRow LiveRig::row() const {
  const lattice::RodState& rod = finger_->finger().rod();
  LiveRow row;
  row.time = finger_->time();
  row.indentation = indentation();
  row.normal_force = finger_->finger().bond().force.dot(way_.plane.normal);
  row.speed = -rod.velocity_at(rod.endpoint()).dot(way_.plane.normal);
  row.commanded_speed = set_point_.now().speed;
  row.tilt = Eigen::AngleAxisd(rod.pose().orientation).angle();
  return row;
}

double LiveRig::force_error(const LiveRow& row, const lattice::Measurement& measured) const {
  if (!measured.contact) return meshes::unknown;
  meshes::PressSample sample;
  sample.indentation = row.indentation;
  sample.normal_force = row.normal_force;
  sample.contact_radius = measured.contact->radius;
  const auto estimate = estimator_.of(sample);
  return estimate ? estimate->sum() * sample.normal_force : meshes::unknown;
}

LivePicture LiveRig::picture() {
  LivePicture picture;
  picture.row = row();
  picture.measured = finger_->read();
  picture.commanded = loop_->commanded();
  picture.hand = controller_->hand().last();
  picture.hand_place = controller_->hand().place();
  picture.force_error = force_error(picture.row, picture.measured);
  picture.finger = tip_->picture(finger_->finger(), picture.row.indentation);
  picture.markers = markers_.places(finger_->model(), finger_->finger().state());
  return picture;
}

}  // namespace fingertip::studies::inline live
