// Prints what the parts of a time step of the default press cost (network, finite, stick) on one
// thread, at first touch and deep in the rubber: microseconds of processor time, medians; first of
// plain masses at their largest step, then of scaled ones at 1 ms. Not a test:
// lattice/MEASUREMENTS.md quotes it. Usage: lattice_measure_step [steps per radius = 12]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "lattice/contact/cut_surfaces.h"
#include "lattice/contact/penalty_contact.h"
#include "lattice/contact/tied_bond.h"
#include "lattice/control/virtual_finger.h"
#include "lattice/forces/energy.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;

namespace {

constexpr double scaled_step = 1e-3;  // [s]

double processor_microseconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e6 * double(time.tv_sec) + 1e-3 * double(time.tv_nsec);
}

/// Prints the median of `repeats` single runs.
template <typename Work>
void print(const std::string& what, int repeats, const Work& work) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const double start = processor_microseconds();
    work();
    times.push_back(processor_microseconds() - start);
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  std::printf("  %-44s %9.2f us\n", what.c_str(), times[std::size_t(repeats / 2)]);
}

lattice::FingerSetup prescribed_finger(int per_radius, lattice::Integrator integrator) {
  lattice::FingerSetup setup;
  setup.lattice =
      settings_for(lattice::ModelKind::network, lattice::Kinematics::finite, per_radius);
  setup.plane = {Vector3(0.0, 0.0, setup.geometry.tip_radius), -Vector3::UnitZ()};
  setup.plane.point.z() += 1e-5;
  setup.contact = meshes::ContactMode::stick;
  setup.prescribed = true;
  setup.integrator = integrator;
  if (integrator == lattice::Integrator::mass_scaled) setup.time_step = scaled_step;
  setup.threads = 1;
  return setup;
}

void measure_step(const lattice::VirtualFinger& pressed) {
  const lattice::Finger& finger = pressed.finger();
  const lattice::LatticeModel& model = pressed.model();
  const double step = finger.step();
  lattice::Team team(1);
  lattice::InternalForces internal(model, team);
  lattice::TiedBond bond(model, team);
  lattice::PenaltyContact contact(model, finger.plane(), meshes::ContactMode::stick, team);
  lattice::VectorField force(model.points());
  for (int i = 0; i < 20; ++i) contact.add(finger.state(), finger.plane(), step, force);
  print("internal forces", 500, [&] { internal.accumulate(finger.state(), force); });
  print("contact", 500, [&] { contact.add(finger.state(), finger.plane(), step, force); });
  print("bond", 500, [&] { bond.add(finger.state(), finger.rod(), step, force); });
  lattice::RodState rod = finger.rod();
  print("rod", 500, [&] {
    rod.kick({Vector3(1e-9, 0.0, 0.0), Vector3::Zero()}, rod.endpoint(), step);
    rod.drift(step);
  });
}

// What scaled masses add to a step.
void measure_scaling(const lattice::VirtualFinger& pressed) {
  const lattice::Finger& finger = pressed.finger();
  const lattice::LatticeModel& model = pressed.model();
  const lattice::MassScaling& scaling = *finger.mass_scaling();
  lattice::Team team(1);
  lattice::InternalForces internal(model, team);
  lattice::CutSurfaces surfaces(model, finger.plane(), meshes::ContactMode::stick, team);
  lattice::VectorField force(model.points());
  for (int i = 0; i < 20; ++i) {
    internal.accumulate(finger.state(), force);
    surfaces.apply(finger.state(), finger.rod(), finger.plane(), scaling.step(), force, nullptr);
  }
  lattice::OuterLoads outer;
  print("plane's inertia", 500, [&] { outer.plane = surfaces.plane_hold(scaling.step()); });
  lattice::AccelerationFields fields = scaling.fields();
  lattice::Reactions reactions;
  print("V-cycle and reactions", 500,
        [&] { reactions = scaling.accelerate(finger.state(), outer, force, team, fields); });
  lattice::State moved = finger.state();
  print("all move", 500, [&] { scaling.move(moved, outer, reactions, team, fields); });
}

void measure_period(const lattice::VirtualFinger& pressed) {
  const lattice::Finger& finger = pressed.finger();
  double sink = 0.0;
  print("VirtualFinger::read", 200, [&] { sink += pressed.read().contact->radius; });
  print("elastic energy of the cells", 50,
        [&] { sink += lattice::elastic_energy(pressed.model(), finger.state()); });
  print("energy of the bond", 200, [&] { sink += finger.bond_energy(); });
  print("kinetic energy", 200,
        [&] { sink += lattice::kinetic_energy(pressed.model(), finger.state()); });
  lattice::StepController steps(pressed.model(), nullptr, lattice::Integrator::symplectic_euler,
                                {});
  print("largest eigenvalues, at once", 5,
        [&] { steps.update(finger.state(), finger.extremes()); });
  lattice::SpectrumSearch search(pressed.model());
  lattice::SpectrumSearch::Memory memory;
  print("largest eigenvalues, a portion", 46, [&] {
    if (!memory.active) search.begin(memory, finger.state());
    search.advance(memory);
  });
  if (!(sink == sink)) std::printf("  not a number\n");
}

// The rod moves at `speed` [m/s].
void measure(lattice::VirtualFinger& finger, double depth, double speed) {
  finger.write([speed](double time) {
    return lattice::RodMotion{Vector3(0.0, 0.0, speed * time), Vector3(0.0, 0.0, speed)};
  });
  finger.do_step(depth / speed - finger.finger().time());
  std::printf("indentation %.3f mm, %d points touch, step %.1f us\n", 1e3 * depth,
              finger.finger().touching(), 1e6 * finger.finger().step());
  measure_step(finger);
  if (finger.finger().mass_scaling() != nullptr) measure_scaling(finger);
  measure_period(finger);
  const double step = finger.finger().step();
  const long before = finger.finger().force_evaluations();
  const double start = processor_microseconds();
  finger.do_step(100.0 * step);
  std::printf(
      "  %-44s %9.2f us\n", "whole step",
      (processor_microseconds() - start) / double(finger.finger().force_evaluations() - before));
}

}  // namespace

int main(int count, char** values) {
  const int per_radius = count > 1 ? std::atoi(values[1]) : 12;
  if (per_radius < 4) return 2;
  for (const auto integrator :
       {lattice::Integrator::symplectic_euler, lattice::Integrator::mass_scaled}) {
    lattice::VirtualFinger finger(prescribed_finger(per_radius, integrator));
    std::printf("R/%d, %s: %zu particles, %zu points on the bond, %zu on the outer surface\n",
                per_radius, std::string(lattice::name(integrator)).c_str(),
                finger.model().particles.size(), finger.model().bond.size(),
                finger.model().outer.size());
    // Scaled masses are for slow presses.
    const double speed = integrator == lattice::Integrator::mass_scaled ? 0.01 : 0.05;
    for (const double depth : {1e-4, 1e-3, 3e-3}) measure(finger, depth, speed);
  }
}
