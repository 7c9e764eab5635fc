#include "lattice/press.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <sstream>

#include "lattice/control/approach.h"
#include "lattice/control/pid.h"
#include "lattice/cut_model.h"
#include "lattice/finger.h"
#include "lattice/press_recorder.h"
#include "lattice/time_step.h"

namespace fingertip::lattice {

using meshes::Vector3;

namespace {

using Clock = std::chrono::steady_clock;

LatticeCensus take_census(const PressSetup& setup, const LatticeModel& model) {
  LatticeCensus census;
  census.particles = model.particles.size();
  census.springs = model.spring_count();
  census.cells = model.cells.size();
  census.boundary_particles = model.boundary.size();
  census.ligaments = model.ligaments.size() + model.bond.size();
  census.expected_particles =
      meshes::expected_particle_count(setup.geometry, setup.lattice.spacing);
  census.mass = model.total_mass();
  census.added_mass = model.added_mass;
  census.exact_mass = setup.rubber.density * setup.geometry.tip_volume();
  return census;
}

/// The rod's straight way toward the plane (and along it, if it moves laterally).
struct Way {
  PressPlane plane;
  Vector3 direction;  ///< travel per distance along the plane's normal

  Way(const meshes::PressProtocol& protocol, const meshes::Geometry& geometry)
      : plane(press_plane(protocol, geometry)),
        direction(-plane.normal - plane.lateral_ratio * plane.t1) {}
};

/// One press from start to depth. The tip hangs straight in its frame, the plane may be tilted.
class Press {
 public:
  Press(const PressSetup& setup, const PressObserver& observer);
  PressOutcome run();

 private:
  double indentation() const;
  void make_controller();
  bool must_rethink() const;
  void choose_step();
  PressInstant now() const { return {finger_->time(), indentation(), finger_->bond()}; }
  void step_once();
  void sample_controller();
  void look_after();  // once per period: trace, observer, sanity
  void check_sanity();
  void report(bool in_any_case);
  [[noreturn]] void give_up(const std::string& why);
  double wall_time() const {
    return std::chrono::duration<double>(Clock::now() - started_).count();
  }

