#include "lattice/grasp/grasp.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <ostream>
#include <string>

#include "meshes/base/files.h"

namespace fingertip::lattice::inline grasp {

using meshes::Vector3;

namespace {

using Clock = std::chrono::steady_clock;

/// Where both rods of a gripper are: a period's motion at constant acceleration.
struct Course {
  double start = 0.0, duration = 1.0;  ///< [s]
  double closed = 0.0, risen = 0.0;    ///< at the start [m]
  GripMotion before, after;            ///< at start and end

  /// In the finger's axes: z toward the block, x up.
  RodMotion at(double time) const {
    const double t = time - start, bend = 0.5 * t * t / duration;
    RodMotion motion;
    motion.travel = Vector3(risen + t * before.rising + bend * (after.rising - before.rising), 0.0,
                            closed + t * before.closing + bend * (after.closing - before.closing));
    const double share = t / duration;
    motion.velocity = Vector3(before.rising + share * (after.rising - before.rising), 0.0,
                              before.closing + share * (after.closing - before.closing));
    return motion;
  }
  void go_on(const GripMotion& next) {
    const RodMotion end = at(start + duration);
    closed = end.travel.z();
    risen = end.travel.x();
    start += duration;
    before = after;
    after = next;
  }
};

/// Fingers that slide along a standing block for so long [s] will not lift it.
constexpr double slide_time = 0.2;

/// Whether every point of both contacts slides.
bool all_slide(const GraspRow& row) {
  for (std::size_t i = 0; i < 2; ++i) {
    if (row.touching[i] == 0 || row.sliding[i] < row.touching[i]) return false;
  }
  return true;
}

HandSetup with_prescribed_rods(HandSetup hand) {
  hand.finger.prescribed = true;
  return hand;
}

/// Of a finger's points: sums of GraspRow::point_friction and inward_friction.
void sum_friction(const Finger& finger, double& magnitudes, double& inward) {
  std::vector<meshes::ContactPoint> points;
  for (const TiedPoint& tied : finger.tied_points())
    if (tied.touches()) points.push_back(tied.point);
  if (points.empty()) return;
  const Vector3 normal = finger.plane().normal, centre = centre_of_pressure(points);
  for (const meshes::ContactPoint& point : points) {
    const Vector3 friction = point.area * point.shear;
    Vector3 way = centre - point.place;
    way -= way.dot(normal) * normal;
    magnitudes += friction.norm();
    if (way.norm() > 0.0) inward += friction.dot(way.normalized());
  }
}

double ratio_of(const GraspRow& row) {
  return (row.tangential[0] + row.tangential[1]) / (row.normal[0] + row.normal[1]);
}

class Grasp {
 public:
  Grasp(const GraspSetup& setup, const GraspObserver& observer);
  GraspOutcome run();

 private:
  double weight() const { return setup_.hand.block.mass * setup_.hand.gravity; }
  GraspRow look() const;
  GripFeeling feel(const GraspRow& row) const;
  void run_period();
  void judge(const GraspRow& row);
  void note_slip(const GraspRow& row);
  void check_momentum(const GraspRow& row);
  void summarise();
  void report();
  [[noreturn]] void give_up(const std::string& why);

