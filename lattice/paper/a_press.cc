/// A whole press: the paper's fingertip moves down on a rigid plane under its PID controller, and
/// tells force and torque at the rod's endpoint. The output stands in README.md.
#include <cstdio>

#include "lattice/model/constants.h"
#include "lattice/press/press.h"

using namespace fingertip;

int main() {
  lattice::PressSetup setup;  // the geometry and the rubber of the paper, SI units

  setup.lattice.model = lattice::ModelKind::published;
  setup.lattice.kinematics = lattice::Kinematics::finite;
  setup.lattice.spacing = setup.geometry.tip_radius / 12;
  setup.lattice.constants = lattice::published_constants(setup.rubber, setup.lattice.spacing);
  setup.integrator = lattice::Integrator::explicit_euler;

  setup.protocol.contact = meshes::ContactMode::stick;  // anchored till the end
  setup.protocol.samples = {0.5e-3, 1e-3, 1.5e-3, 2e-3};
  setup.protocol.depth = setup.protocol.samples.back();

  const lattice::PressOutcome press = lattice::run_press(setup);

  std::printf("%zu particles, %zu springs, %.0f mm/s\n", press.census.particles,
              press.census.springs, 1e3 * setup.protocol.speed);
  std::printf("indentation [mm]  force [mN]\n");
  for (const double depth : setup.protocol.samples)
    std::printf("%16.1f %11.1f\n", 1e3 * depth, 1e3 * press.response.normal_force_at(depth));
}
