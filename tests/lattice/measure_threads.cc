// Prints what whole steps of the default press cost (network, finite, stick) on one thread and on
// several, in turns: microseconds of wall time, medians over groups of steps, and whether both give
// the same bits. Not a test: lattice/MEASUREMENTS.md quotes it.
// Usage: lattice_measure_threads [steps per radius = 12] [threads = 2]
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "tests/lattice/finger_scenes.h"

using namespace fingertip;
using namespace fixtures;

namespace {

constexpr double speed = 0.05;  // of the rod [m/s]

lattice::FingerSetup pressed_finger(int per_radius, lattice::Integrator integrator, int threads) {
  lattice::FingerSetup setup;
  setup.lattice =
      settings_for(lattice::ModelKind::network, lattice::Kinematics::finite, per_radius);
  setup.plane = {Vector3(0.0, 0.0, setup.geometry.tip_radius + 1e-5), -Vector3::UnitZ()};
  setup.contact = meshes::ContactMode::stick;
  setup.integrator = integrator;
  setup.prescribed = true;
  setup.threads = threads;
  return setup;
}

class Pressed {
 public:
  explicit Pressed(const lattice::FingerSetup& setup) : finger(setup) {
    finger.write([](double time) {
      return lattice::RodMotion{Vector3(0.0, 0.0, speed * time), Vector3(0.0, 0.0, speed)};
    });
  }
  /// Microseconds per step.
  double advance(double duration) {
    const long before = finger.finger().force_evaluations();
    const auto start = std::chrono::steady_clock::now();
    finger.do_step(duration);
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - start;
    return taken.count() / double(finger.finger().force_evaluations() - before);
  }
  lattice::VirtualFinger finger;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

void compare(int per_radius, lattice::Integrator integrator, int threads) {
  Pressed serial(pressed_finger(per_radius, integrator, 1));
  Pressed several(pressed_finger(per_radius, integrator, threads));
  std::printf("%s, step at rest %.1f us\n", std::string(name(integrator)).c_str(),
              1e6 * serial.finger.step_report(1.0).step);
  constexpr double group = 2.5e-3;  // [s]
  std::vector<double> of_one, of_several;
  double next = 0.5e-3;
  for (double depth = 0.0; depth < 3e-3; depth += speed * group) {
    of_one.push_back(serial.advance(group));
    of_several.push_back(several.advance(group));
    if (depth + speed * group < next) continue;
    const double a = median(of_one), b = median(of_several);
    std::printf(
        "  to %.1f mm: %5d points touch, step %7.1f us, %d threads %7.1f us, ratio %.2f%s\n",
        1e3 * next, serial.finger.finger().touching(), a, threads, b, a / b,
        same_bits(serial.finger, several.finger) ? "" : ", OTHER BITS");
    of_one.clear();
    of_several.clear();
    next += 0.5e-3;
  }
}

}  // namespace

int main(int count, char** values) {
  const int per_radius = count > 1 ? std::atoi(values[1]) : 12;
  const int threads = count > 2 ? std::atoi(values[2]) : 2;
  if (per_radius < 4 || threads < 1) return 2;
  for (const auto integrator :
       {lattice::Integrator::symplectic_euler, lattice::Integrator::mass_scaled}) {
    compare(per_radius, integrator, threads);
  }
}
