#include "lattice/press/press.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <memory>
#include <sstream>

#include "lattice/control/control_loop.h"
#include "lattice/control/virtual_finger.h"
#include "lattice/press/press_deviation.h"
#include "lattice/press/press_pictures.h"
#include "lattice/press/press_recorder.h"
#include "lattice/press/press_task.h"
#include "meshes/press/press_motion.h"

namespace fingertip::lattice::inline press {

namespace {

using Clock = std::chrono::steady_clock;

/// Of the calling thread [s].
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

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

/// The finger of a press, or a part of it.
FingerSetup computed_finger(const PressSetup& setup, const PressWay& way) {
  FingerSetup finger = pressed_finger(setup, way);
  finger.sectors = moving_sectors(setup);
  if (!setup.make_controller) finger.skin = {};  // the built-in one does not ask it
  return finger;
}

/// What the actuator lacks, where the rod falls behind: the larger of what was expected and twice
/// what it had.
std::string beyond_its_limits(const PressSetup& setup) {
  const PidSettings& servo = setup.controller;
  const ActuatorLimits suitable = suitable_limits(setup);
  std::ostringstream text;
  text << std::setprecision(3)
       << "the controller's limits are too low, controller.force_limit = " << servo.force_limit
       << " N and controller.torque_limit = " << servo.torque_limit << " N m, where some "
       << expected_force(setup) << " N are expected; take controller.force_limit = \""
       << std::max(suitable.force, 2.0 * servo.force_limit)
       << " N\" and controller.torque_limit = \""
       << std::max(suitable.torque, 2.0 * servo.torque_limit) << " N m\", or press less deep";
  return text.str();
}

/// One press from start to depth, or to the end of its program.
class Press {
 public:
  Press(const PressSetup& setup, const PressObserver& observer, const PressFilm& film);
  PressOutcome run();

 private:
  double indentation() const;
  const LatticeModel& model() const { return finger_.finger().model(); }
  void make_controller();
  void identify(Controller& trial, const std::function<bool()>& done, double longest);
  double lateral() const;
  PressInstant now() const {
    return {finger_.time(), indentation(), lateral(), finger_.finger().bond()};
  }
  bool run_period();
  bool follow_motion();
  bool after_step();
  void look_after();  // once per period: trace, observer, sanity
  void check_sanity();
  void take_energy(const Finger::Energy& energy);
  Finger::Energy present_energy() const {
    return {finger_.finger().kinetic_energy(), finger_.finger().elastic_energy()};
  }
  void update();
  FingerPicture picture() {
    return pictures_.tip().draw(bare_picture(finger_.finger(), indentation()),
                                particles_of(finger_.finger()));
  }
  void look();
  double expected_time() const;
  void report(bool in_any_case);
  [[noreturn]] void give_up(const std::string& why);
  double wall_time() const {
    return std::chrono::duration<double>(Clock::now() - started_).count();
  }
  ElapsedTime elapsed() const { return {wall_time(), processor_time() - processor_start_}; }

