// Nanoseconds per spring and step of the spring engine and of the edge list, and the fraction of
// the processor's multiply rate; with --ratios what one is over the other, measured in turns.
// Not a test: lattice/MEASUREMENTS.md quotes it.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "edge_list.h"
#include "multiply_rate.h"
#include "spring_scenes.h"
#include "tests/benchmarks/springs/engine/spring_lattice.h"

using namespace fingertip;
using namespace scenes;
using lattice::springs::Precision;
using lattice::springs::SpringLattice;

namespace {

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// A body standing on a level plane, its lowest layer a tenth of the spacing inside.
SpringProblem standing(SpringProblem problem) {
  problem.plane.normal = Eigen::Vector3d::UnitZ();
  return problem;
}
SpringProblem cube(int n) {
  return standing(box(n, n, n));
}
SpringProblem tip_of_twelve() {
  return standing(fingertip_body(12));
}

/// Something that simulates a problem, set in motion.
struct Runner {
  std::function<void(int steps)> run;
  double springs = 0.0, masses = 0.0, lane_efficiency = 1.0;
};

Runner edge_list(const SpringProblem& problem) {
  const auto list = std::make_shared<spring_peers::EdgeList>(problem);
  const Motion start = shaken(problem, 1);
  list->set_motion(start.positions, start.velocities);
  return {[list](int steps) { list->run(steps); }, double(list->springs()), double(list->masses())};
}

Runner engine(const SpringProblem& problem, Precision precision, int width, int threads) {
  const auto lattice = std::make_shared<SpringLattice>(
      problem, lattice::springs::EngineOptions{precision, width, threads});
  const Motion start = shaken(problem, 1);
  lattice->set_motion(start.positions, start.velocities);
  return {[lattice](int steps) { lattice->run(steps); }, double(lattice->springs()),
          double(lattice->masses()), lattice->lane_efficiency()};
}

/// Shortest time per step [s] met so far; whatever else the machine does only adds to it.
class Fastest {
 public:
  explicit Fastest(const Runner& runner) : runner_(runner) { run(2); }
  /// Times a run short enough to fit between two interruptions, but not less than two steps.
  void measure() {
    constexpr double length = 0.003;
    run(std::max(2, int(length / step_)));
  }
  double step() const { return step_; }
  double spring() const { return step_ / runner_.springs; }

 private:
  void run(int steps) {
    const double start = seconds();
    runner_.run(steps);
    step_ = std::min(step_, (seconds() - start) / steps);
  }
  Runner runner_;
  double step_ = 1e300;
};

/// Benchmarks `make()`; the fraction is of `rate` (multiplications per second of all threads).
void add(const std::string& name, const std::function<Runner()>& make, double rate) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [make, rate](benchmark::State& state) {
        const Runner runner = make();
        runner.run(2);
        const double begin = seconds();
        for (auto _ : state) runner.run(2);
        const double steps = 2.0 * double(state.iterations()), spent = seconds() - begin;
        state.counters["ns_per_spring"] = 1e9 * spent / (steps * runner.springs);
        state.counters["masses"] = runner.masses;
        state.counters["lanes"] = runner.lane_efficiency;
        if (rate > 0.0) {
          state.counters["roofline"] = spring_peers::multiply_operations_per_spring *
                                       runner.springs * steps / (spent * rate);
        }
      })
      ->UseRealTime()
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(0.1);
}

void add_engines(const std::string& body, const SpringProblem& problem, bool all_widths) {
  for (const int width : widths()) {
    if (!all_widths && width != lattice::springs::widest()) continue;
    for (const Precision precision : {Precision::float64, Precision::float32}) {
      const double rate = spring_peers::multiply_rate(width, precision);
      for (const int threads : {1, 2}) {
        const std::string bits = precision == Precision::float64 ? "double" : "float";
        add(
            body + "/" + bits + "/" + std::to_string(64 * width) + "bit/" +
                std::to_string(threads) + "t",
            [=] { return engine(problem, precision, width, threads); }, threads * rate);
      }
    }
  }
}

/// Times the edge list and the engine on 1 and 2 threads in turns, so that what the machine does
/// besides meets all alike, and prints how their fastest steps compare.
void print_ratios(const std::string& name, const SpringProblem& problem) {
  Fastest list(edge_list(problem)), serial(engine(problem, Precision::float64, 0, 1)),
      parallel(engine(problem, Precision::float64, 0, 2));
  double rate = 0.0;
  for (int round = 0; round < 200; ++round) {
    list.measure();
    serial.measure();
    parallel.measure();
    if (round % 20 == 0)
      rate = std::max(rate,
                      spring_peers::multiply_rate(lattice::springs::widest(), Precision::float64));
  }
  std::printf("%-9s ns per spring: edge list %.3f, 1 thread %.4f, 2 threads %.4f\n", name.c_str(),
              1e9 * list.spring(), 1e9 * serial.spring(), 1e9 * parallel.spring());
  std::printf(
      "%-9s edge list over 1 thread %.2f, 2 threads %.2f; 1 over 2 threads %.3f; "
      "roofline fraction %.3f\n",
      "", list.step() / serial.step(), list.step() / parallel.step(),
      serial.step() / parallel.step(),
      spring_peers::multiply_operations_per_spring / (serial.spring() * rate));
  std::fflush(stdout);
}

void print_mask_cost() {
  const Runner tip = engine(tip_of_twelve(), Precision::float64, 0, 1);
  const Runner whole = engine(cube(48), Precision::float64, 0, 1);
  Fastest masked(tip), full(whole);
  for (int round = 0; round < 200; ++round) {
    masked.measure();
    full.measure();
  }
  std::printf("tip R/12: lane efficiency %.3f, speed per lane %.3f of 48^3\n", tip.lane_efficiency,
              full.spring() * whole.lane_efficiency / (masked.spring() * tip.lane_efficiency));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--ratios") == 0) {
    for (const int n : {20, 48}) print_ratios(std::to_string(n) + "^3", cube(n));
    print_ratios("tip R/12", tip_of_twelve());
    print_mask_cost();
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  for (const int n : {20, 48, 100}) {
    const std::string name = std::to_string(n) + "^3";
    const SpringProblem problem = cube(n);
    add(
        name + "/edge list", [=] { return edge_list(problem); }, 0.0);
    add_engines(name, problem, true);
  }
  const SpringProblem tip = tip_of_twelve();
  add(
      "tip R|12/edge list", [=] { return edge_list(tip); }, 0.0);
  add_engines("tip R|12", tip, false);
  for (const int n : {22, 32, 64, 80}) add_engines(std::to_string(n) + "^3", cube(n), false);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
