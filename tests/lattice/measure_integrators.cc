// Prints what a press costs by every integrator and how far its force is from that of Runge-Kutta
// steps at 1e-8, as CSV (lattice/dynamics/integrators). One thread; processor time as a ratio to
// symplectic Euler at its largest step.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <optional>
#include <vector>

#include "lattice/press/press.h"

using namespace fingertip;
using lattice::Integrator;
using lattice::PressOutcome;

namespace {

lattice::PressSetup press(double retardation_time) {
  lattice::PressSetup setup;
  setup.rubber.retardation_time = retardation_time;
  setup.lattice.spacing = setup.geometry.tip_radius / 6.0;
  setup.lattice.constants = lattice::hookean_constants(setup.rubber, setup.lattice.spacing);
  setup.protocol.mode = meshes::DriveMode::quasi_static;
  setup.protocol.contact = meshes::ContactMode::frictionless;
  setup.protocol.depth = 1e-3;
  setup.protocol.speed = 0.05;
  setup.protocol.clearance = 2e-4;
  setup.threads = 1;
  return setup;
}

struct Measured {
  PressOutcome outcome;
  double time = 0.0;  // [s]
};

Measured run(const lattice::PressSetup& setup) {
  Measured result;
  const std::clock_t start = std::clock();
  result.outcome = lattice::run_press(setup);
  result.time = double(std::clock() - start) / CLOCKS_PER_SEC;
  return result;
}

// Largest difference of F(t), relative to the largest force.
double error(const PressOutcome& outcome, const PressOutcome& exact) {
  const auto& samples = outcome.response.samples();
  const auto& wanted = exact.response.samples();
  double worst = samples.size() == wanted.size() ? 0.0 : INFINITY, largest = 0.0;
  for (std::size_t i = 0; i < samples.size() && i < wanted.size(); ++i) {
    worst = std::max(worst, std::abs(samples[i].normal_force - wanted[i].normal_force));
    largest = std::max(largest, wanted[i].normal_force);
  }
  return worst / largest;
}

void compare(double retardation_time) {
  lattice::PressSetup setup = press(retardation_time);
  const Measured euler = run(setup);
  setup.integrator = Integrator::runge_kutta;
  setup.tolerance = 1e-8;
  const Measured exact = run(setup);
  const auto print = [&](double value, const Measured& measured) {
    const auto& o = measured.outcome;
    std::printf("%g,%s,%g,%ld,%ld,%ld,%.2f,%.3g\n", retardation_time, name(setup.integrator).data(),
                value, o.force_evaluations, o.steps.accepted, o.steps.rejected,
                measured.time / euler.time, error(o, exact.outcome));
    std::fflush(stdout);
  };
  print(1e-8, exact);
  for (const double tolerance : {1e-7, 1e-6, 1e-5, 1e-4}) {
    setup.tolerance = tolerance;
    print(tolerance, run(setup));
  }
  setup.integrator = Integrator::energy_controlled;
  for (const double bound : {1e-5, 1e-6, 1e-7, 1e-8}) {
    setup.energy_bound = bound;
    print(bound, run(setup));
  }
  setup.integrator = Integrator::symplectic_euler;
  print(euler.outcome.step.step, euler);
  for (int halvings = 1; halvings <= 7; ++halvings) {
    setup.time_step = std::ldexp(euler.outcome.step.step, -halvings);
    print(*setup.time_step, run(setup));
  }
}

}  // namespace

int main() {
  std::puts(
      "retardation_time [s],integrator,step [s] or bound,force_evaluations,steps,rejected,"
      "time_ratio,error");
  for (const double retardation_time : {3e-4, 0.0}) compare(retardation_time);
}
