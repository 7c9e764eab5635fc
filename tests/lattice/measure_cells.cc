// Prints what the forces of the cells cost: nanoseconds of processor time per cell on one thread,
// for every law and register width, on whole cells alone and on the default tip; then how much
// faster two threads are. Not a test: lattice/MEASUREMENTS.md quotes it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "lattice/forces/cell_forces.h"
#include "lattice/kernels/by_width.h"
#include "lattice/kernels/kernel.h"
#include "lattice/model/cut_tip.h"
#include "tests/lattice/fixtures.h"

using namespace fingertip;
using namespace fixtures;

namespace {

using lattice::CellLawKind;
using lattice::VectorField;

struct Law {
  const char* name;
  CellLawKind kind;
  bool damped;
};
constexpr Law laws[] = {{"cubic", CellLawKind::cubic, false},
                        {"volume", CellLawKind::volume, false},
                        {"volume, damped", CellLawKind::volume, true},
                        {"network", CellLawKind::network, false},
                        {"network, damped", CellLawKind::network, true}};

lattice::CellMaterial material(const Law& law) {
  lattice::CellMaterial m;
  m.kind = law.kind;
  m.c11 = 3.1e3, m.c12 = 1.7e3, m.c44 = 1.2e3, m.kappa = 7.7e3;
  m.shear = 1.4e3, m.lambda = 9.1e3, m.hourglass_modulus = 450.0;
  m.retardation_time = law.damped ? 3e-4 : 0.0;
  return m;
}

double processor_seconds() {
  return double(std::clock()) / CLOCKS_PER_SEC;
}

double seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Median over rounds of the nanoseconds that a call takes.
template <typename Work>
double nanoseconds(double (*clock)(), const Work& work) {
  constexpr int rounds = 9, calls = 12;
  std::vector<double> times;
  work();
  for (int round = 0; round < rounds; ++round) {
    const double start = clock();
    for (int call = 0; call < calls; ++call) work();
    times.push_back(1e9 * (clock() - start) / calls);
  }
  std::nth_element(times.begin(), times.begin() + rounds / 2, times.end());
  return times[rounds / 2];
}

VectorField random_field(std::size_t points, double amplitude) {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  VectorField field(points);
  for (auto& component : field.component) {
    for (double& value : component) value = uniform(generator);
  }
  return field;
}

void measure(const std::string& what, const meshes::CubicGrid& grid,
             const std::vector<meshes::CutCell>& cells) {
  const std::size_t points = grid.points() + lattice::lanes;
  const VectorField u = random_field(points, 0.02 * grid.spacing), v = random_field(points, 0.02);
  VectorField force(points);
  std::printf("%s: %zu cells\n", what.c_str(), cells.size());
  for (const Law& law : laws) {
    const lattice::CellLattice lattice = lay_out(grid, cells, material(law));
    lattice::Team single(1), pair(2);
    std::printf("  %-16s", law.name);
    for (int width = 2; width <= lattice::kernel::supported_width(); width *= 2) {
      lattice::CellForces forces(lattice, single, width);
      std::printf(" %6.2f",
                  nanoseconds(processor_seconds, [&] { forces.add(u, v, force); }) / cells.size());
    }
    lattice::CellForces alone(lattice, single), together(lattice, pair);
    std::printf(" ns per cell (2, 4, 8 lanes); two threads: %.2f times as fast\n",
                nanoseconds(seconds, [&] { alone.add(u, v, force); }) /
                    nanoseconds(seconds, [&] { together.add(u, v, force); }));
  }
}

}  // namespace

int main() {
  const std::array<int, 3> counts{32, 18, 18};
  meshes::CubicGrid grid;
  grid.spacing = 1e-3;
  grid.size = {counts[0] + 2 + int(lattice::lanes), counts[1] + 3, counts[2] + 3};
  measure("whole cells", grid, lattice::whole_cells({1, 1, 1}, counts));
  for (const int per_radius : {12, 16}) {
    const lattice::CutTip tip = lattice::cut_tip(
        {}, {}, settings_for(lattice::ModelKind::network, lattice::Kinematics::finite, per_radius),
        1, lattice::row_margin);
    measure("tip, R/" + std::to_string(per_radius), tip.cells.grid(), tip.cells.cells());
  }
}
