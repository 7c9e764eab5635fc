#include "tests/benchmarks/springs/engine/spring_lattice.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/kernels/by_width.h"
#include "lattice/kernels/kernel.h"
#include "tests/benchmarks/springs/engine/lane_storage.h"
#include "tests/benchmarks/springs/engine/sweep.h"
#include "tests/benchmarks/springs/engine/wavefront.h"

namespace fingertip::lattice::springs {

/// A lattice in one precision and register width.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual void set_motion(const Eigen::Matrix3Xd& positions,
                          const Eigen::Matrix3Xd& velocities) = 0;
  virtual Eigen::Matrix3Xd positions() const = 0;
  virtual Eigen::Matrix3Xd velocities() const = 0;
  virtual void run(int steps, int threads) = 0;
  virtual int threads() const = 0;
  virtual int width() const = 0;
  virtual std::size_t masses() const = 0;
  virtual std::size_t springs() const = 0;
  virtual std::size_t evaluated_springs() const = 0;
};

namespace {

SweepOffer offer(int width) {
  return kernel::by_width(width, [](auto w) { return sweep_at<w()>; })();
}

template <typename Real>
SweepPlane<Real> choose(const SweepOffer& offer, bool damped) {
  if constexpr (std::is_same_v<Real, double>) {
    return damped ? offer.damped64 : offer.undamped64;
  } else {
    return damped ? offer.damped32 : offer.undamped32;
  }
}

template <typename Real>
class LaneEngine : public Engine {
 public:
  LaneEngine(const SpringProblem& problem, int width, int threads)
      : width_(width),
        storage_(problem, width * int(sizeof(double) / sizeof(Real))),
        sweep_(choose<Real>(
            offer(width), *std::max_element(problem.damping.begin(), problem.damping.end()) > 0.0)),
        wavefront_(threads) {
    for (int thread = 0; thread < threads; ++thread) forces_.emplace_back(storage_.force_buffer());
    const Eigen::Matrix3Xd rest = rest_positions(problem);
    set_motion(rest, Eigen::Matrix3Xd::Zero(3, rest.cols()));
  }

  void set_motion(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities) override {
    storage_.put(LaneStorage<Real>::Quantity::position, positions);
    storage_.put(LaneStorage<Real>::Quantity::velocity, velocities);
  }
  Eigen::Matrix3Xd positions() const override {
    return storage_.get(LaneStorage<Real>::Quantity::position);
  }
  Eigen::Matrix3Xd velocities() const override {
    return storage_.get(LaneStorage<Real>::Quantity::velocity);
  }
  void run(int steps, int threads) override {
    wavefront_.run(steps, storage_.grid().planes, threads, [this](int thread, int plane) {
      sweep_(storage_.grid(), plane, forces_[std::size_t(thread)].data());
    });
  }
  int threads() const override { return wavefront_.threads(); }
  int width() const override { return width_; }
  std::size_t masses() const override { return storage_.masses(); }
  std::size_t springs() const override { return storage_.springs(); }
  std::size_t evaluated_springs() const override { return storage_.evaluated_springs(); }

 private:
  int width_;
  LaneStorage<Real> storage_;
  SweepPlane<Real> sweep_;
  Wavefront wavefront_;
  std::vector<Arena<Real>> forces_;
};

std::unique_ptr<Engine> make_engine(const SpringProblem& problem, const EngineOptions& options) {
  if (auto broken = problem.violations(); !broken.empty()) throw meshes::InvalidInput(broken);
  const int width = options.width == 0 ? widest() : options.width;
  if ((width != 2 && width != 4 && width != 8) || width > widest()) {
    throw std::invalid_argument("SpringLattice: no kernel of width " + std::to_string(width) +
                                " on this processor");
  }
  if (options.threads < 1) throw std::invalid_argument("SpringLattice: at least one thread");
  if (options.precision == Precision::float32)
    return std::make_unique<LaneEngine<float>>(problem, width, options.threads);
  return std::make_unique<LaneEngine<double>>(problem, width, options.threads);
}

}  // namespace

int widest() {
  const int width = kernel::supported_width();
  return width == 4 && !__builtin_cpu_supports("fma") ? 2 : width;
}

SpringLattice::SpringLattice(const SpringProblem& problem, const EngineOptions& options)
    : engine_(make_engine(problem, options)) {}
SpringLattice::~SpringLattice() = default;
SpringLattice::SpringLattice(SpringLattice&&) noexcept = default;
SpringLattice& SpringLattice::operator=(SpringLattice&&) noexcept = default;

void SpringLattice::set_motion(const Eigen::Matrix3Xd& positions,
                               const Eigen::Matrix3Xd& velocities) {
  const auto masses = Eigen::Index(engine_->masses());
  if (positions.cols() != masses || velocities.cols() != masses)
    throw std::invalid_argument("SpringLattice::set_motion: one column per mass");
  engine_->set_motion(positions, velocities);
}
Eigen::Matrix3Xd SpringLattice::positions() const {
  return engine_->positions();
}
Eigen::Matrix3Xd SpringLattice::velocities() const {
  return engine_->velocities();
}

void SpringLattice::run(int steps) {
  run(steps, engine_->threads());
}
void SpringLattice::run(int steps, int threads) {
  if (steps < 0 || threads < 1 || threads > engine_->threads())
    throw std::invalid_argument("SpringLattice::run: steps >= 0, threads as made ready");
  engine_->run(steps, threads);
}

std::size_t SpringLattice::masses() const {
  return engine_->masses();
}
std::size_t SpringLattice::springs() const {
  return engine_->springs();
}
int SpringLattice::width() const {
  return engine_->width();
}
double SpringLattice::lane_efficiency() const {
  return double(engine_->springs()) /
         double(std::max<std::size_t>(1, engine_->evaluated_springs()));
}

}  // namespace fingertip::lattice::springs
