#include "calculix.h"

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace fingertip::benchmarks {
std::vector<double> read_total_forces(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  std::vector<double> forces;
  for (std::string line; std::getline(in, line);) {
    if (line.find("total force") == std::string::npos) continue;
    std::string fx, fy, fz;
    if (!(in >> fx >> fy >> fz)) throw std::runtime_error(file.string() + " ends within an entry");
    forces.push_back(std::strtod(fy.c_str(), nullptr));  // "NaN", too
  }
  return forces;
}

int read_iterations(const std::filesystem::path& file) {
  // Columns: step, increment, attempt (with a U when it failed), iterations, times.
  std::ifstream in(file);
  int total = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    int step = 0, increment = 0, iterations = 0;
    std::string attempt;
    if (cells >> step >> increment >> attempt >> iterations) total += iterations;
  }
  return total;
}

CalculixRun run_calculix(const std::string& ccx, Problem problem, meshes::TipMeshOptions mesh,
                         const std::vector<double>& depths, const DeckOptions& options,
                         double limit, const std::filesystem::path& folder) {
  const meshes::Geometry geometry;
  std::filesystem::create_directories(folder);
  mesh.sector = meshes::Sector::meridian;
  meshes::write_tip_mesh(geometry, mesh, folder / "tip.msh");
  MeridianMesh meridian = read_meridian_mesh(folder / "tip.msh");
  if (is_quadratic(options.element)) meridian = with_midside_nodes(meridian);
  write_deck(meridian, geometry, rubber_of(problem), problem, depths, options,
             folder / "press.inp");

  CalculixRun run = run_deck(ccx, limit, folder);
  run.unknowns = 2 * meridian.nodes.size();
  return run;
}

CalculixRun run_deck(const std::string& ccx, double limit, const std::filesystem::path& folder) {
  CalculixRun run;
  run.cost = run_child({ccx, "-i", "press"}, folder,
                       {"OMP_NUM_THREADS=1", "OPENBLAS_NUM_THREADS=1"}, limit, folder / "log.txt");
  run.iterations = read_iterations(folder / "press.sta");
  if (!std::filesystem::exists(folder / "press.dat")) return run;
  for (const double force : read_total_forces(folder / "press.dat")) {
    if (!std::isfinite(force)) break;  // which CalculiX takes for converged
    run.forces.push_back(sectors * std::abs(force) / millinewtons);
  }
  return run;
}

}  // namespace fingertip::benchmarks
