#include "lattice/dynamics/integrators/runge_kutta.h"

#include <algorithm>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <cmath>
#include <sstream>
#include <vector>

#include "lattice/dynamics/integrators/motion_vector.h"
#include "lattice/dynamics/spectrum.h"
#include "lattice/forces/energy.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

using meshes::Vector3;

namespace {

/// Largest change of a cell's volume within a step (as for Euler steps, time_step.cc).
constexpr double largest_volume_change = 0.1;

constexpr int max_retries = 12;  // of a step that runs into inverted cells, each a quarter as long

/// Of the length at which the estimated error would be the tolerance, and how much a step may be
/// shorter and longer than the one before (Hairer, Norsett & Wanner, Solving Ordinary Differential
/// Equations I, II.4).
constexpr double step_margin = 0.8, least_growth = 0.2, most_growth = 10.0;

using Vector = std::vector<double>;

}  // namespace

/// All unknowns, and a step of theirs.
class RungeKutta::Solver {
 public:
  Solver(Finger& finger, const StepController& steps, double tolerance,
         std::optional<double> largest, double& next);

  void begin(double duration);
  /// Returns the length of the step; ended_span() tells whether the end of the span cut it.
  double step(const Drive& drive);
  bool ended_span() const { return ended_span_; }
  long rejected() const { return rejected_; }

 private:
  void find_rates(const Vector& y, Vector& y_dot, double time);
  double error() const;
  void take_over(const Drive& drive, double duration);
  double largest_step() const;

  double& next_;  ///< the step to try [s]
  Finger* finger_;
  MotionVector layout_;
  boost::numeric::odeint::runge_kutta_dopri5<Vector> pair_;
  Vector y_, rates_, new_y_, new_rates_, off_, scale_;
  bool knows_rates_ = false;  ///< those of y_: the last stage of a step is the first of the next
  bool crushed_ = false;      ///< a stage has turned a cell inside out
  double largest_;
  double span_ = 0.0, local_ = 0.0, start_ = 0.0;  // of the span, and where it began [s]
  double length_ = 0.0;                            // of the step to try within it [s]
  bool ended_span_ = false;
  long rejected_ = 0;
  const Drive* drive_ = nullptr;
  Plane plane_;  // at the start of the step
  double plane_time_ = 0.0;
  MotionVector::Impulses impulses_;  // since the span began
  State state_;
  RodState rod_;
  VectorField force_;
};

RungeKutta::Solver::Solver(Finger& finger, const StepController& steps, double tolerance,
                           std::optional<double> largest, double& next)
    : next_(next = 0.1 * steps.limit(finger.extremes())),
      finger_(&finger),
      layout_(finger.model()),
      largest_(largest.value_or(0.0)),
      state_(finger.model()),
      rod_(finger.rod()),
      force_(finger.model().points()) {
  for (Vector* vector : {&y_, &rates_, &new_y_, &new_rates_, &off_, &scale_})
    vector->resize(layout_.size());
  const double frequency = std::sqrt(spectral_estimate(finger.model()).stiffness);
  layout_.write_scales(finger.rod(), frequency, scale_.data());
  for (double& scale : scale_) scale *= tolerance;
}

void RungeKutta::Solver::find_rates(const Vector& y, Vector& y_dot, double time) {
  if (crushed_) return;  // the step is lost
  layout_.read(y.data(), state_, rod_);
  if (const Motion* motion = std::get_if<Motion>(drive_)) {
    const RodMotion at = (*motion)(start_ + time);
    rod_.prescribe(at.travel, at.velocity);
  }
  const Finger::Trial trial = finger_->attempt(state_, rod_, plane_.after(time - plane_time_),
                                               finger_->time() + (time - plane_time_), force_);
  crushed_ = !(trial.extremes.smallest_jacobian > 0.0);
  if (crushed_) return;
  layout_.write_rates(state_, force_, trial.surfaces, y_dot.data());
  if (const Wrench* applied = std::get_if<Wrench>(drive_)) {
    const Wrench& bond = trial.surfaces.bond;
    const Vector3 weight = rod_.body().mass * finger_->gravity();
    const Wrench at_endpoint{applied->force + bond.force, applied->torque + bond.torque};
    layout_.write_rod_rates(rod_, at_endpoint, weight, y_dot.data());
  }
}

