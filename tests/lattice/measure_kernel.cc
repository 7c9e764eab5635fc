// Prints what a time step of the default tip costs on one thread: nanoseconds of processor time per
// spring or fibre, for every register width the processor has. Not a test:
// lattice/MEASUREMENTS.md quotes it.
#include <cstdio>
#include <ctime>
#include <string>

#include "lattice/dynamics/finger.h"
#include "lattice/kernels/by_width.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;

namespace {

double processor_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

template <typename Work>
double milliseconds(int repeats, const Work& work) {
  work();
  const double start = processor_seconds();
  for (int i = 0; i < repeats; ++i) work();
  return 1e3 * (processor_seconds() - start) / repeats;
}

void print(const std::string& what, double time, std::size_t springs) {
  std::printf("  %-28s %7.3f ms  %6.2f ns/spring\n", what.c_str(), time,
              1e6 * time / double(springs));
}

void measure(lattice::ModelKind kind, lattice::Kinematics kinematics, int per_radius) {
  const lattice::LatticeModel model = tip(kind, kinematics, per_radius);
  const std::size_t springs = model.spring_count();
  std::printf("%s, %s kinematics, R/%d: %zu particles, %zu springs, %zu cells\n",
              std::string(name(kind)).c_str(), std::string(name(kinematics)).c_str(), per_radius,
              model.particles.size(), springs, model.cells.size());
  lattice::Team team(1);
  const lattice::State state = random_state(model, 0.01, 0.01, 1);
  lattice::VectorField force(model.points());
  for (int width = 2; width <= lattice::kernel::supported_width(); width *= 2) {
    lattice::InternalForces forces(model, team, width);
    print("forces, " + std::to_string(width) + " lanes",
          milliseconds(100, [&] { forces.accumulate(state, force); }), springs);
  }
  const lattice::Plane far{Vector3(0.0, 0.0, 1.0), -Vector3::UnitZ()};
  lattice::Finger finger(model, lattice::rod_body({}, {}), far, meshes::ContactMode::stick,
                         lattice::Integrator::symplectic_euler, 1e-6, 1);
  print("whole step", milliseconds(200, [&] { finger.advance(lattice::Wrench{}); }), springs);
}

}  // namespace

int main() {
  for (const int per_radius : {12, 16}) {
    measure(lattice::ModelKind::published, lattice::Kinematics::finite, per_radius);
    measure(lattice::ModelKind::central, lattice::Kinematics::small, per_radius);
    measure(lattice::ModelKind::hookean, lattice::Kinematics::small, per_radius);
    measure(lattice::ModelKind::hookean, lattice::Kinematics::finite, per_radius);
    measure(lattice::ModelKind::network, lattice::Kinematics::finite, per_radius);
  }
}