  const PressSetup& setup_;
  const PressObserver& observer_;
  PressOutcome outcome_;
  PressWay way_;
  VirtualFinger finger_;
  const meshes::PressMotion motion_;
  PressRecorder recorder_;
  PressPictures pictures_;
  const PressFilm& film_;
  double film_interval_ = 0.0;              // [s]; 0: no film
  int shown_ = 0;                           // pictures of the film
  double last_shown_ = 0.0;                 // [s]
  std::unique_ptr<Controller> controller_;  // null when the motion is prescribed
  std::unique_ptr<ControlLoop> loop_;
  PressInstant start_of_step_;
  bool awaits_energy_ = false;  // the last row of the trace does
  double time_limit_ = 0.0;
  Clock::time_point started_, last_report_;
  double processor_start_ = 0.0;  // [s]
};

Press::Press(const PressSetup& setup, const PressObserver& observer, const PressFilm& film)
    : setup_(setup),
      observer_(observer),
      way_(setup.protocol, setup.geometry),
      finger_(computed_finger(setup, way_)),
      motion_(setup.protocol),
      recorder_(setup, motion_, finger_.finger().plane(), finger_.finger(), outcome_),
      pictures_(setup, model().sector.count(), rest_places(model()),
                model().sector.count() == 1 ? &model() : nullptr, Moment::before_contact, outcome_),
      film_(film) {
  if (film_.pictures > 1) film_interval_ = expected_time() / (film_.pictures - 1);
  outcome_.census = take_census(setup, pictures_.tip().model());
  outcome_.sectors = finger_.setup().sectors;
  outcome_.step = finger_.step_report(setup.controller.period);
  if (finger_.setup().prescribed) {
    finger_.write([this](double time) {
      const meshes::SetPoint point = motion_.at(time);
      return RodMotion{point.distance * way_.direction, point.speed * way_.direction};
    });
  } else {
    make_controller();
  }
  time_limit_ = setup.duration.value_or(2.0 * motion_.duration() + 0.5);
}

/// Brings the outcome up to date, whose last row may be handed over before a step has its energy.
void Press::update() {
  if (awaits_energy_) recorder_.set_energy(present_energy());
  recorder_.update(wall_time());
}

/// To be called at the start and after every step.
void Press::look() {
  if (pictures_.due(indentation(), finger_.finger().touching() > 0)) pictures_.keep(picture());
  if (film_interval_ <= 0.0 || finger_.time() < shown_ * film_interval_) return;
  film_.show(pictures_.tip().view(), picture());
  ++shown_;
  last_shown_ = finger_.time();
}

/// When the press will end if all goes well [s].
double Press::expected_time() const {
  const double at_depth = motion_.duration();
  const double latest = setup_.duration.value_or(at_depth);
  return setup_.follows_path ? std::min(at_depth, latest) : latest;
}

void Press::identify(Controller& trial, const std::function<bool()>& done, double longest) {
  const VirtualFinger::Snapshot start = finger_.save();
  finger_.write(Wrench{});
  ControlLoop loop(finger_, trial, setup_.hardware, setup_.controller, setup_.controller.period);
  while (finger_.time() < longest && !done()) {
    loop.sample();
    loop.advance();
  }
  finger_.load(start);
  finger_.write(Wrench{});
}

void Press::make_controller() {
  ControlTask order = control_task(setup_, way_, finger_.rod_body());
  order.identify = [this](Controller& trial, const std::function<bool()>& done, double longest) {
    identify(trial, done, longest);
  };
  if (setup_.make_controller) {
    controller_ = setup_.make_controller(order);
  } else {
    controller_ = std::make_unique<PidController>(setup_.controller, order.inertia, order.path);
  }
  loop_ = std::make_unique<ControlLoop>(finger_, *controller_, setup_.hardware, setup_.controller,
                                        order.period);
}

double Press::indentation() const {
  return way_.indentation(finger_.rod_body().endpoint, finger_.finger().rod().endpoint(),
                          setup_.protocol.clearance);
}

double Press::lateral() const {
  return way_.lateral(finger_.rod_body().endpoint, finger_.finger().rod().endpoint(),
                      setup_.protocol.clearance);
}

/// Whether the press goes on.
bool Press::after_step() {
  if (std::exchange(awaits_energy_, false)) take_energy(finger_.finger().noted_energy());
  start_of_step_.bond = finger_.finger().bond();  // of the configuration the step started from
  if (recorder_.add_step(start_of_step_)) report(true);
  const bool done = motion_.stops() ? start_of_step_.time >= motion_.duration()
                                    : start_of_step_.indentation >= setup_.protocol.depth;
  const bool late = setup_.duration && finger_.time() >= time_limit_;
  start_of_step_ = now();
  look();
  return !done && !late;
}

bool Press::run_period() {
  if (loop_) loop_->sample();
  look_after();
  start_of_step_ = now();
  return loop_ ? loop_->advance([this] { return after_step(); }) : follow_motion();
}

/// One period of prescribed motion. Adaptive steps may be long: they end where samples are taken,
/// for in between forces would be interpolated.
bool Press::follow_motion() {
  const auto observe = [this] { return after_step(); };
  const double period = setup_.controller.period;
  if (!is_adaptive(setup_.integrator)) return finger_.do_step(period, observe);
  const double end = finger_.time() + period;
  while (true) {
    const double until = recorder_.next_time(finger_.time() + 1e-6 * period).value_or(end);
    if (!(until < end - 1e-6 * period)) return finger_.do_step(end - finger_.time(), observe);
    if (!finger_.do_step(until - finger_.time(), observe)) return false;
  }
}

void Press::look_after() {
  PressInstant instant = now();
  const Wrench held =
      loop_ ? loop_->commanded() : Wrench{-instant.bond.force, -instant.bond.torque};
  recorder_.add_trace(instant, motion_.at(instant.time), held,
                      controller_ ? controller_->report() : ControllerReport{});
  finger_.finger().note_energy();
  awaits_energy_ = true;
  outcome_.elapsed.push_back(elapsed());
  check_sanity();
  report(false);
}

void Press::check_sanity() {
  const TraceRow& row = outcome_.trace.back();
  const double commanded = motion_.at(row.time).distance - setup_.protocol.clearance;
  const double ahead = row.indentation - commanded;
  const double allowed = 0.1 * setup_.geometry.thickness();
  const bool off_path = setup_.follows_path && !(ahead <= allowed);
  if (setup_.follows_path && motion_.stops() && ahead < -allowed)
    give_up("the rod did not follow the program: " + beyond_its_limits(setup_));
  if (row.tilt > 0.5 || off_path) {
    give_up("the controller lost the rod: controller.natural_frequency is too high for its period");
  }
  if (!setup_.duration && finger_.time() > time_limit_) {
    give_up("the rod did not reach the depth: " + beyond_its_limits(setup_));
  }
}

/// Of the start of the period.
void Press::take_energy(const Finger::Energy& energy) {
  recorder_.set_energy(energy);
  const double largest = 1e3 * setup_.rubber.longitudinal_modulus() * setup_.geometry.tip_volume();
  if (!(energy.kinetic + energy.elastic < largest))
    give_up("the lattice blew up, its energy left every bound: take smaller steps (run.time_step)");
}

void Press::report(bool in_any_case) {
  if (!observer_) return;
  const Clock::time_point instant = Clock::now();
  if (!in_any_case && instant - last_report_ < std::chrono::milliseconds(100)) return;
  last_report_ = instant;
  update();
  const double done = finger_.time() / expected_time();  // as wall time goes, but for shorter steps
  if (!observer_(outcome_, std::clamp(done, 0.0, 1.0))) {
    throw meshes::Interrupted("the press was stopped at an indentation of " +
                              std::to_string(indentation()) + " m");
  }
}

void Press::give_up(const std::string& why) {
  update();
  if (observer_) observer_(outcome_, 0.0);
  std::ostringstream text;
  text << why << " (at " << finger_.time() << " s, indentation " << start_of_step_.indentation
       << " m, step " << finger_.finger().step() << " s)";
  throw meshes::NotConverged(text.str());
}

PressOutcome Press::run() {
  started_ = last_report_ = Clock::now();
  processor_start_ = processor_time();
  look();
  try {
    while (run_period()) continue;
  } catch (const CrushedCells& error) {
    give_up(error.what());
  } catch (const ControllerFailed&) {
    update();
    if (observer_) observer_(outcome_, 0.0);
    throw;
  }
  look_after();  // a rod that ran away within the last period must not pass for a finished press
  take_energy(present_energy());
  outcome_.step = finger_.step_report(setup_.controller.period);
  outcome_.steps = finger_.step_count();
  outcome_.force_evaluations = finger_.finger().force_evaluations();
  pictures_.finish(picture());
  // The end may come just before or after the time that was expected.
  if (film_interval_ > 0.0 && finger_.time() > last_shown_ + 0.5 * film_interval_)
    film_.show(pictures_.tip().view(), picture());
  update();
  if (observer_) observer_(outcome_, 1.0);
  return std::move(outcome_);
}

}  // namespace

PressOutcome run_press(const PressSetup& setup, const PressObserver& observer,
                       const PressFilm& film) {
  const auto violations = setup.violations();
  if (!violations.empty()) throw meshes::InvalidInput(violations);
  Press press(setup, observer, film);
  return press.run();
}

}  // namespace fingertip::lattice::inline press
