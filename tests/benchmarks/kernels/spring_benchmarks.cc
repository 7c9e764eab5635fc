#include <benchmark/benchmark.h>

#include <random>

#include "benchmarks.h"
#include "edge_list.h"
#include "multiply_rate.h"
#include "tests/benchmarks/springs/engine/spring_lattice.h"

namespace kernel_benchmarks {

namespace springs = fingertip::lattice::springs;

namespace {

/// A damped cube without plane and gravity; rubber-like constants at a spacing of 1 mm.
springs::SpringProblem cube(int size) {
  springs::SpringProblem problem;
  problem.size = {size, size, size};
  problem.spacing = 1e-3;
  problem.stiffness = {10.0, 7.0, 4.0};
  problem.damping = {1e-3, 7e-4, 4e-4};
  problem.mass = 1e-6;
  problem.step = 2e-6;
  return problem;
}

/// Displacements up to a hundredth of the spacing, for no spring to be at rest.
Eigen::Matrix3Xd shaken(const springs::SpringProblem& problem) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  Eigen::Matrix3Xd positions = springs::rest_positions(problem);
  for (double& x : positions.reshaped()) x += 0.01 * problem.spacing * unit(random);
  return positions;
}

/// Steps per call, enough for what it takes to wake the threads not to count.
int steps_for(std::size_t spring_count) {
  return spring_count < 1000000 ? 64 : 16;
}

template <typename Body>
void measure(benchmark::State& state, Body& body, int steps, double operations) {
  body.run(steps);
  for (auto _ : state) body.run(steps);
  state.counters["masses"] = double(body.masses());
  state.counters["springs"] = double(body.springs());
  state.counters["steps"] = steps;
  state.counters["operations"] = operations;
}

void register_engine(int size, int width, springs::Precision precision, int threads,
                     double seconds) {
  const char* name = precision == springs::Precision::float64 ? "float64" : "float32";
  benchmark::RegisterBenchmark(
      full_name("springs", width, name, threads, size).c_str(),
      [=](benchmark::State& state) {
        const springs::SpringProblem problem = cube(size);
        springs::SpringLattice lattice(problem, {precision, width, threads});
        const Eigen::Matrix3Xd positions = shaken(problem);
        lattice.set_motion(positions, 0.0 * positions);
        measure(state, lattice, steps_for(lattice.springs()),
                spring_peers::multiply_operations_per_spring);
      })
      ->MinTime(seconds)
      ->UseRealTime();
}

void register_edge_list(int size, double seconds) {
  benchmark::RegisterBenchmark(full_name("edge_list", 2, "float64", 1, size).c_str(),
                               [=](benchmark::State& state) {
                                 const springs::SpringProblem problem = cube(size);
                                 spring_peers::EdgeList list(problem);
                                 const Eigen::Matrix3Xd positions = shaken(problem);
                                 list.set_motion(positions, 0.0 * positions);
                                 measure(state, list, 4, 0.0);
                               })
      ->MinTime(seconds)
      ->UseRealTime();
}

}  // namespace

void register_springs(const Scope& scope) {
  using springs::Precision;
  for (std::size_t i = 0; i < scope.sizes.size(); ++i) {
    const int size = scope.sizes[i];
    const bool everything = i < 2;
    const int engine_widest = std::min(scope.widest, springs::widest());
    // Ours and the peer one after the other: a ratio shares its moment of the machine.
    if (everything) register_edge_list(size, scope.seconds);
    for (int threads = 1; threads <= scope.threads; threads *= 2)
      register_engine(size, engine_widest, Precision::float64, threads, scope.seconds);
    if (!everything) continue;
    for (int threads = 1; threads <= scope.threads; threads *= 2)
      register_engine(size, engine_widest, Precision::float32, threads, scope.seconds);
    for (int width = 2; width < engine_widest; width *= 2)
      register_engine(size, width, Precision::float64, 1, scope.seconds);
  }
}

}  // namespace kernel_benchmarks