  const PressSetup& setup_;
  const PressObserver& observer_;
  PressOutcome outcome_;
  LatticeModel model_;
  RodBody rod_;
  Way way_;
  Plane plane_;
  Approach approach_;
  StepController steps_;
  std::unique_ptr<Finger> finger_;
  std::unique_ptr<PressRecorder> recorder_;
  std::unique_ptr<Controller> controller_;  // null when the motion is prescribed
  Wrench applied_;
  PressInstant start_of_step_;
  double next_period_ = 0.0;
  double time_limit_ = 0.0;
  Clock::time_point started_, last_report_;
};

Press::Press(const PressSetup& setup, const PressObserver& observer)
    : setup_(setup),
      observer_(observer),
      model_(build_tip(setup.geometry, setup.rubber, setup.lattice)),
      rod_(rod_body(setup.geometry, setup.rod)),
      way_(setup.protocol, setup.geometry),
      plane_{way_.plane.point(-setup.protocol.clearance), way_.plane.normal},
      approach_(setup.protocol.speed, setup.protocol.clearance),
      steps_(model_, setup.protocol.mode == meshes::DriveMode::quasi_static ? nullptr : &rod_,
             setup.integrator, setup.time_step) {
  const meshes::PressProtocol& protocol = setup.protocol;
  const double step = steps_.divide(setup.controller.period, {});
  outcome_.census = take_census(setup, model_);
  outcome_.step = steps_.report(step);
  outcome_.step.smallest = step;
  finger_ = std::make_unique<Finger>(model_, rod_, plane_, protocol.contact, setup.integrator, step,
                                     setup.threads);
  recorder_ = std::make_unique<PressRecorder>(protocol, setup.geometry, plane_, *finger_, outcome_);
  if (protocol.mode == meshes::DriveMode::pid) make_controller();
  time_limit_ = 2.0 * approach_.time_at(protocol.clearance + protocol.depth) + 0.5;
}

void Press::make_controller() {
  const Vector3 start = rod_.endpoint;
  controller_ = std::make_unique<Pid>(
      setup_.controller, rod_.inertia_at_endpoint(), [this, start](double time) {
        const SetPoint point = approach_.at(time);
        return Target{start + point.distance * way_.direction, point.speed * way_.direction,
                      point.acceleration * way_.direction};
      });
}

double Press::indentation() const {
  return (rod_.endpoint - finger_->rod().endpoint()).dot(plane_.normal) - setup_.protocol.clearance;
}

bool Press::must_rethink() const {
  const CellExtremes& cells = finger_->extremes();
  return steps_.outdated(cells) || finger_->step() > steps_.limit(cells) ||
         !(cells.smallest_jacobian > 0.0);
}

/// At the start of a period, and whenever the cells have grown too stiff for the present step.
void Press::choose_step() {
  const CellExtremes& cells = finger_->extremes();
  if (!(cells.smallest_jacobian > 0.0)) give_up("a cell was turned inside out");
  if (steps_.outdated(cells)) steps_.update(finger_->state(), cells);
  const double span = next_period_ - finger_->time();
  const double step = steps_.divide(span, cells);
  if (!(step > 1e-4 * outcome_.step.step)) give_up("cells are pressed flat");
  finger_->set_step(step);
  outcome_.step.smallest = std::min(outcome_.step.smallest, step);
}

void Press::sample_controller() {
  const RodState& rod = finger_->rod();
  Measurement m;
  m.time = finger_->time();
  m.position = rod.endpoint();
  m.orientation = rod.pose().orientation;
  m.velocity = rod.velocity_at(rod.endpoint());
  m.angular_velocity = rod.angular_velocity();
  m.bond = finger_->bond();
  applied_ = controller_->command(m);
}

void Press::step_once() {
  start_of_step_ = now();
  if (controller_) {
    finger_->advance(applied_);
  } else {
    const SetPoint end = approach_.at(finger_->time() + finger_->step());
    finger_->advance(RodMotion{end.distance * way_.direction, end.speed * way_.direction});
  }
  start_of_step_.bond = finger_->bond();  // of the configuration the step started from
}

void Press::look_after() {
  PressInstant instant = now();
  const Wrench held = controller_ ? applied_ : Wrench{-instant.bond.force, -instant.bond.torque};
  recorder_->add_trace(instant, approach_.at(instant.time), held);
  check_sanity();
  report(false);
}

void Press::check_sanity() {
  const TraceRow& row = outcome_.trace.back();
  const double largest = 1e3 * setup_.rubber.longitudinal_modulus() * setup_.geometry.tip_volume();
  if (!(row.kinetic_energy + row.elastic_energy < largest)) {
    give_up("the lattice blew up: its energy left every bound");
  }
  const double commanded = approach_.at(row.time).distance - setup_.protocol.clearance;
  const double ahead = row.indentation - commanded;
  const bool lost = row.tilt > 0.5 || !(ahead <= 0.1 * setup_.geometry.thickness());
  if (lost) {
    give_up("the controller lost the rod: controller.natural_frequency is too high for its period");
  }
  if (finger_->time() > time_limit_) {
    give_up("the rod did not reach the depth: the controller's limits are too low");
  }
}

void Press::report(bool in_any_case) {
  if (!observer_) return;
  const Clock::time_point instant = Clock::now();
  if (!in_any_case && instant - last_report_ < std::chrono::milliseconds(100)) return;
  last_report_ = instant;
  recorder_->update(wall_time());
  const double total = setup_.protocol.clearance + setup_.protocol.depth;
  const double done = (indentation() + setup_.protocol.clearance) / total;
  if (!observer_(outcome_, std::clamp(done, 0.0, 1.0))) {
    throw meshes::Interrupted("the press was stopped at an indentation of " +
                              std::to_string(indentation()) + " m");
  }
}

void Press::give_up(const std::string& why) {
  recorder_->update(wall_time());
  if (observer_) observer_(outcome_, 0.0);
  std::ostringstream text;
  text << why << " (at " << finger_->time() << " s, indentation " << start_of_step_.indentation
       << " m, step " << finger_->step() << " s)";
  throw meshes::NotConverged(text.str());
}

PressOutcome Press::run() {
  started_ = last_report_ = Clock::now();
  while (start_of_step_.indentation < setup_.protocol.depth) {
    if (finger_->time() >= next_period_ - 1e-6 * finger_->step()) {
      if (controller_) sample_controller();
      look_after();
      next_period_ += setup_.controller.period;
      choose_step();
    } else if (must_rethink()) {
      choose_step();
    }
    step_once();
    if (recorder_->add_step(start_of_step_)) report(true);
  }
  look_after();  // a rod that ran away within the last period must not pass for a finished press
  recorder_->update(wall_time());
  if (observer_) observer_(outcome_, 1.0);
  return std::move(outcome_);
}

}  // namespace

PressOutcome run_press(const PressSetup& setup, const PressObserver& observer) {
  const auto violations = setup.violations();
  if (!violations.empty()) throw meshes::InvalidInput(violations);
  Press press(setup, observer);
  return press.run();
}

}  // namespace fingertip::lattice