  const GraspSetup& setup_;
  const GraspObserver& observer_;
  Hand hand_;
  GripControl control_;
  Course course_;
  double stuck_ = 0.0;      // when some point did not slide for the last time [s]
  double sag_ = 0.0;        // of the block against the rods when it left its support [m]
  Vector3 first_momentum_;  // [N s]
  double worst_defect_ = 0.0, largest_given_ = 0.0;  // of the momentum, by a finger in a period
  GraspOutcome outcome_;
  Clock::time_point started_, last_report_;
};

Grasp::Grasp(const GraspSetup& setup, const GraspObserver& observer)
    : setup_(setup),
      observer_(observer),
      hand_(with_prescribed_rods(setup.hand), setup.grip.period),
      control_(setup.grip),
      first_momentum_(hand_.momentum()) {
  course_.start = -setup.grip.period;
  course_.duration = setup.grip.period;
  for (std::size_t i = 0; i < 2; ++i) {
    hand_.finger(i).write([this](double time) { return course_.at(time); });
  }
  outcome_.least_force = setup.least_force(setup.grip.lift_acceleration());
  outcome_.coupling = hand_.coupling();
  outcome_.step = hand_.step();
}

GraspRow Grasp::look() const {
  const RodState& block = hand_.block();
  const RodMotion rods = course_.at(hand_.time());
  GraspRow row;
  row.time = hand_.time();
  row.phase = control_.phase();
  row.height = block.pose().position.z();
  row.velocity = block.velocity_at(block.pose().position).z();
  row.tilt = Eigen::AngleAxisd(block.pose().orientation).angle();
  row.finger_height = rods.travel.x();
  row.indentation = rods.travel.z() - setup_.hand.clearance;
  row.support_force = hand_.support_force();
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector3& force = hand_.on_block(i).force;
    const Vector3 inward = -face_normal(block, sides[i]);
    row.normal[i] = force.dot(inward);
    row.tangential[i] = (force - row.normal[i] * inward).norm();
    row.touching[i] = hand_.finger(i).finger().touching();
    row.sliding[i] = hand_.finger(i).finger().sliding();
    sum_friction(hand_.finger(i).finger(), row.point_friction[i], row.inward_friction[i]);
    row.load += force.z();
  }
  if (!hand_.supported()) row.slip = row.finger_height - row.height - sag_;
  return row;
}

GripFeeling Grasp::feel(const GraspRow& row) const {
  GripFeeling feeling;
  feeling.time = row.time;
  for (std::size_t i = 0; i < 2; ++i) {
    feeling.force -= 0.5 * hand_.finger(i).finger().bond().force.z();
  }
  feeling.indentation = row.indentation;
  feeling.load = weight() > 0.0 ? row.load / weight() : 1.0;
  feeling.supported = hand_.supported();
  return feeling;
}

void Grasp::run_period() {
  course_.go_on(control_.next(feel(look())));
  const double until = course_.start + course_.duration;
  while (hand_.time() < until - 1e-6 * hand_.step()) {
    const bool supported = hand_.supported();
    hand_.advance();
    if (supported && !hand_.supported()) {
      sag_ = course_.at(hand_.time()).travel.x();
      outcome_.lift_off_time = hand_.time();
    }
  }
  outcome_.rows.push_back(look());
  judge(outcome_.rows.back());
}

void Grasp::judge(const GraspRow& row) {
  const double thickness = setup_.hand.finger.geometry.thickness();
  if (row.indentation > 0.7 * thickness) {
    give_up(
        "the grip force needs an indentation beyond 70 % of the rubber's thickness: lower "
        "grasp.force, or take a stiffer rubber or a thicker tip");
  }
  if (!std::isfinite(row.height) || std::abs(row.velocity) > 1e3)
    give_up("the grasp blew up: take smaller steps (run.time_step) or a smaller grasp.force");
  if (!all_slide(row)) stuck_ = row.time;
  const bool slides_along = row.time - stuck_ > slide_time;
  if (row.phase == GripPhase::load && (slides_along || row.finger_height > thickness)) {
    outcome_.fate = GraspFate::not_lifted;
  }
  if (row.slip > setup_.grip.slip_limit && outcome_.fate == GraspFate::unfinished) {
    outcome_.fate = GraspFate::dropped;
  }
  note_slip(row);
  check_momentum(row);
}

/// When all points slide until the end.
void Grasp::note_slip(const GraspRow& row) {
  if (!all_slide(row)) {
    outcome_.slip_force = outcome_.slip_ratio = outcome_.sliding_ratio = meshes::unknown;
    return;
  }
  outcome_.sliding_ratio = ratio_of(row);
  if (!std::isnan(outcome_.slip_force)) return;
  outcome_.slip_force = 0.5 * (row.normal[0] + row.normal[1]);
  outcome_.slip_ratio = outcome_.sliding_ratio;
}

void Grasp::check_momentum(const GraspRow& row) {
  const double defect = (hand_.momentum() - first_momentum_ - hand_.impulse()).norm();
  if (!(defect <= worst_defect_)) worst_defect_ = defect;  // keeps a NaN visible
  const double force = std::max(std::hypot(row.normal[0], row.tangential[0]),
                                std::hypot(row.normal[1], row.tangential[1]));
  largest_given_ = std::max(largest_given_, force * setup_.grip.period);
  outcome_.momentum_defect = largest_given_ > 0.0 ? worst_defect_ / largest_given_ : 0.0;
}

/// Means over the hold.
void Grasp::summarise() {
  outcome_.simulated_time = hand_.time();
  outcome_.wall_time = std::chrono::duration<double>(Clock::now() - started_).count();
  double force = 0.0, load = 0.0, tangential = 0.0;
  int count = 0;
  for (const GraspRow& row : outcome_.rows) {
    if (row.phase != GripPhase::hold) continue;
    ++count;
    force += 0.5 * (row.normal[0] + row.normal[1]);
    tangential += 0.5 * (row.tangential[0] + row.tangential[1]);
    load += row.load;
    outcome_.held_slip = row.slip;
  }
  if (count == 0) return;
  outcome_.held_force = force / count;
  outcome_.held_load = load / count / weight();
  outcome_.held_ratio = tangential / force;
}

void Grasp::report() {
  if (!observer_) return;
  const Clock::time_point instant = Clock::now();
  if (instant - last_report_ < std::chrono::milliseconds(100)) return;
  last_report_ = instant;
  summarise();
  if (!observer_(outcome_, control_.fraction_done(hand_.time()))) {
    throw meshes::Interrupted("the grasp was stopped at " + meshes::to_text(hand_.time()) + " s");
  }
}

void Grasp::give_up(const std::string& why) {
  summarise();
  if (observer_) observer_(outcome_, 0.0);
  throw meshes::NotConverged(why + " (at " + meshes::to_text(hand_.time()) + " s)");
}

GraspOutcome Grasp::run() {
  started_ = last_report_ = Clock::now();
  try {
    while (outcome_.fate == GraspFate::unfinished) {
      run_period();
      if (control_.phase() == GripPhase::release || control_.phase() == GripPhase::done) break;
      report();
    }
    if (outcome_.fate == GraspFate::unfinished) outcome_.fate = GraspFate::held;
    const double end = setup_.grip.slip_limit;
    while (control_.phase() == GripPhase::release && outcome_.rows.back().slip < end) {
      run_period();
      report();
    }
  } catch (const CrushedCells& error) {
    give_up(error.what());
  }
  summarise();
  if (observer_) observer_(outcome_, 1.0);
  return std::move(outcome_);
}

}  // namespace

