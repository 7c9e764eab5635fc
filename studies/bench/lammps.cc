#include "studies/bench/lammps.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <random>
#include <regex>

#include "lattice/stencil.h"
#include "meshes/files.h"
#include "meshes/press_response.h"

namespace fingertip::studies {

namespace {

/// Calls visit(i, j, type) for every bond, atoms counted from 1 with x fastest, types 1, 2, 3.
template <typename Visit>
void for_each_spring(int size, const Visit& visit) {
  const auto atom = [size](int x, int y, int z) { return 1 + (z * size + y) * size + x; };
  const auto inside = [size](int x) { return x >= 0 && x < size; };
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        for (const lattice::Direction& d : lattice::half_stencil)
          if (inside(x + d.dx) && inside(y + d.dy) && inside(z + d.dz))
            visit(atom(x, y, z), atom(x + d.dx, y + d.dy, z + d.dz), int(d.family) + 1);
}

void write_data(std::ostream& out, int size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.01, 0.01);
  out << "cube of springs\n\n"
      << size * size * size << " atoms\n"
      << cube_springs(size) << " bonds\n1 atom types\n3 bond types\n26 extra bond per atom\n\n";
  for (const char axis : {'x', 'y', 'z'})
    out << -1.0 << ' ' << size << ' ' << axis << "lo " << axis << "hi\n";
  out << "\nMasses\n\n1 1.0\n\nAtoms # bond\n\n";
  int atom = 0;
  for (int z = 0; z < size; ++z)
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        out << ++atom << " 1 1 " << x + shift(random) << ' ' << y + shift(random) << ' '
            << z + shift(random) << '\n';
      }
  out << "\nBonds\n\n";
  std::size_t bond = 0;
  for_each_spring(size, [&](int i, int j, int type) {
    out << ++bond << ' ' << type << ' ' << i << ' ' << j << '\n';
  });
}

}  // namespace

std::size_t cube_springs(int size) {
  std::size_t count = 0;
  for_each_spring(size, [&](int, int, int) { ++count; });
  return count;
}

void write_lammps_cube(const std::filesystem::path& folder, int size, int steps) {
  std::filesystem::create_directories(folder);
  meshes::write_atomically(folder / "cube.data", [&](std::ostream& out) { write_data(out, size); });
  meshes::write_atomically(folder / "cube.in", [&](std::ostream& out) {
    out << "units lj\natom_style bond\nboundary s s s\n"
           // Every bond once, forces on both of its ends.
           "newton on\n"
           "special_bonds lj/coul 1 1 1\ncomm_modify cutoff 2.5\nneighbor 0.1 bin\n"
           "neigh_modify delay 1000000 every 1000000 check no\n"
        << "read_data " << (folder / "cube.data").string()
        << "\npair_style none\nbond_style harmonic\n";
    // Energy K (r - r0)² without a half; l0 of the three classes.
    for (int c = 0; c < 3; ++c)
      out << "bond_coeff " << c + 1 << ' ' << 0.5 * (10.0 - 3.0 * c) << ' '
          << meshes::to_text(std::sqrt(c + 1.0)) << '\n';
    out << "fix move all nve\ntimestep 0.01\nthermo 1000000\nrun " << steps << '\n';
  });
}

double lammps_cost(const std::string& printed, std::size_t springs) {
  static const std::regex loop(R"(Loop time of ([0-9.eE+-]+) on \d+ procs for (\d+) steps)");
  static const std::regex use(R"(([0-9.]+)% CPU use)");
  std::smatch time, share;
  if (!std::regex_search(printed, time, loop) || !std::regex_search(printed, share, use))
    return meshes::unknown;
  const double steps = std::atof(time[2].str().c_str());
  return 1e9 * std::atof(time[1].str().c_str()) * 0.01 * std::atof(share[1].str().c_str()) /
         (steps * double(springs));
}

std::string lammps_version(const std::string& printed) {
  static const std::regex head(R"(LAMMPS \(([^)]*)\))");
  std::smatch found;
  return std::regex_search(printed, found, head) ? found[1].str() : "";
}

}  // namespace fingertip::studies
