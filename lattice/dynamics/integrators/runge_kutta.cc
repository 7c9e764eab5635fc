#include "lattice/dynamics/integrators/runge_kutta.h"

#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <sstream>

#include "lattice/dynamics/integrators/motion_vector.h"
#include "lattice/dynamics/spectrum.h"
#include "lattice/forces/energy.h"

namespace fingertip::lattice::inline dynamics::inline integrators {

using meshes::Vector3;

namespace {

/// Largest change of a cell's volume within a step (as for Euler steps, time_step.cc).
constexpr double largest_volume_change = 0.1;

constexpr int max_retries = 12;  // of a step that runs into inverted cells, each a quarter as long

}  // namespace

/// Owns what ARKODE allocates and tells it the motion's rates.
class RungeKutta::Solver {
 public:
  Solver(Finger& finger, const StepController& steps, double tolerance,
         std::optional<double> largest, double& next);
  ~Solver();
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;

  void begin(double duration);
  /// Returns the length of the step; ended_span() tells whether the end of the span cut it.
  double step(const Drive& drive);
  bool ended_span() const { return ended_span_; }
  long rejected() const { return rejected_; }

 private:
  static int rates(double time, N_Vector y, N_Vector y_dot, void* self);
  int find_rates(double time, const double* y, double* y_dot);
  void restart(double time, double step);
  void take_over(const Drive& drive, double duration);
  void plan(double taken, bool failed);
  double largest_step() const;

  double& next_;  ///< the step to try [s]
  Finger* finger_;
  MotionVector layout_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* memory_ = nullptr;
  double largest_;
  double span_ = 0.0, local_ = 0.0, start_ = 0.0;  // of the span, and where it began [s]
  bool ended_span_ = false;
  long rejected_ = 0;
  const Drive* drive_ = nullptr;
  Plane plane_;  // at the start of the step
  double plane_time_ = 0.0;
  MotionVector::Impulses impulses_;  // since the last restart
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
  const auto require = [](bool done) {
    if (!done) throw std::bad_alloc();
  };
  require(SUNContext_Create(nullptr, &context_) == 0);
  y_ = N_VNew_Serial(sunindextype(layout_.size()), context_);
  require(y_ != nullptr);
  N_VConst(0.0, y_);
  memory_ = ERKStepCreate(&Solver::rates, 0.0, y_, context_);
  require(memory_ != nullptr);
  const double frequency = std::sqrt(spectral_estimate(finger.model()).stiffness);
  N_Vector scale = N_VClone(y_);
  require(scale != nullptr);
  layout_.write_scales(finger.rod(), frequency, N_VGetArrayPointer(scale));
  N_VScale(tolerance, scale, scale);
  const bool set = ERKStepSVtolerances(memory_, 0.0, scale) == ARK_SUCCESS &&
                   ERKStepSetTableNum(memory_, ARKODE_DORMAND_PRINCE_7_4_5) == ARK_SUCCESS &&
                   ERKStepSetUserData(memory_, this) == ARK_SUCCESS &&
                   ERKStepSetErrFile(memory_, nullptr) == ARK_SUCCESS;
  N_VDestroy(scale);
  require(set);
}

RungeKutta::Solver::~Solver() {
  ERKStepFree(&memory_);
  N_VDestroy(y_);
  SUNContext_Free(&context_);
}

int RungeKutta::Solver::rates(double time, N_Vector y, N_Vector y_dot, void* self) {
  return static_cast<Solver*>(self)->find_rates(time, N_VGetArrayPointer(y),
                                                N_VGetArrayPointer(y_dot));
}

int RungeKutta::Solver::find_rates(double time, const double* y, double* y_dot) {
  layout_.read(y, state_, rod_);
  if (const Motion* motion = std::get_if<Motion>(drive_)) {
    const RodMotion at = (*motion)(start_ + time);
    rod_.prescribe(at.travel, at.velocity);
  }
  const Finger::Trial trial = finger_->attempt(state_, rod_, plane_.after(time - plane_time_),
                                               finger_->time() + (time - plane_time_), force_);
  if (!(trial.extremes.smallest_jacobian > 0.0)) return 1;
  layout_.write_rates(state_, force_, trial.surfaces, y_dot);
  if (const Wrench* applied = std::get_if<Wrench>(drive_)) {
    const Wrench& bond = trial.surfaces.bond;
    const Vector3 weight = rod_.body().mass * finger_->gravity();
    const Wrench at_endpoint{applied->force + bond.force, applied->torque + bond.torque};
    layout_.write_rod_rates(rod_, at_endpoint, weight, y_dot);
  }
  return 0;
}

double RungeKutta::Solver::largest_step() const {
  const double fastest = finger_->extremes().fastest;
  double most = largest_ > 0.0 ? largest_ : span_;
  if (fastest > 0.0) most = std::min(most, largest_volume_change / fastest);
  return most;
}

void RungeKutta::Solver::restart(double time, double step) {
  layout_.write(finger_->state(), finger_->rod(), N_VGetArrayPointer(y_));
  impulses_ = {};
  ERKStepReInit(memory_, &Solver::rates, time, y_);
  ERKStepSetInitStep(memory_, step);
  ERKStepSetStopTime(memory_, span_);
}

void RungeKutta::Solver::begin(double duration) {
  span_ = duration;
  local_ = 0.0;
  start_ = finger_->time();
  const double pieces = std::ceil(duration / std::min(next_, duration) * (1.0 - 1e-12));
  restart(0.0, duration / pieces);
}

/// ARKODE shortens the step before a stop: what it would have been is kept.
void RungeKutta::Solver::plan(double taken, bool failed) {
  double proposed = taken;
  ERKStepGetCurrentStep(memory_, &proposed);
  next_ = ended_span_ ? (failed ? taken : std::max(next_, taken)) : proposed;
}

double RungeKutta::Solver::step(const Drive& drive) {
  drive_ = &drive;
  finger_->start_step();
  if (!(finger_->extremes().smallest_jacobian > 0.0)) {
    throw CrushedCells("a cell was turned inside out");
  }
  plane_ = finger_->plane();
  plane_time_ = local_;
  ERKStepSetMaxStep(memory_, largest_step());
  double planned = next_;
  for (int retries = 0;; ++retries) {
    long before = 0, after = 0;
    ERKStepGetNumErrTestFails(memory_, &before);
    double reached = local_;
    const int flag = ERKStepEvolve(memory_, span_, y_, &reached, ARK_ONE_STEP);
    if (flag >= 0) {
      ERKStepGetNumErrTestFails(memory_, &after);
      rejected_ += after - before;
      const double taken = reached - local_;
      ended_span_ = flag == ARK_TSTOP_RETURN || reached >= span_;
      plan(taken, after > before || retries > 0);
      local_ = reached;
      take_over(drive, taken);
      return taken;
    }
    if (retries == max_retries) throw CrushedCells("cells are pressed flat");
    ++rejected_;
    planned *= 0.25;
    restart(local_, planned);
  }
}

void RungeKutta::Solver::take_over(const Drive& drive, double duration) {
  const Vector3 momentum_before = finger_->rod().momentum();
  const double* y = N_VGetArrayPointer(y_);
  layout_.read(y, finger_->state(), finger_->rod());
  const MotionVector::Impulses total = layout_.impulses(y);
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