/// Root mean square over the scales.
double RungeKutta::Solver::error() const {
  double squares = 0.0;
  for (std::size_t i = 0; i < off_.size(); ++i) squares += std::pow(off_[i] / scale_[i], 2);
  return std::sqrt(squares / double(off_.size()));
}

double RungeKutta::Solver::largest_step() const {
  const double fastest = finger_->extremes().fastest;
  double most = largest_ > 0.0 ? largest_ : span_;
  if (fastest > 0.0) most = std::min(most, largest_volume_change / fastest);
  return most;
}

void RungeKutta::Solver::begin(double duration) {
  span_ = duration;
  local_ = 0.0;
  start_ = finger_->time();
  length_ = duration / std::ceil(duration / std::min(next_, duration) * (1.0 - 1e-12));
  layout_.write(finger_->state(), finger_->rod(), y_.data());
  impulses_ = {};
  knows_rates_ = false;
}

double RungeKutta::Solver::step(const Drive& drive) {
  drive_ = &drive;
  finger_->start_step();
  if (!(finger_->extremes().smallest_jacobian > 0.0)) {
    throw CrushedCells("a cell was turned inside out");
  }
  plane_ = finger_->plane();
  plane_time_ = local_;
  const auto rates = [this](const Vector& y, Vector& y_dot, double time) {
    find_rates(y, y_dot, time);
  };
  crushed_ = false;
  if (!knows_rates_) find_rates(y_, rates_, local_);
  knows_rates_ = true;
  const double most = largest_step();
  int retries = 0;
  for (bool failed = false;; failed = true) {
    const double left = span_ - local_;
    length_ = std::min(length_, most);
    ended_span_ = length_ >= left * (1.0 - 1e-12);
    const double taken = ended_span_ ? left : length_;
    crushed_ = false;
    pair_.do_step(rates, y_, rates_, local_, new_y_, new_rates_, taken, off_);
    const double off = error();
    if (crushed_ || !std::isfinite(off)) {
      if (++retries > max_retries) throw CrushedCells("cells are pressed flat");
      length_ = 0.25 * taken;
    } else {
      length_ = taken * std::clamp(step_margin * std::pow(off, -0.2), least_growth,
                                   failed ? 1.0 : most_growth);
      if (off <= 1.0) {
        next_ = ended_span_ ? (failed ? taken : std::max(next_, taken)) : length_;
        local_ = ended_span_ ? span_ : local_ + taken;
        y_.swap(new_y_);
        rates_.swap(new_rates_);
        take_over(drive, taken);
        return taken;
      }
    }
    ++rejected_;
  }
}

void RungeKutta::Solver::take_over(const Drive& drive, double duration) {
  const Vector3 momentum_before = finger_->rod().momentum();
  layout_.read(y_.data(), finger_->state(), finger_->rod());
  const MotionVector::Impulses total = layout_.impulses(y_.data());
  const MotionVector::Impulses impulses = total - impulses_;
  impulses_ = total;
  Vector3 on_rod = Vector3::Zero();
  if (const Wrench* applied = std::get_if<Wrench>(&drive)) {
    on_rod = duration * (applied->force + finger_->rod().body().mass * finger_->gravity());
  } else {
    const RodMotion at = std::get<Motion>(drive)(start_ + local_);
    finger_->rod().prescribe(at.travel, at.velocity);
    on_rod = finger_->rod().momentum() - momentum_before - impulses.bond;
  }
  finger_->finish_step(duration, impulses.plane, on_rod);
}

RungeKutta::RungeKutta(Finger& finger, const StepController& steps, double tolerance,
                       std::optional<double> largest)
    : solver_(std::make_unique<Solver>(finger, steps, tolerance, largest, now_.next)),
      finger_(&finger),
      tolerance_(tolerance) {}

RungeKutta::~RungeKutta() = default;

void RungeKutta::begin(const Drive& /*drive*/, double duration) {
  solver_->begin(duration);
}

void RungeKutta::step(const Drive& drive, double /*until*/) {
  const double taken = solver_->step(drive);
  accept(taken, !solver_->ended_span());
  count_.rejected = solver_->rejected();
}

void RungeKutta::end() {
  finger_->start_step();
}

std::string RungeKutta::explanation() const {
  std::ostringstream text;
  text << "Runge-Kutta 5(4), tolerance " << tolerance_ << ": " << counted() << ", smallest "
       << count_.smallest * 1e6 << " us (the step above is symplectic Euler's)";
  return text.str();
}

}  // namespace fingertip::lattice::inline dynamics::inline integrators