std::vector<meshes::Violation> GraspSetup::violations() const {
  std::vector<meshes::Violation> found = hand.block.violations();
  append(found, grip.violations());
  if (!(std::isfinite(hand.gravity) && hand.gravity > 0.0)) {
    found.push_back({"grasp.gravity", meshes::to_text(hand.gravity) + " m/s^2",
                     "lifting needs a weight: gravity must be finite and positive",
                     "the earth's is 9.81 m/s^2"});
  }
  if (hand.finger.lattice.model == ModelKind::published) {
    found.push_back({"lattice.model", "published",
                     "the published model's contact does not follow a moving plane",
                     "take hookean, central or network"});
  }
  if (hand.finger.integrator != Integrator::symplectic_euler) {
    found.push_back({"run.integrator", std::string(name(hand.finger.integrator)),
                     "a grasp is integrated by symplectic Euler", "take symplectic-euler"});
  }
  return found;
}

double GraspSetup::least_force(double acceleration) const {
  const ContactLaw& law = hand.finger.contact;
  if (law.mode == meshes::ContactMode::stick) return 0.0;
  if (law.mode == meshes::ContactMode::frictionless) {
    return std::numeric_limits<double>::infinity();
  }
  return hand.block.mass * (hand.gravity + acceleration) / (2.0 * law.friction);
}

GraspOutcome run_grasp(const GraspSetup& setup, const GraspObserver& observer) {
  const auto violations = setup.violations();
  if (!violations.empty()) throw meshes::InvalidInput(violations);
  return Grasp(setup, observer).run();
}

}  // namespace fingertip::lattice::inline grasp
