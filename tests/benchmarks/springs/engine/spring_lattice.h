/// The fast engine for `SpringProblem`s: one register of masses at a time, every spring once,
/// forces and integration in one sweep, several threads in different time steps at once. How:
/// README.md of this folder.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>

#include "tests/benchmarks/springs/engine/spring_problem.h"

namespace fingertip::lattice::springs {

enum class Precision { float64, float32 };

/// Doubles per register of the widest instruction set that the kernels and the running processor
/// have in common: 2 (every x86-64), 4 (AVX2 with FMA) or 8 (AVX-512).
int widest();

struct EngineOptions {
  Precision precision = Precision::float64;  ///< of the motion and of all arithmetic
  int width = 0;    ///< doubles per register: 2, 4, 8 as `widest`; 0: the widest
  int threads = 1;  ///< made ready at construction, >= 1
};

class Engine;

class SpringLattice {
 public:
  /// Starts at rest. Throws meshes::InvalidInput when the problem breaks a rule and
  /// std::invalid_argument for a width that the processor lacks or threads < 1.
  explicit SpringLattice(const SpringProblem& problem, const EngineOptions& options = {});
  ~SpringLattice();
  SpringLattice(SpringLattice&&) noexcept;
  SpringLattice& operator=(SpringLattice&&) noexcept;

  /// Positions [m] and velocities [m/s], one column per mass (order of `mass_points`); rounded
  /// when the precision is float32.
  void set_motion(const Eigen::Matrix3Xd& positions, const Eigen::Matrix3Xd& velocities);
  Eigen::Matrix3Xd positions() const;
  Eigen::Matrix3Xd velocities() const;

  /// Advances by `steps` time steps on all threads made ready, or on the given number of them
  /// (1 ... options.threads, else std::invalid_argument). Allocates nothing. The result is the
  /// same to the bit for every number of threads and however a run is divided into calls.
  void run(int steps);
  void run(int steps, int threads);

  std::size_t masses() const;
  std::size_t springs() const;

  /// Doubles per register of the kernel in use.
  int width() const;

  /// Share of the lanes that hold a spring among those the kernel computes in a step: 1 means that
  /// rows fill their registers and the mask leaves no holes.
  double lane_efficiency() const;

 private:
  std::unique_ptr<Engine> engine_;
};

}  // namespace fingertip::lattice::springs
